#include "skitter/tuning.h"

#include <fmt/format.h>

#include "skitter/error.h"

namespace skitter {

std::string rangeOf(const TuningInfo& info) {
  const std::string range = fmt::format("{} to {}", info.least, info.most);
  return info.unit == TuningUnit::number ? range : fmt::format("{} {}", range, nameOf(info.unit));
}

void checkTuning(const Tuning& tuning, const std::string& of) {
  for (const TuningInfo& info : allTunings) {
    const float value = tuning.*info.member;
    if (!(value >= info.least && value <= info.most))
      throw inputError(fmt::format("{}.{} is {}, expected {}", of, info.name, value, rangeOf(info)));
  }
  for (const TuningOrder& order : allTuningOrders) {
    const float less = tuning.*order.lessMember, more = tuning.*order.moreMember;
    // A distance that both values state exactly in decimals may be lost to their rounding.
    if (!(more - less >= order.apart - 1e-6f))
      throw inputError(fmt::format(
          "{}.{} is {} and {} is {}, expected {} to be at least {}: {}", of, order.less, less, order.more,
          more, order.more,
          order.apart > 0 ? fmt::format("{} + {}", order.less, order.apart) : std::string(order.less),
          order.why));
  }
}

}  // namespace skitter
