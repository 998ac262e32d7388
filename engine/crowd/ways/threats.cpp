#include "crowd/ways/threats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "assets/scenes/obstacles.h"
#include "crowd/readback.h"
#include "gpu/context.h"
#include "skitter/error.h"
#include "skitter/records.h"

namespace skitter {
namespace crowd {
namespace {

// From one look to the next. Agents re-plan a little later than that.
constexpr double lookSeconds = 0.25;

bool isTimeToLook(const Crowd::Impl& crowd) {
  const auto ticks = std::max(1.0, std::round(lookSeconds / double{crowd.dt}));
  return crowd.tick % static_cast<uint64_t>(ticks) == 0;
}

// Where an agent will stand in the next tick, if the host has said so.
std::optional<glm::vec2> toldPlaceOf(const Kind& kind, uint32_t agent) {
  for (const AgentChange& change : kind.changes.all())
    if (change.agent == agent && change.stands) return change.stands->position;
  return {};
}

// An agent is seen as the next tick begins with it.
std::vector<SeenThreat> look(const Crowd::Impl& crowd) {
  constexpr std::array records = {Record::body};
  std::vector<SeenThreat> seen;
  for (uint32_t h = 0; h < crowd.herds.size(); ++h) {
    const Herd& herd = crowd.herds[h];
    if (herd.isGone() || !(herd.from.threat > 0)) continue;
    const HerdState state = downloadRecords(crowd, h, records);
    for (uint32_t agent = 0; agent < herd.agents; ++agent) {
      if (!herd.presence.has(agent)) continue;
      const SizeRun& run = herd.runOf(agent);
      const std::optional<glm::vec2> told = toldPlaceOf(crowd.kinds[run.kind], run.ofKind(agent));
      const glm::vec2 place = told ? *told : placeOf(&state.body[size_t{agent} * 4 * shared::BODY_STRIDE]);
      seen.push_back({run.kind, {place, herd.from.threat}});
    }
  }
  return seen;
}

}  // namespace

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
  std::vector<SeenThreat> seen = look(crowd);
  moved = moved || seen != crowd.seen;
  crowd.seen = std::move(seen);
  return moved;
}

glm::vec2 placeOf(const float* body) {
  const glm::vec2 tile(shared::tileX(body[3]), shared::tileZ(body[3]));
  return tile * shared::TILE_SIZE + glm::vec2(body[0], body[2]);
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
