#include "validation/lockstep/rate_check.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "crowd/readback.h"
#include "gpu/transfer.h"
#include "shared/levels.h"
#include "skitter/records.h"
#include "validation/convert.h"

namespace skitter::validation {

namespace {

bool isDisturbed(const HerdState& state, size_t agent) {
  if (state.reaction.empty()) return false;
  const reference::Reaction reaction = reactionOf(state, agent);
  return reaction.phase != reference::ReactionPhase::steady || reaction.disturbed > 0;
}

}  // namespace

RateCheck::RateCheck(const Crowd::Impl& crowd) : crowd_(crowd) {
  const Levels& levels = crowd.rates->levels;
  for (size_t k = 0; k < tuning_.distances.size(); ++k) {
    tuning_.distances[k] = double{levels.distances[k]};
    tuning_.most[k] = levels.most[k];
  }
  const std::vector<uint32_t> now = words();
  for (size_t k = 0; k < agentTicks_.size(); ++k)
    agentTicks_[k] =
        uint64_t{now[shared::LEVELS_TICKS + 2 * k + 1]} << 32 | now[shared::LEVELS_TICKS + 2 * k];
}

std::vector<uint32_t> RateCheck::words() const {
  return gpu::download<uint32_t>(*crowd_.context, crowd_.rates->words);
}

std::vector<std::vector<RateCheck::Rated>> RateCheck::download() const {
  std::vector<std::vector<Rated>> kinds;
  for (const crowd::Kind& kind : crowd_.kinds) kinds.emplace_back(kind.agents);
  constexpr std::array records = {Record::body, Record::rate, Record::reaction, Record::push};
  const std::vector<HerdState> states = crowd::downloadRecords(crowd_, records);
  for (uint32_t h = 0; h < states.size(); ++h) {
    const HerdState& state = states[h];
    for (uint32_t agent = 0; agent < state.agents; ++agent) {
      const crowd::SizeRun& run = crowd_.herds[h].runOf(agent);
      const reference::AgentBody body = bodyOf(state, agent);
      const float* rate = state.rate.data() + size_t{agent} * 4 * shared::RATE_STRIDE;
      const glm::dvec2 at = body.world();
      kinds[run.kind][run.firstAgent + agent - run.firstOfHerd] = {
          .place = {at.x, body.y, at.y},
          .level = static_cast<int>(rate[0]),
          .lastLevel = static_cast<int>(rate[1]),
          .lastTick = static_cast<uint64_t>(rate[2]),
          .absent = body.absent,
          .disturbed = isDisturbed(state, agent),
          .pushed = pushOf(state, agent, crowd_.tick).has_value()};
    }
  }
  return kinds;
}

void RateCheck::begin() { before_ = download(); }

void RateCheck::end() {
  const uint64_t n = crowd_.tick;
  const std::vector<std::vector<Rated>> after = download();
  const auto& at = crowd_.rates->camera;
  std::optional<glm::dvec3> camera;
  if (at) camera = glm::dvec3((*at)[0], (*at)[1], (*at)[2]) / 4.0;
  tuning_.dt = double{crowd_.dt};
  const reference::RateBounds<double> edges = reference::rateEdges(tuning_, seenBefore_);
  std::vector<reference::SeenBlock> seen;
  Counts agents{};
  uint64_t number = 0;  // of an agent, through the kinds
  for (size_t k = 0; k < before_.size(); ++k)
    for (size_t first = 0; first < before_[k].size(); first += shared::BLOCK) {
      const size_t end = std::min(first + shared::BLOCK, before_[k].size());
      reference::RatedBlock block{.number = first / shared::BLOCK, .level = before_[k][first].level};
      for (size_t i = first; i < end; ++i)
        if (!before_[k][i].absent) {
          block.places.push_back(before_[k][i].place);
          block.calm = block.calm && !before_[k][i].disturbed && !after[k][i].pushed;
        }
      const size_t present = block.places.size();
      // Without a camera the device counts as from the origin.
      const double square = reference::rateSquare(block, camera.value_or(glm::dvec3(0)));
      seen.push_back({square, present});
      const reference::RateResult expected =
          reference::rate(tuning_, block, n, camera ? std::optional(square) : std::nullopt, edges);
      agents[static_cast<size_t>(expected.level)] += present;
      if (expected.hasTurn) agentTicks_[static_cast<size_t>(block.level)] += present;
      for (size_t i = first; i < end; ++i) {
        const Rated &was = before_[k][i], &got = after[k][i];
        Sample sample;
        sample.same("level", expected.level, got.level);
        sample.same("level of its last tick", expected.hasTurn ? block.level : was.lastLevel, got.lastLevel);
        sample.same("its last tick", static_cast<double>(expected.hasTurn ? n : was.lastTick),
                    static_cast<double>(got.lastTick));
        judge_.add(n, number++, -1, sample);
      }
    }
  compareCounts(n, agents);
  seenBefore_ = std::exchange(seen_, std::move(seen));
}

void RateCheck::compareCounts(uint64_t n, const Counts& agents) {
  const std::vector<uint32_t> got = words();
  Sample sample;
  for (size_t k = 0; k < agents.size(); ++k) {
    sample.same("agents of a level", static_cast<double>(agents[k]), got[shared::LEVELS_AGENTS + k]);
    sample.same("agent-ticks of a level", static_cast<double>(agentTicks_[k]),
                static_cast<double>(uint64_t{got[shared::LEVELS_TICKS + 2 * k + 1]} << 32 |
                                    got[shared::LEVELS_TICKS + 2 * k]));
  }
  judge_.add(n, 0, -1, sample);
}

}  // namespace skitter::validation
