#include "app/common/law_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "app/common/drawn.h"
#include "base/clock.h"
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

// How much of a crowd is looked at: about a hundredth of what 10,000 agents cost, and all of a small crowd.
struct Effort {
  uint64_t agents;       // up to so many
  double bodySeconds;    // from one look at bodies to the next
  uint32_t skins;        // at a time
  double windowSeconds;  // for which a skin is looked at
  uint64_t pauses;       // windows that pass until the next one
};
constexpr std::array efforts = {Effort{256, 0.5, 8, 3, 0}, Effort{2048, 0.5, 4, 3, 3},
                                Effort{UINT64_MAX, 2, 2, 1.5, 8}};
const Effort& effortFor(uint64_t agents) {
  return *std::ranges::find_if(efforts, [&](const Effort& each) { return agents <= each.agents; });
}
constexpr uint64_t manyAgents = 2048;  // of more, only some are judged
constexpr uint64_t looksToAll = 10;    // but all in every so many-th look
constexpr double editSeconds = 2;      // for which gait looks at the ground after an edit
constexpr double settleSeconds = 0.5;  // after an edit of the ground, in which bodies follow it
constexpr double nearEdge = 2;         // seconds of the way that is asked for
constexpr double nearOthers = 6;       // times as far as footprints reach
constexpr double nearObstacles = 4;    // leg lengths

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

// Seconds since the last edit of the ground, while feet still step because of it.
std::optional<double> sinceEdit(const Crowd::Impl& crowd, double dt) {
  if (crowd.watchUntil == 0 || crowd.tick > crowd.watchUntil) return {};
  return editSeconds - static_cast<double>(crowd.watchUntil - crowd.tick) * dt;
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

// Whether each body is alone among those that were looked at.
class Neighbours {
 public:
  // `widest`: metres, no less than what isAlone() is asked for.
  Neighbours(const std::vector<SeenBody>& seen, double widest) : seen_(seen), cell_(std::max(widest, 0.01)) {
    for (uint32_t i = 0; i < seen.size(); ++i)
      if (seen[i].body.present) cells_[keyOf(seen[i].place())].push_back(i);
  }
  bool isAlone(uint32_t body, double within) const {
    const glm::dvec2 place = seen_[body].place();
    for (int dx = -1; dx <= 1; ++dx)
      for (int dz = -1; dz <= 1; ++dz) {
        const auto cell = cells_.find(keyOf(place + cell_ * glm::dvec2(dx, dz)));
        if (cell == cells_.end()) continue;
        for (const uint32_t other : cell->second)
          if (other != body && glm::distance(place, seen_[other].place()) < within) return false;
      }
    return true;
  }

 private:
  using Key = std::pair<int64_t, int64_t>;
  Key keyOf(const glm::dvec2& place) const {
    return {static_cast<int64_t>(std::floor(place.x / cell_)),
            static_cast<int64_t>(std::floor(place.y / cell_))};
  }
  const std::vector<SeenBody>& seen_;
  double cell_;
  std::map<Key, std::vector<uint32_t>> cells_;
};

// Whether its herd goes around what is near.
bool givesWay(const Herd& herd) { return herd.avoid || herd.ways || herd.forage; }

bool isNear(std::span<const Obstacle> obstacles, const glm::dvec2& place, double within) {
  return std::ranges::any_of(obstacles,
                             [&](const Obstacle& each) { return crowd::distanceTo(each, place) <= within; });
}

laws::Body drawnBody(const HerdState& state, size_t agent, const crowd::Kind& kind, double footprint,
                     const laws::Ground& ground) {
  const BodyState now = bodyOf(recordOf(state.body, agent, BODY_STRIDE));
  const double asked = askedOf(state, agent);
  return {.present = now.present,
          .position = now.position,
          .rotation = glm::mat3_cast(glm::dquat(now.rotation)),
          .asked = asked,
          .isFree = !isHandicapped(state, agent, kind) &&
                    ground.holds(now.position.x, now.position.z, nearEdge * asked + footprint),
          .isSteady = isSteady(state, agent)};
}

// An agent that gives way and is near others is not free. Where not all agents were looked at, none that
// gives way is.
void blockCrowded(const Crowd::Impl& crowd, bool isOfAll, std::vector<SeenBody>& seen) {
  const auto gives = [&](const SeenBody& each) { return givesWay(crowd.herds[each.herd].from); };
  if (std::ranges::none_of(seen, gives)) return;
  double widest = 0;
  for (const SeenBody& each : seen) widest = std::max(widest, each.footprint);
  const Neighbours neighbours(seen, 2 * nearOthers * widest);
  for (uint32_t i = 0; i < seen.size(); ++i)
    if (gives(seen[i]) && !(isOfAll && neighbours.isAlone(i, 2 * nearOthers * seen[i].footprint)))
      seen[i].body.isFree = false;
}

}  // namespace

