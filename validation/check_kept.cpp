#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "crowd/record.h"
#include "validation/checks.h"
#include "validation/vec4s.h"

namespace skitter::validation {
namespace {

bool sameBits(float a, float b) { return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b); }

}  // namespace

void checkKept(const Setting& setting, const Moment& moment, Record record, Judge& judge) {
  const std::vector<float>&before = moment.before.of(record), &after = moment.after.of(record);
  if (before.size() != after.size()) return;  // poses that only one of the states has
  const crowd::RecordInfo info = crowd::infoOf(record);
  const std::string quantity = std::string(info.name) + " of a sleeper";
  const bool ofLegs = info.per == crowd::Per::leg;
  const size_t parts = ofLegs ? static_cast<size_t>(setting.legs) : 1;
  const size_t floats = before.size() / (moment.before.agents * parts);
  for (size_t part = 0; part < parts; ++part) {
    const size_t first = (moment.agent * parts + part) * floats;
    Sample sample;
    for (size_t i = first; i < first + floats; ++i) {
      if (sameBits(before[i], after[i])) continue;
      const double apart = std::abs(double{before[i]} - double{after[i]});
      // Zeros of either sign are not the same bits.
      sample.compare(quantity.c_str(), apart == 0 ? std::numeric_limits<double>::min() : apart, 0,
                     load(before, i / 4), load(after, i / 4));
    }
    if (sample.passes())
      judge.keep();
    else
      judge.add(moment.n, moment.number(), ofLegs ? static_cast<int>(part) : -1, sample);
  }
}

}  // namespace skitter::validation
