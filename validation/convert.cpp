#include "validation/convert.h"

#include <cmath>

#include "skitter/records.h"
#include "validation/vec4s.h"

namespace skitter::validation {
namespace {

// A mask of legs; nonsense, which cannot be converted, reads as none.
uint32_t mask(double value) { return value >= 0 && value < 0x1p32 ? static_cast<uint32_t>(value) : 0; }

glm::dquat quaternion(const glm::dvec4& v) { return {v.w, v.x, v.y, v.z}; }
// The directions of pairs of bones, from that vec4 on.
std::vector<glm::dvec2> pairsOf(const std::vector<float>& records, size_t base, int bones) {
  std::vector<glm::dvec2> pairs;
  for (int b = 0; b < bones; ++b) {
    const glm::dvec4 pair = load(records, base + static_cast<size_t>(b) / 2);
    pairs.push_back(b % 2 == 0 ? glm::dvec2(pair.x, pair.y) : glm::dvec2(pair.z, pair.w));
  }
  return pairs;
}

glm::dvec4 components(const glm::dquat& q) { return {q.x, q.y, q.z, q.w}; }

void set(double& to, float from) { to = from; }
void set(bool& to, float from) { to = from != 0; }

// A parameter that the reference lacks does not compile in tuningOf, and one that the engine lacks does not
// compile here. A bool between doubles takes the room of a double.
#define COUNT(name) +1
static_assert(sizeof(reference::Tuning) == (0 REFERENCE_PARAMETERS(COUNT)) * sizeof(double));
#undef COUNT

// The packed tile of the body that a leg belongs to.
float bodyTileOf(const HerdState& state, size_t leg) {
  const size_t legs = state.step.size() / (4 * shared::STEP_STRIDE) / state.agents;
  return static_cast<float>(load(state.body, at(leg / legs, shared::BODY_STRIDE)).w);
}

}  // namespace

reference::Tuning tuningOf(const shared::Parameters& p) {
  reference::Tuning t;
#define SET(name) set(t.name, p.name);
  REFERENCE_PARAMETERS(SET)
#undef SET
  return t;
}

reference::Heights heightsOf(const Heightfield& field, const shared::Parameters& p) {
  return {field.heights.data(),
          static_cast<int>(field.columns),
          static_cast<int>(field.rows),
          p.originX,
          p.originZ,
          p.inverseSpacingX,
          p.inverseSpacingZ};
}

reference::Creature creatureOf(const std::vector<float>& rigRecords, int legs, int bones, int groups) {
  reference::Creature creature;
  creature.groups = groups;
  for (int l = 0; l < legs; ++l) {
    const size_t base = static_cast<size_t>(l) * static_cast<size_t>(shared::rigStride(bones));
    reference::Limb limb;
    const glm::dvec4 root = load(rigRecords, base), home = load(rigRecords, base + 1);
    const glm::dvec4 order = load(rigRecords, base + 2);
    limb.root = root;
    limb.reach = root.w;
    limb.home = home;
    limb.group = static_cast<int>(home.w);
    limb.lag = order.x;
    limb.neighbours = mask(order.y);
    for (int b = 0; b < bones; ++b) {
      const size_t record =
          base + shared::RIG_LEG_STRIDE + at(static_cast<size_t>(b), shared::RIG_BONE_STRIDE);
      const glm::dvec4 x = load(rigRecords, record), z = load(rigRecords, record + 1);
      const glm::dvec4 start = load(rigRecords, record + 2);
      reference::BoneRest bone;
      bone.frame = glm::dmat3(glm::dvec3(x), glm::cross(glm::dvec3(z), glm::dvec3(x)), glm::dvec3(z));
      bone.length = x.w;
      bone.tanHalfCone = z.w;
      bone.start = start;
      bone.stiffness = start.w;
      limb.bones.push_back(bone);
    }
    creature.limbs.push_back(limb);
  }
  return creature;
}

reference::KeyPoses keyPosesOf(const crowd::KeyPoses& poses, int legs, int bones) {
  reference::KeyPoses result;
  result.stride = poses.stride;
  for (int l = 0; l < legs; ++l) {
    const size_t base = at(static_cast<size_t>(l), shared::keyStride(bones, poses.keys));
    const auto directions = [&](int pose) {
      return pairsOf(poses.records, base + 1 + at(static_cast<size_t>(pose), shared::chainStride(bones)),
                     bones);
    };
    const glm::dvec4 contact = load(poses.records, base);
    auto& leg = result.legs.emplace_back();
    leg.land = contact.x;
    leg.stand = contact.y;
    leg.standing = directions(0);
    for (int k = 0; k < poses.keys; ++k) {
      leg.keys.push_back(directions(1 + 2 * k));
      leg.tangents.push_back(directions(2 + 2 * k));
    }
  }
  return result;
}

reference::Goal goalOf(const HerdState& state, size_t agent) {
  const size_t base = at(agent, shared::GOAL_STRIDE);
  const glm::dvec4 ends = load(state.goal, base), how = load(state.goal, base + 1);
  const auto kind = how.z == shared::GOAL_CROSS   ? reference::GoalKind::cross
                    : how.z == shared::GOAL_POINT ? reference::GoalKind::point
                                                  : reference::GoalKind::none;
  return {{ends.x, ends.y}, {ends.z, ends.w}, how.x, how.y, kind};
}

void putGoal(HerdState& state, size_t agent, const reference::Goal& goal) {
  const size_t base = at(agent, shared::GOAL_STRIDE);
  const float kind = goal.kind == reference::GoalKind::cross   ? shared::GOAL_CROSS
                     : goal.kind == reference::GoalKind::point ? shared::GOAL_POINT
                                                               : shared::GOAL_NONE;
  store(state.goal, base, {goal.target, goal.otherEnd});
  store(state.goal, base + 1, {goal.speed, goal.arrivalRadius, kind, 0});
}

glm::dvec2 desiredOf(const HerdState& state, size_t agent) {
  return load(state.steer, at(agent, shared::STEER_STRIDE));
}

bool asleepOf(const HerdState& state, size_t agent) {
  return load(state.steer, at(agent, shared::STEER_STRIDE)).z == 1;
}

void putSteer(HerdState& state, size_t agent, const glm::dvec2& desired, bool asleep) {
  store(state.steer, at(agent, shared::STEER_STRIDE), {desired, asleep ? 1 : 0, 0});
}

reference::AgentBody bodyOf(const HerdState& state, size_t agent) {
  const size_t base = at(agent, shared::BODY_STRIDE);
  const glm::dvec4 local = load(state.body, base), way = load(state.body, base + 1);
  const glm::dvec4 rates = load(state.body, base + 3);
  reference::AgentBody body;
  body.localX = local.x;
  body.y = local.y;
  body.localZ = local.z;
  const auto tile = static_cast<float>(local.w);
  body.tileX = shared::tileX(tile);
  body.tileZ = shared::tileZ(tile);
  body.heading = way;
  body.speed = way.z;
  body.orientation = quaternion(load(state.body, base + 2));
  body.turnRate = rates.x;
  body.still = rates.y;
  body.follow = rates.z;
  body.surfaceSpeed = rates.w;
  return body;
}

void putBody(HerdState& state, size_t agent, const reference::AgentBody& body) {
  const size_t base = at(agent, shared::BODY_STRIDE);
  store(state.body, base, {body.localX, body.y, body.localZ, shared::TILES * body.tileX + body.tileZ});
  store(state.body, base + 1, {body.heading, body.speed, 0});
  store(state.body, base + 2, components(body.orientation));
  store(state.body, base + 3, {body.turnRate, body.still, body.follow, body.surfaceSpeed});
}

reference::Gait gaitOf(const HerdState& state, size_t agent) {
  const size_t base = at(agent, shared::GAIT_STRIDE);
  const glm::dvec4 a = load(state.gait, base), b = load(state.gait, base + 1);
  return {a.x, mask(a.y), mask(a.z), a.w, b.x, b.y, mask(b.z)};
}

void putGait(HerdState& state, size_t agent, const reference::Gait& gait) {
  const size_t base = at(agent, shared::GAIT_STRIDE);
  store(state.gait, base, {gait.phase, gait.lift, gait.reaim, gait.duration});
  store(state.gait, base + 1, {gait.halfStride, gait.cycle, gait.air, 0});
}

reference::Step stepOf(const HerdState& state, size_t leg) {
  const size_t base = at(leg, shared::STEP_STRIDE), arc = at(leg, shared::ARC_STRIDE);
  const glm::dvec4 landing = load(state.step, base), liftOff = load(state.step, base + 1);
  const auto packed = static_cast<float>(liftOff.w);
  const float body = bodyTileOf(state, leg), x = shared::tileX(body), z = shared::tileZ(body);
  const float apart = shared::tilesApart(shared::tileOfTicks(packed), shared::stepTile(x, z));
  reference::Step step;
  step.tileX = x + shared::apartX(apart);
  step.tileZ = z + shared::apartZ(apart);
  step.landing = landing;
  step.liftOff = liftOff;
  step.firstTick = landing.w;
  step.duration = std::copysign(shared::ticksOf(packed), packed);
  if (state.arc.empty()) return step;
  step.lift = load(state.arc, arc);
  step.startTangent = load(state.arc, arc + 1);
  return step;
}

void putStep(HerdState& state, size_t leg, const reference::Step& step) {
  const size_t base = at(leg, shared::STEP_STRIDE), arc = at(leg, shared::ARC_STRIDE);
  const float tile = shared::stepTile(static_cast<float>(step.tileX), static_cast<float>(step.tileZ));
  const float packed = shared::packedTicks(static_cast<float>(step.duration), tile);
  store(state.step, base, {step.landing, step.firstTick});
  store(state.step, base + 1, {step.liftOff, packed});
  store(state.arc, arc, {step.lift, 0});
  store(state.arc, arc + 1, {step.startTangent, 0});
}

reference::Foot footOf(const HerdState& state, size_t leg) {
  const glm::dvec4 foot = load(state.foot, at(leg, shared::FOOT_STRIDE));
  return {foot, foot.w};
}

void putFoot(HerdState& state, size_t leg, const reference::Foot& foot) {
  store(state.foot, at(leg, shared::FOOT_STRIDE), {foot.target, foot.progress});
}

reference::Chain chainOf(const HerdState& state, size_t leg, int bones) {
  const size_t base = at(leg, shared::chainStride(bones));
  reference::Chain chain;
  chain.directions = pairsOf(state.chain, base, bones);
  if (!state.tip.empty()) {
    const glm::dvec4 tip = load(state.tip, at(leg, shared::TIP_STRIDE));
    chain.tip = tip;
    chain.reachError = tip.w;
  }
  return chain;
}

void putChain(HerdState& state, size_t leg, int bones, const reference::Chain& chain) {
  storePairs(state.chain, at(leg, shared::chainStride(bones)), chain.directions);
  if (!state.tip.empty()) store(state.tip, at(leg, shared::TIP_STRIDE), {chain.tip, chain.reachError});
}

namespace {

// The first float of a leg's pair.
size_t missAt(size_t agent, size_t leg, int legs) {
  return 2 * static_cast<size_t>(shared::missPair(static_cast<int>(agent), static_cast<int>(leg), legs));
}

}  // namespace

double missOf(const HerdState& state, size_t agent, size_t leg, int legs, uint64_t n) {
  if (state.miss.empty()) return 0;
  const float* told = &state.miss[missAt(agent, leg, legs)];
  return told[1] == static_cast<float>(n) ? double{told[0]} : 0;
}

void putMiss(HerdState& state, size_t agent, size_t leg, int legs, uint64_t n, double miss) {
  if (state.miss.empty()) return;
  float* told = &state.miss[missAt(agent, leg, legs)];
  told[0] = static_cast<float>(miss);
  told[1] = static_cast<float>(n);
}

void putSpring(HerdState& state, size_t leg, int bones, const reference::KeyPoses::Directions& rates) {
  storePairs(state.spring, at(leg, shared::chainStride(bones)), rates);
}

reference::KeyPoses::Directions springOf(const HerdState& state, size_t leg, int bones) {
  return pairsOf(state.spring, at(leg, shared::chainStride(bones)), bones);
}

reference::BonePose boneOf(const HerdState& state, size_t entry) {
  const size_t base = at(entry, shared::POSE_STRIDE);
  return {quaternion(load(state.pose, base)), load(state.pose, base + 1)};
}

void putBone(HerdState& state, size_t entry, const reference::BonePose& bone) {
  const size_t base = at(entry, shared::POSE_STRIDE);
  store(state.pose, base, components(bone.rotation));
  store(state.pose, base + 1, {bone.position, 0});
}

namespace {

reference::Trail trailOf(const std::vector<float>& watch, size_t base) {
  const glm::dvec4 first = load(watch, base + 1), second = load(watch, base + 2);
  return {load(watch, base), first, second, first.w, second.w};
}

void putTrail(std::vector<float>& watch, size_t base, const reference::Trail& trail, double slip) {
  store(watch, base, {trail.at, slip});
  store(watch, base + 1, {trail.first, trail.path});
  store(watch, base + 2, {trail.second, trail.jerk});
}

}  // namespace

reference::Watched watchedOf(const HerdState& state, size_t slot, int legs) {
  size_t base = at(slot, shared::watchStride(legs));
  reference::Watched watched;
  watched.body = trailOf(state.watch, base);
  for (int leg = 0; leg < legs; ++leg) {
    base += shared::WATCH_TRAIL_STRIDE;
    watched.tips.push_back({trailOf(state.watch, base), load(state.watch, base).w});
  }
  return watched;
}

void putWatched(HerdState& state, size_t slot, const reference::Watched& watched) {
  size_t base = at(slot, shared::watchStride(static_cast<int>(watched.tips.size())));
  putTrail(state.watch, base, watched.body, 0);
  for (const reference::TipTrail& tip : watched.tips)
    putTrail(state.watch, base += shared::WATCH_TRAIL_STRIDE, tip, tip.slip);
}

reference::Metric metricOf(const HerdState& state, size_t agent) {
  const float* m = state.metric.data() + 4 * at(agent, shared::METRIC_STRIDE);
  return {.ticks = m[0],
          .planted = m[1],
          .stays = m[2],
          .skates = m[3],
          .slip = m[4],
          .stances = m[5],
          .largestError = m[6],
          .largestViolation = 2 * std::atan(double{m[7]}),
          .penetration = m[8],
          .penetrationBeyond = m[9],
          .floating = m[10],
          .floatingBeyond = m[11],
          .depth = m[12],
          .deepest = m[13],
          .violations = m[14],
          .pairs = m[16],
          .crossings = m[17],
          .supported = m[18],
          .unstable = m[19],
          .margin = m[20],
          .leastMargin = m[21],
          .footJerk = m[24],
          .footPath = m[25],
          .bodyJerk = m[26],
          .bodyPath = m[27]};
}

void putMetric(HerdState& state, size_t agent, const reference::Metric& m) {
  const size_t base = at(agent, shared::METRIC_STRIDE);
  store(state.metric, base, {m.ticks, m.planted, m.stays, m.skates});
  store(state.metric, base + 1, {m.slip, m.stances, m.largestError, std::tan(m.largestViolation / 2)});
  store(state.metric, base + 2, {m.penetration, m.penetrationBeyond, m.floating, m.floatingBeyond});
  store(state.metric, base + 3, {m.depth, m.deepest, m.violations, 0});
  store(state.metric, base + 4, {m.pairs, m.crossings, m.supported, m.unstable});
  store(state.metric, base + 5, {m.margin, m.leastMargin, 0, 0});
  store(state.metric, base + 6, {m.footJerk, m.footPath, m.bodyJerk, m.bodyPath});
}

}  // namespace skitter::validation