LawWatch::LawWatch(const Crowd& crowd, const Scene& scene, double dt, uint32_t skins)
    : scene_(scene), dt_(dt) {
  const uint64_t agents = crowd.capacity();
  const Effort& effort = effortFor(agents);
  bodyTicks_ = ticksOf(effort.bodySeconds, dt);
  windowTicks_ = ticksOf(effort.windowSeconds, dt);
  pauseTicks_ = effort.pauses * windowTicks_;
  skins_ = skins > 0 ? skins : effort.skins;
  bodyStride_ = static_cast<uint32_t>((agents + manyAgents - 1) / manyAgents);
  bodyStride_ = std::max(bodyStride_, 1u);
  skinStride_ = std::max(1u, static_cast<uint32_t>((agents + skins_ - 1) / skins_));
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
  const base::Seconds spent = base::timed([&] {
    if (tick % bodyTicks_ == 0) lookAtBodies(crowd);
    lookAtSkins(crowd);
  });
  cpuSeconds_ += spent.cpu;
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

// The bodies of a herd's agents whose turn it is.
void LawWatch::survey(const Crowd& crowd, uint32_t herd, const HerdState& state, const laws::Ground& ground,
                      const AgentSample& sample, std::vector<SeenBody>& seen) {
  const Crowd::Impl& impl = implOf(crowd);
  const crowd::Herd& of = impl.herds[herd];
  for (uint32_t r = 0; r < of.runs.size(); ++r) {
    const crowd::SizeRun& run = of.runs[r];
    const crowd::Kind& kind = impl.kinds[run.kind];
    const double footprint = double{crowd::footprintRadius(kind.rig)};
    for (uint32_t agent = run.firstOfHerd; agent < run.firstOfHerd + run.agents; ++agent) {
      if (agent % sample.stride != sample.first) continue;
      SeenBody body{herd, agent, r, footprint, drawnBody(state, agent, kind, footprint, ground)};
      if (givesWay(of.from) &&
          isNear(scene_.obstacles, body.place(), nearObstacles * double{kind.rig.legLength}))
        body.body.isFree = false;
      seen.push_back(body);
    }
  }
}

void LawWatch::lookAtBodies(const Crowd& crowd) {
  constexpr std::array records = {Record::body, Record::steer, Record::hurt, Record::carried,
                                  Record::reaction};
  const Crowd::Impl& impl = implOf(crowd);
  const std::optional<double> edited = sinceEdit(impl, dt_);
  if (edited && *edited < settleSeconds) return;
  const uint64_t number = bodyLooks_++;
  const bool isOfAll = bodyStride_ == 1 || number % looksToAll == 1;
  // The same agents for a while, so that there are ways between looks.
  AgentSample sample;
  if (!isOfAll) sample = {static_cast<uint32_t>(number / looksToAll % bodyStride_), bodyStride_};
  // All of them in few copies: one for each agent would take longer.
  const std::vector<HerdState> states = crowd::downloadRecords(impl, records);
  const laws::Ground ground = groundOf(crowd.terrain());
  std::vector<SeenBody> seen;
  for (uint32_t h = 0; h < states.size(); ++h)
    if (!impl.herds[h].isGone()) survey(crowd, h, states[h], ground, sample, seen);
  blockCrowded(impl, isOfAll, seen);
  if (edited)
    for (SeenBody& each : seen) each.body.isFree = false;
  std::vector<laws::Solid> solids;
  for (const SeenBody& each : seen) {
    Judged& judged = judgedOf(crowd, each.herd);
    judged.bodies->look(crowd.tick(), static_cast<double>(crowd.tick()) * dt_, ground, each.body, each.agent,
                        each.run);
    const Model& model = *judged.sizes[each.run];
    if (isOfAll && each.body.present)
      solids.push_back({&model.anatomy, &model.creature, &judged.tally, each.agent, each.body});
  }
  if (isOfAll) laws::judgeApart(crowd.tick(), solids);
}

// Opens and closes windows; whether this tick is in one.
bool LawWatch::isInWindow(uint64_t tick) {
  if (windowOpen_ && tick >= windowBegan_ + windowTicks_) endWindow();
  if (windowOpen_) return true;
  if (windows_ > 0 && tick < windowBegan_ + windowTicks_ + pauseTicks_) return false;
  windowOpen_ = true;
  windowBegan_ = tick;
  ++windows_;
  return true;
}

void LawWatch::lookAtSkins(const Crowd& crowd) {
  const Crowd::Impl& impl = implOf(crowd);
  // Agents that tick more rarely than the clock have no motion from tick to tick.
  if (impl.rates || !isInWindow(crowd.tick())) return;
  constexpr std::array records = {Record::body, Record::pose, Record::chain,
                                  Record::foot, Record::hurt, Record::reaction};
  const AgentSample sample{static_cast<uint32_t>((windows_ - 1) % skinStride_), skinStride_};
  const std::vector<HerdState> states = crowd::downloadRecords(impl, records, sample);
  const laws::Ground ground = groundOf(crowd.terrain());
  for (uint32_t h = 0; h < states.size(); ++h) {
    if (impl.herds[h].isGone()) continue;
    size_t number = 0;
    for (uint32_t r = 0; r < impl.herds[h].runs.size(); ++r) {
      const crowd::SizeRun& run = impl.herds[h].runs[r];
      for (uint32_t agent = run.firstOfHerd; agent < run.firstOfHerd + run.agents; ++agent)
        if (agent % sample.stride == sample.first)
          lookAtSkin(crowd, {h, agent}, r, states[h], number++, ground);
    }
  }
}

// `number` is the agent's in the state.
void LawWatch::lookAtSkin(const Crowd& crowd, const AgentKey& key, uint32_t run, const HerdState& state,
                          size_t number, const laws::Ground& ground) {
  const Crowd::Impl& impl = implOf(crowd);
  const crowd::Kind& kind = impl.kinds[impl.herds[key.first].runs[run].kind];
  const BodyState body = bodyOf(recordOf(state.body, number, BODY_STRIDE));
  if (!body.present || !isSteady(state, number)) {
    judges_.erase(key);
    unfit_.insert(key);
  }
  if (unfit_.contains(key)) return;
  laws::Moment moment{
      .tick = crowd.tick(), .position = body.position, .bones = drawnBones(state, kind, number, body)};
  if (moment.bones.empty()) return;
  // Feet whose ground moved are told to step, and stand in the air until they do.
  const bool groundMoves = sinceEdit(impl, dt_).has_value();
  const uint32_t idle = idleLegsOf(state, number, kind);
  for (size_t l = 0; l < kind.rig.legs.size(); ++l) {
    moment.carries.push_back((idle >> l & 1u) == 0);
    if (!state.foot.empty() && !groundMoves)
      moment.stands.push_back(recordOf(state.foot, number * kind.rig.legs.size() + l, FOOT_STRIDE)[3] >= 1);
  }
  Judged& judged = judgedOf(crowd, key.first);
  const Model& model = *judged.sizes[run];
  judges_.try_emplace(key, model.creature, model.anatomy, judged.tally, key.second, dt_)
      .first->second.look(moment, ground);
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
