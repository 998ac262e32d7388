#include "app/common/law_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "app/common/drawn.h"
#include "crowd/damage.h"
#include "crowd/events.h"
#include "crowd/herd.h"
#include "crowd/radius.h"
#include "crowd/readback.h"
#include "crowd/ways/shapes.h"
#include "skitter/decode.h"
#include "skitter/error.h"
#include "skitter/records.h"

namespace skitter::app {
namespace {

using namespace shared;

constexpr double windowSeconds = 3;
constexpr uint64_t fewAgents = 256, someAgents = 2048, manyAgents = 4096;
constexpr uint64_t looksToAll = 10;  // in a large crowd every so many-th look is at all bodies
constexpr double nearEdge = 2;       // seconds of the way that is asked for
constexpr double nearOthers = 3;     // times as far as footprints reach
constexpr double nearObstacles = 4;  // leg lengths

uint64_t ticksOf(double seconds, double dt) {
  return std::max<uint64_t>(1, static_cast<uint64_t>(std::llround(seconds / dt)));
}

bool jumps(const Event& event) {
  return std::holds_alternative<Teleport>(event.what) || std::holds_alternative<Addition>(event.what) ||
         std::holds_alternative<Removal>(event.what);
}

laws::Ground groundOf(const Heightfield& terrain) {
  return {.originX = double{terrain.originX()},
          .originZ = double{terrain.originZ()},
          .spacingX = double{terrain.spacingX},
          .spacingZ = double{terrain.spacingZ},
          .columns = terrain.columns,
          .rows = terrain.rows,
          .heights = terrain.heights};
}

// Masks of its legs that are lost, and that are stuck.
uint32_t idleLegsOf(const HerdState& state, size_t agent, const crowd::Kind& kind) {
  if (state.hurt.empty()) return 0;
  const std::span<const float> hurt = recordOf(state.hurt, agent, hurtStride(kind.legs));
  return static_cast<uint32_t>(hurt[0]) | static_cast<uint32_t>(hurt[1]);
}
bool isHandicapped(const HerdState& state, size_t agent, const crowd::Kind& kind) {
  if (state.hurt.empty()) return false;
  const std::span<const float> hurt = recordOf(state.hurt, agent, hurtStride(kind.legs));
  const bool carries = !state.carried.empty() && recordOf(state.carried, agent, CARRIED_STRIDE)[3] != 0;
  return hurt[0] != 0 || hurt[1] != 0 || hurt[2] != 0 || carries;
}
bool isSteady(const HerdState& state, size_t agent) {
  return state.reaction.empty() || recordOf(state.reaction, agent, REACTION_STRIDE)[0] == REACTION_STEADY;
}
double askedOf(const HerdState& state, size_t agent) {
  const std::span<const float> steer = recordOf(state.steer, agent, STEER_STRIDE);
  return std::hypot(double{steer[0]}, double{steer[1]});
}

// Whether each body is alone: nobody within a few footprints, as far as all bodies were read.
class Neighbours {
 public:
  Neighbours(const std::vector<glm::dvec2>& places, double widest)
      : places_(places), cell_(std::max(widest, 0.01)) {
    for (uint32_t i = 0; i < places.size(); ++i) cells_[keyOf(places[i])].push_back(i);
  }
  bool isAlone(uint32_t body, double within) const {
    const glm::dvec2 place = places_[body];
    for (int dx = -1; dx <= 1; ++dx)
      for (int dz = -1; dz <= 1; ++dz) {
        const auto cell = cells_.find(keyOf(place + cell_ * glm::dvec2(dx, dz)));
        if (cell == cells_.end()) continue;
        for (const uint32_t other : cell->second)
          if (other != body && glm::distance(place, places_[other]) < within) return false;
      }
    return true;
  }

