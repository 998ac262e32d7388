#include "crowd/levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "crowd/frame.h"
#include "crowd/page.h"
#include "gpu/context.h"
#include "gpu/transfer.h"
#include "shared/levels.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

static_assert(Levels::count == shared::RATE_LEVELS);

// A whole crowd is validated up to ticks of that length, seconds; rounding of 8 / 60 may be above it.
constexpr double longestTick = 2.0 / 15 * (1 + 1e-6);

int slowestLevel(float dt) {
  int level = shared::RATE_LEVELS - 1;
  while (level > 0 && std::ldexp(double{dt}, level) > longestTick) --level;
  return level;
}

// Quarter metres. Beyond 16 km they are all the same: differences are cut far below.
int32_t quarters(float metres) {
  return static_cast<int32_t>(std::clamp(std::floor(4.0 * double{metres}), -65536.0, 65536.0));
}

// The square of a distance, as wake has squares.
uint32_t squareOf(float metres) {
  return static_cast<uint32_t>(
      std::min(std::floor(16.0 * double{metres} * double{metres}), double{UINT32_MAX}));
}

void expectLevels(const Levels& levels) {
  float least = 0;
  for (size_t k = 0; k < levels.distances.size(); ++k) {
    const float distance = levels.distances[k];
    // Also refuses NaN.
    if (!(distance >= least && distance <= Levels::farthest))
      throw inputError(fmt::format("levels of rate: distances[{}] is {}, expected {} to {}", k, distance,
                                   least, Levels::farthest));
    least = distance;
  }
}

}  // namespace

RateLevels::RateLevels(const gpu::Context& context, const Levels& from)
    : levels(from), words(context, shared::LEVELS_WORDS * sizeof(uint32_t), "levels") {
  std::vector<uint32_t> begin(shared::LEVELS_WORDS);
  uint64_t inAll = 0;
  for (size_t k = 0; k + 1 < Levels::count; ++k) {
    begin[shared::LEVELS_FAR + k] = squareOf(levels.distances[k]);
    inAll = std::min<uint64_t>(inAll + levels.most[k], UINT32_MAX);
    begin[shared::LEVELS_MOST + k] = static_cast<uint32_t>(inAll);
    // Nobody has been counted yet.
    begin[shared::LEVELS_EDGE + k] = begin[shared::LEVELS_EDGE + shared::LEVELS_EDGES + k] = UINT32_MAX;
  }
  gpu::upload(context, words, begin);
}

void RateLevels::expectFinite(const glm::vec3& camera) {
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(camera[axis]))
      throw inputError(
          fmt::format("a camera at ({}, {}, {}), expected finite numbers", camera.x, camera.y, camera.z));
}

void RateLevels::look(const glm::vec3& from) {
  camera = {quarters(from.x), quarters(from.y), quarters(from.z)};
}

void RateLevels::clear(uint64_t tick, vk::CommandBuffer cmd) const {
  using namespace shared;
  const auto zero = [&](int first, int count) {
    cmd.fillBuffer(words.handle(), static_cast<uint64_t>(first) * sizeof(uint32_t),
                   static_cast<uint64_t>(count) * sizeof(uint32_t), 0);
  };
  zero(LEVELS_AGENTS, RATE_LEVELS);
  zero(LEVELS_HISTOGRAM + LEVELS_HISTOGRAM_STRIDE * static_cast<int>(tick & 1), LEVELS_HISTOGRAM_STRIDE);
}

shared::TickConstants RateLevels::constantsOf(const Crowd::Impl& crowd, const Page& page,
                                              uint64_t tick) const {
  const Page* first = nullptr;
  for (const Kind& kind : crowd.kinds)
    if (first == nullptr && !kind.pages.empty()) first = &kind.pages.front();
  const std::array<int32_t, 3> at = camera.value_or(std::array<int32_t, 3>{});
  const int flags = (camera ? shared::LEVELS_HAS_CAMERA : 0) +
                    (&page == first ? shared::LEVELS_IS_FIRST : 0) +
                    shared::LEVELS_SLOWEST * slowestLevel(crowd.dt);
  return {.count = page.agents,
          .tick = static_cast<float>(tick),
          .first = page.firstAgent,
          .every = std::bit_cast<uint32_t>(at[0]),
          .watched = std::bit_cast<uint32_t>(at[1]),
          .room = std::bit_cast<uint32_t>(at[2]),
          .sleepTime = static_cast<float>(flags)};
}

void expectLevelled(const CrowdOptions& options) {
  expectLevels(*options.levels);
  if (options.sleep) throw inputError("levels of rate with sleep, expected only one of them");
}

}  // namespace skitter::crowd

namespace skitter {

void Crowd::lookFrom(const glm::vec3& camera) {
  crowd::RateLevels::expectFinite(camera);
  if (impl_->rates) impl_->rates->look(camera);
}

}  // namespace skitter
