#include "crowd/watch.h"

#include "crowd/page.h"

namespace skitter::crowd {
namespace {

constexpr uint64_t kSmallCrowd = 256;
// To watch an agent costs 1.6 core-us, to move one 1.9 (lavapipe): 1.3 % of a large crowd's tick. A small
// one's waits for a dispatch that fills one core only.
constexpr uint32_t kLargeEvery = 64;

}  // namespace

uint32_t watchEvery(const CrowdOptions& options, uint64_t agents) {
  if (options.watchEvery > 0) return options.watchEvery;
  return agents <= kSmallCrowd ? 1 : kLargeEvery;
}

Watch watchAt(uint64_t tick, uint32_t every, const Page& page) {
  const uint64_t past = tick > 0 ? tick - 1 : 0;
  if (every == 1) return {0, page.agents, static_cast<uint32_t>(past)};
  // Counted through the kind's agents, so that pages do not show.
  const auto turn = static_cast<uint32_t>(past / shared::WATCH_TICKS % every);
  const RunSample sample = sampleOf(page.firstAgent, page.agents, {turn, every});
  return {sample.first, sample.count, static_cast<uint32_t>(past % shared::WATCH_TICKS)};
}

}  // namespace skitter::crowd
