#include "app/validate/ground_edits.h"

#include <algorithm>
#include <cmath>

#include "crowd/herd.h"
#include "skitter/records.h"

namespace skitter::app {
namespace {

constexpr double kEvery = 0.25;                                             // seconds
constexpr uint64_t kTimes = 4, kCycle = 16;                                 // times out of so many
constexpr uint32_t kAtOnce = 16;                                            // of a herd's size
constexpr uint32_t kMostSamples = 64;                                       // a side
constexpr float kAway = 1, kLeast = 0.15f, kMost = 0.75f, kHeight = 0.25f;  // leg lengths

}  // namespace

GroundEdits::GroundEdits(const Heightfield& ground, uint64_t seed, double dt)
    : ground_(ground),
      every_(std::max<uint64_t>(1, static_cast<uint64_t>(std::llround(kEvery / dt)))),
      random_(seed) {}

// Not a standard distribution: those differ from library to library.
float GroundEdits::drawn(float least, float most) {
  return least + (most - least) * static_cast<float>(random_() >> 40) * 0x1p-24f;
}

HeightEdit GroundEdits::near(const HerdState& herd, float legLength) {
  const float* b = herd.body.data() + random_() % herd.agents * shared::BODY_STRIDE * 4;
  const float x = shared::tileX(b[3]) * shared::TILE_SIZE + b[0] + drawn(-kAway, kAway) * legLength;
  const float z = shared::tileZ(b[3]) * shared::TILE_SIZE + b[2] + drawn(-kAway, kAway) * legLength;
  const float half = drawn(kLeast, kMost) * legLength, by = drawn(-kHeight, kHeight) * legLength;
  struct Run {
    uint32_t first, count;
  };
  const auto run = [&](float middle, float origin, float spacing, uint32_t samples) -> Run {
    const float last = static_cast<float>(samples - 1);
    const float first = std::clamp(std::round((middle - half - origin) / spacing), 0.0f, last);
    const float end = std::clamp(std::round((middle + half - origin) / spacing), first, last);
    return {static_cast<uint32_t>(first),
            std::min(kMostSamples, static_cast<uint32_t>(end) - static_cast<uint32_t>(first) + 1)};
  };
  const Run columns = run(x, ground_.originX(), ground_.spacingX, ground_.columns);
  const Run rows = run(z, ground_.originZ(), ground_.spacingZ, ground_.rows);
  HeightEdit edit{columns.first, rows.first, columns.count, rows.count, {}};
  for (uint32_t row = rows.first; row < rows.first + rows.count; ++row)
    for (uint32_t column = columns.first; column < columns.first + columns.count; ++column)
      edit.heights.push_back(ground_.heights[size_t{row} * ground_.columns + column] + by);
  return edit;
}

std::vector<HeightEdit> GroundEdits::before(uint64_t n, const Crowd& crowd,
                                            const std::vector<HerdState>& herds) {
  std::vector<HeightEdit> edits;
  const uint64_t turn = n / every_ % kCycle;
  if (n % every_ != 0 || turn == 0 || turn > kTimes) return edits;
  auto herd = herds.begin();
  for (const crowd::HerdRun& of : crowd::allRuns(implOf(crowd))) {
    const float legLength = implOf(crowd).kinds[of.run->kind].rig.legLength;
    for (uint32_t i = 0; i < std::min(kAtOnce, herd->agents); ++i) edits.push_back(near(*herd, legLength));
    ++herd;
  }
  return edits;
}

}  // namespace skitter::app
