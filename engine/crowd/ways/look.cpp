#include "crowd/ways/look.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "assets/scenes/obstacles.h"
#include "crowd/readback.h"
#include "gpu/context.h"
#include "shared/forage.h"
#include "skitter/decode.h"
#include "skitter/error.h"
#include "skitter/records.h"

namespace skitter {
namespace crowd {
namespace {

// From one look to the next. Agents re-plan a little later than that.
constexpr double lookSeconds = 0.25;

struct SeenAgent {
  uint32_t kind;
  glm::vec2 place;
};

// Where agents of a kind will stand in the next tick, whom the host has put elsewhere.
std::map<uint32_t, glm::vec2> toldPlaces(const Kind& kind) {
  std::map<uint32_t, glm::vec2> told;
  for (const AgentChange& change : kind.changes.all())
    if (change.stands) told[change.agent] = change.stands->position;
  return told;
}

constexpr std::array bodyAlone = {Record::body};

// The agents that are there, as the next tick begins with them.
std::vector<SeenAgent> agentsIn(const Crowd::Impl& crowd, uint32_t number) {
  std::vector<SeenAgent> seen;
  const Herd& herd = crowd.herds[number];
  const HerdState state = downloadRecords(crowd, number, bodyAlone);
  for (const SizeRun& run : herd.runs) {
    const std::map<uint32_t, glm::vec2> told = toldPlaces(crowd.kinds[run.kind]);
    for (uint32_t agent = run.firstOfHerd; agent < run.firstOfHerd + run.agents; ++agent) {
      if (!herd.presence.has(agent)) continue;
      const auto moved = told.find(run.ofKind(agent));
      seen.push_back({run.kind, moved != told.end()
                                    ? moved->second
                                    : placeOf(&state.body[size_t{agent} * 4 * shared::BODY_STRIDE])});
    }
  }
  return seen;
}

// Where one agent will stand as the next tick begins, by its own record alone.
std::optional<glm::vec2> agentAt(const Crowd::Impl& crowd, uint32_t number, uint32_t agent) {
  const Herd& herd = crowd.herds[number];
  if (agent >= herd.agents || !herd.presence.has(agent)) return {};
  const SizeRun& run = herd.runOf(agent);
  for (const AgentChange& change : crowd.kinds[run.kind].changes.all())
    if (change.agent == run.ofKind(agent) && change.stands) return change.stands->position;
  // Of as many agents as there are from one to the next, the first is the only one.
  const HerdState state = downloadRecords(crowd, number, bodyAlone, {.first = agent, .stride = herd.agents});
  return placeOf(state.body.data());
}

bool hasAgents(const Crowd::Impl& crowd, uint32_t number) {
  if (number >= crowd.herds.size() || crowd.herds[number].isGone()) return false;
  // A crowd that is being made has no agents yet.
  return std::ranges::none_of(crowd.herds[number].runs, [&](const SizeRun& run) {
    return run.agents > 0 && crowd.kinds[run.kind].pages.empty();
  });
}

std::vector<SeenThreat> lookForThreats(const Crowd::Impl& crowd) {
  std::vector<SeenThreat> seen;
  for (uint32_t h = 0; h < crowd.herds.size(); ++h) {
    const float radius = crowd.herds[h].from.threat;
    if (!(radius > 0) || !hasAgents(crowd, h)) continue;
    for (const SeenAgent& each : agentsIn(crowd, h)) seen.push_back({each.kind, {each.place, radius}});
  }
  return seen;
}

}  // namespace

bool isTimeToLook(const Crowd::Impl& crowd) {
  const auto ticks = std::max(1.0, std::round(lookSeconds / double{crowd.dt}));
  return crowd.tick % static_cast<uint64_t>(ticks) == 0;
}

std::vector<Threat> threatsTo(const Crowd::Impl& crowd, const Kind& kind) {
  std::vector<Threat> all = crowd.threats;
  const auto own = static_cast<uint32_t>(&kind - crowd.kinds.data());
  for (const SeenThreat& seen : crowd.seen)
    if (seen.kind != own) all.push_back(seen.threat);
  return all;
}

bool threatsHaveMoved(Crowd::Impl& crowd) {
  const auto isThreat = [](const Kind& kind) { return kind.threat > 0 && kind.agents > 0; };
  const auto finds = [](const Kind& kind) { return kind.ways != nullptr; };
  if (std::ranges::none_of(crowd.kinds, finds)) return false;
  bool moved = std::exchange(crowd.threatsAreNew, false);
  if ((crowd.seen.empty() && std::ranges::none_of(crowd.kinds, isThreat)) || !isTimeToLook(crowd))
    return moved;
  crowd.context->waitIdle();
  std::vector<SeenThreat> seen = lookForThreats(crowd);
  moved = moved || seen != crowd.seen;
  crowd.seen = std::move(seen);
  return moved;
}

void loadForagers(Crowd::Impl& crowd) {
  const auto carries = [&](uint32_t number) {
    const std::optional<Forage>& forage = crowd.herds[number].from.forage;
    return forage && forage->load.mass > 0 && hasAgents(crowd, number);
  };
  if (!isTimeToLook(crowd)) return;
  bool waits = false;
  for (uint32_t h = 0; h < crowd.herds.size(); ++h) {
    if (!carries(h)) continue;
    if (!std::exchange(waits, true)) crowd.context->waitIdle();
    const Herd& herd = crowd.herds[h];
    const HerdState state = downloadRecords(crowd, h, std::array{Record::forager});
    const SizeRun& run = herd.runs.front();  // who forages is of one size
    Kind& kind = crowd.kinds[run.kind];
    // An agent that is put elsewhere begins at rest there, without a load.
    const std::map<uint32_t, glm::vec2> told = toldPlaces(kind);
    for (uint32_t place = 0; place < run.agents; ++place) {
      if (!herd.presence.has(place)) continue;
      const uint32_t agent = run.ofKind(place);
      const auto packed = static_cast<int>(state.forager[size_t{place} * 4 * shared::FORAGER_STRIDE + 3]);
      const bool isLaden = packed % shared::FORAGE_STATES == shared::FORAGE_LADEN && !told.contains(agent);
      const Load load = isLaden ? herd.from.forage->load : Load{};
      if (kind.carriedBy(agent) == load) continue;
      kind.setLoad(agent, load);
      kind.changes.of(agent, kind.agents).hurt = true;
    }
  }
}

std::optional<glm::vec2> leaderOf(const Crowd::Impl& crowd, const Goal& goal) {
  if (!hasAgents(crowd, goal.leader)) return {};
  crowd.context->waitIdle();
  if (goal.agent) return agentAt(crowd, goal.leader, *goal.agent);
  const std::vector<SeenAgent> all = agentsIn(crowd, goal.leader);
  if (all.empty()) return {};
  glm::dvec2 sum(0);
  for (const SeenAgent& each : all) sum += each.place;
  return glm::vec2(sum / static_cast<double>(all.size()));
}

glm::vec2 placeOf(const float* body) {
  const glm::dvec3 position = bodyOf({body, size_t{4 * shared::BODY_STRIDE}}).position;
  return {position.x, position.z};
}

}  // namespace crowd

void Crowd::setThreat(uint32_t number, const Threat& threat) {
  if (number >= Scene::maxThreats)
    throw inputError(fmt::format("threat {}: expected a number less than {}", number, Scene::maxThreats));
  scenes::checkThreat(threat, fmt::format("threat {}", number));
  std::vector<Threat>& all = impl_->threats;
  if (number >= all.size()) all.resize(number + 1, Threat{.radius = 0});
  all[number] = threat;
  while (!all.empty() && all.back().radius == 0) all.pop_back();
  impl_->threatsAreNew = true;
}

const std::vector<Threat>& Crowd::threats() const { return impl_->threats; }

}  // namespace skitter