 private:
  using Key = std::pair<int64_t, int64_t>;
  Key keyOf(const glm::dvec2& place) const {
    return {static_cast<int64_t>(std::floor(place.x / cell_)),
            static_cast<int64_t>(std::floor(place.y / cell_))};
  }
  const std::vector<glm::dvec2>& places_;
  double cell_;
  std::map<Key, std::vector<uint32_t>> cells_;
};

// Whether its herd goes around what is near.
bool givesWay(const Herd& herd) { return herd.avoid || herd.ways || herd.forage; }

}  // namespace

LawWatch::LawWatch(const Crowd& crowd, const Scene& scene, double dt, uint32_t skins)
    : scene_(scene), dt_(dt), agents_(crowd.capacity()) {
  const bool isFew = agents_ <= fewAgents;
  bodyTicks_ = ticksOf(agents_ <= someAgents ? 0.5 : 1, dt);
  windowTicks_ = ticksOf(windowSeconds, dt);
  pauseTicks_ = isFew ? 0 : 3 * windowTicks_;
  skins_ = skins > 0 ? skins : isFew ? 8 : 4;
  bodyStride_ = static_cast<uint32_t>((agents_ + manyAgents - 1) / manyAgents);
  bodyStride_ = std::max(bodyStride_, 1u);
  skinStride_ = std::max(1u, static_cast<uint32_t>((agents_ + skins_ - 1) / skins_));
  for (const Event& event : scene.events)
    if (jumps(event)) jumps_.insert(crowd::tickOf(event, dt));
}

LawWatch::~LawWatch() = default;

void LawWatch::look(const Crowd& crowd) {
  const uint64_t tick = crowd.tick();
  if (revision_ != implOf(crowd).revision) follow(crowd);
  if (jumps_.contains(tick)) {
    judges_.clear();
    unfit_.clear();
    windowOpen_ = false;
    for (auto& [key, judged] : herds_) judged.bodies->forget();
  }
  if (tick % bodyTicks_ == 0) lookAtBodies(crowd);
  lookAtSkins(crowd);
}

// Herds have come or gone, and their kinds with them.
void LawWatch::follow(const Crowd& crowd) {
  endWindow();
  for (auto& [key, judged] : herds_) judged.bodies.reset();
  models_.clear();
  const Crowd::Impl& impl = implOf(crowd);
  revision_ = impl.revision;
  for (uint32_t h = 0; h < impl.herds.size(); ++h) {
    const crowd::Herd& herd = impl.herds[h];
    if (herd.isGone()) continue;
    const crowd::Kind& first = impl.kinds[herd.runs.front().kind];
    Judged& judged =
        herds_
            .try_emplace({h, herd.generation},
                         Judged{laws::Tally(h, first.rig.name, nameOf(first.controller)), {}, {}})
            .first->second;
    judged.sizes.clear();
    std::vector<const laws::Anatomy*> anatomies;
    std::vector<const laws::Creature*> creatures;
    for (const crowd::SizeRun& run : herd.runs) {
      std::unique_ptr<Model>& model = models_[run.kind];
      if (!model) {
        laws::Creature creature = drawnCreature(impl.kinds[run.kind]);
        laws::Anatomy anatomy(creature);
        model = std::make_unique<Model>(Model{std::move(creature), std::move(anatomy)});
      }
      judged.sizes.push_back(model.get());
      anatomies.push_back(&model->anatomy);
      creatures.push_back(&model->creature);
    }
    judged.bodies.emplace(std::move(anatomies), std::move(creatures), judged.tally);
  }
}

LawWatch::Judged& LawWatch::judgedOf(const Crowd& crowd, uint32_t herd) {
  return herds_.at({herd, implOf(crowd).herds[herd].generation});
}

void LawWatch::lookAtBodies(const Crowd& crowd) {
  constexpr std::array records = {Record::body, Record::steer, Record::hurt, Record::carried,
                                  Record::reaction};
  const Crowd::Impl& impl = implOf(crowd);
  const uint64_t number = bodyLooks_++;
  const bool isOfAll = bodyStride_ == 1 || number % looksToAll == 2;
  // The same agents for a while, so that there are ways between looks.
  AgentSample sample;
  if (!isOfAll) sample = {static_cast<uint32_t>(number / looksToAll % bodyStride_), bodyStride_};
  const std::vector<HerdState> states = crowd::downloadRecords(impl, records, sample);
  const laws::Ground ground = groundOf(crowd.terrain());

  std::vector<laws::Solid> solids;
  std::vector<glm::dvec2> places;
  std::vector<double> footprints;
  std::vector<std::vector<uint32_t>> numbers(states.size());  // of each herd's agents among `places`
  struct Seen {
    std::vector<laws::Body> bodies;
    std::vector<uint32_t> agents, sizes;
  };
  std::vector<Seen> seen(states.size());
  for (uint32_t h = 0; h < states.size(); ++h) {
    if (impl.herds[h].isGone()) continue;
    const crowd::Herd& herd = impl.herds[h];
    Judged& judged = judgedOf(crowd, h);
    size_t at = 0;
    for (uint32_t r = 0; r < herd.runs.size(); ++r) {
      const crowd::SizeRun& run = herd.runs[r];
      const crowd::Kind& kind = impl.kinds[run.kind];
      const double footprint = double{crowd::footprintRadius(kind.rig)};
      for (uint32_t agent = run.firstOfHerd; agent < run.firstOfHerd + run.agents; ++agent) {
        if (agent % sample.stride != sample.first) continue;
        const HerdState& state = states[h];
        const BodyState now = bodyOf(recordOf(state.body, at, BODY_STRIDE));
        laws::Body body{.present = now.present,
                        .position = now.position,
                        .rotation = glm::mat3_cast(glm::dquat(now.rotation)),
                        .asked = askedOf(state, at),
                        .isFree = !isHandicapped(state, at, kind),
                        .isSteady = isSteady(state, at)};
        const double margin = nearEdge * body.asked + footprint;
        body.isFree = body.isFree && ground.holds(now.position.x, now.position.z, margin);
        if (body.isFree && givesWay(herd.from)) {
          body.isFree = isOfAll;
          for (const Obstacle& obstacle : scene_.obstacles)
            body.isFree = body.isFree && crowd::distanceTo(obstacle, {now.position.x, now.position.z}) >
                                             nearObstacles * double{kind.rig.legLength};
        }
        if (body.present) {
          numbers[h].push_back(static_cast<uint32_t>(places.size()));
          places.emplace_back(now.position.x, now.position.z);
          footprints.push_back(footprint);
          solids.push_back(
              {&judged.sizes[r]->anatomy, &judged.sizes[r]->creature, &judged.tally, agent, body});
        } else {
          numbers[h].push_back(UINT32_MAX);
        }
        seen[h].bodies.push_back(body);
        seen[h].agents.push_back(agent);
        seen[h].sizes.push_back(r);
        ++at;
      }
    }
  }
  const bool someGiveWay = std::ranges::any_of(
      impl.herds, [](const crowd::Herd& herd) { return !herd.isGone() && givesWay(herd.from); });
  if (someGiveWay && isOfAll && !places.empty()) {
    const Neighbours neighbours(places, 2 * nearOthers * std::ranges::max(footprints));
    for (uint32_t h = 0; h < states.size(); ++h)
      for (size_t i = 0; i < numbers[h].size(); ++i)
        if (const uint32_t n = numbers[h][i]; n != UINT32_MAX && givesWay(impl.herds[h].from))
          seen[h].bodies[i].isFree =
              seen[h].bodies[i].isFree && neighbours.isAlone(n, 2 * nearOthers * footprints[n]);
  }
  const double seconds = static_cast<double>(crowd.tick()) * dt_;
  for (uint32_t h = 0; h < states.size(); ++h)
    if (!impl.herds[h].isGone())
      judgedOf(crowd, h).bodies->look(crowd.tick(), seconds, ground, seen[h].bodies, seen[h].agents,
                                      seen[h].sizes);
  if (isOfAll) laws::judgeApart(crowd.tick(), solids);
}

void LawWatch::lookAtSkins(const Crowd& crowd) {
  const Crowd::Impl& impl = implOf(crowd);
  // Agents that tick more rarely than the clock have no motion from tick to tick.
  if (impl.rates) return;
  const uint64_t tick = crowd.tick();
  if (windowOpen_ && tick >= windowBegan_ + windowTicks_) endWindow();
  if (!windowOpen_) {
    if (windows_ > 0 && tick < windowBegan_ + windowTicks_ + pauseTicks_) return;
    windowOpen_ = true;
    windowBegan_ = tick;
    ++windows_;
  }
  constexpr std::array records = {Record::body, Record::pose, Record::chain,
                                  Record::foot, Record::hurt, Record::reaction};
  const AgentSample sample{static_cast<uint32_t>((windows_ - 1) % skinStride_), skinStride_};
  const std::vector<HerdState> states = crowd::downloadRecords(impl, records, sample);
  const laws::Ground ground = groundOf(crowd.terrain());
  // Feet whose ground moved are told to step, and stand in the air until they do.
  const bool groundMoves = impl.watchUntil > 0 && tick <= impl.watchUntil;
  for (uint32_t h = 0; h < states.size(); ++h) {
    if (impl.herds[h].isGone()) continue;
    Judged& judged = judgedOf(crowd, h);
    size_t at = 0;
    for (uint32_t r = 0; r < impl.herds[h].runs.size(); ++r) {
      const crowd::SizeRun& run = impl.herds[h].runs[r];
      const crowd::Kind& kind = impl.kinds[run.kind];
      const HerdState& state = states[h];
      for (uint32_t agent = run.firstOfHerd; agent < run.firstOfHerd + run.agents; ++agent) {
        if (agent % sample.stride != sample.first) continue;
        const size_t number = at++;
        const AgentKey key{h, agent};
        const BodyState body = bodyOf(recordOf(state.body, number, BODY_STRIDE));
        if (!body.present || !isSteady(state, number)) {
          judges_.erase(key);
          unfit_.insert(key);
        }
        if (unfit_.contains(key)) continue;
        laws::Moment moment{
            .tick = tick, .position = body.position, .bones = drawnBones(state, kind, number, body)};
        if (moment.bones.empty()) continue;
        const uint32_t idle = idleLegsOf(state, number, kind);
        for (size_t l = 0; l < kind.rig.legs.size(); ++l) {
          moment.carries.push_back((idle >> l & 1u) == 0);
          if (!state.foot.empty() && !groundMoves)
            moment.stands.push_back(recordOf(state.foot, number * kind.rig.legs.size() + l, FOOT_STRIDE)[3] >=
                                    1);
        }
        const Model& model = *judged.sizes[r];
        judges_.try_emplace(key, model.creature, model.anatomy, judged.tally, agent, dt_)
            .first->second.look(moment, ground);
      }
    }
  }
}

void LawWatch::endWindow() {
  for (auto& [key, judge] : judges_) judge.finish();
  judges_.clear();
  unfit_.clear();
  windowOpen_ = false;
}

std::vector<laws::Figure> LawWatch::figures() {
  endWindow();
  std::vector<laws::Figure> all;
  for (const auto& [key, judged] : herds_) std::ranges::copy(judged.tally.figures(), std::back_inserter(all));
  return all;
}

std::vector<laws::Figure> brokenOf(std::vector<laws::Figure> figures) {
  std::erase_if(figures, [](const laws::Figure& figure) { return figure.isKept; });
  return figures;
}

nlohmann::ordered_json warningsJson(std::span<const laws::Figure> broken) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const laws::Figure& figure : broken)
    all.push_back({{"law", laws::nameOf(figure.law)},
                   {"herd", figure.herd},
                   {"agents", figure.agents},
                   {"firstTick", figure.firstTick},
                   {"worst", figure.worst},
                   {"text", figure.text}});
  return all;
}

void warnOf(std::span<const laws::Figure> broken) {
  for (const laws::Figure& figure : broken) fmt::print(stderr, "warning: {}\n", figure.text);
}

std::string namesOf(std::span<const laws::Figure> figures) {
  std::set<laws::Law> laws;
  for (const laws::Figure& figure : figures) laws.insert(figure.law);
  std::vector<const char*> names;
  for (const laws::Law law : laws) names.push_back(laws::nameOf(law));
  return fmt::format("{}", fmt::join(names, ", "));
}

void refuseBroken(std::span<const laws::Figure> broken) {
  if (!broken.empty())
    throw Error(Error::Kind::check, fmt::format("laws of the visible world are broken: {}", namesOf(broken)));
}

}  // namespace skitter::app
