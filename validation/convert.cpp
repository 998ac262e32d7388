#include "validation/convert.h"

#include <algorithm>
#include <cmath>

#include "cpu_reference/stages/hurt.h"
#include "shared/adapt.h"
#include "skitter/records.h"
#include "validation/vec4s.h"

namespace skitter::validation {
namespace {

// A mask of legs; nonsense, which cannot be converted, reads as none.
uint32_t mask(double value) { return value >= 0 && value < 0x1p32 ? static_cast<uint32_t>(value) : 0; }

// The directions of pairs of bones, from that vec4 on.
std::vector<glm::dvec2> pairsOf(const std::vector<float>& records, size_t base, int bones) {
  std::vector<glm::dvec2> pairs;
  for (int b = 0; b < bones; ++b) {
    const glm::dvec4 pair = load(records, base + static_cast<size_t>(b) / 2);
    pairs.push_back(b % 2 == 0 ? glm::dvec2(pair.x, pair.y) : glm::dvec2(pair.z, pair.w));
  }
  return pairs;
}

// The fields of a record (cpu_reference/fields.h), by their types.
void read(double& to, const float* from) { to = from[0]; }
void read(uint32_t& to, const float* from) { to = mask(from[0]); }
template <int N>
void read(glm::vec<N, double>& to, const float* from) {
  for (int i = 0; i < N; ++i) to[i] = from[i];
}
void read(glm::dquat& to, const float* from) { to = glm::dquat(from[3], from[0], from[1], from[2]); }

void write(float* to, double from) { to[0] = static_cast<float>(from); }
template <int N>
void write(float* to, const glm::vec<N, double>& from) {
  for (int i = 0; i < N; ++i) to[i] = static_cast<float>(from[i]);
}
void write(float* to, const glm::dquat& q) { write(to, glm::dvec4(q.x, q.y, q.z, q.w)); }

#define READ(type, name, initial, place, roundings) read(to.name, record + (place));
#define WRITE(type, name, initial, place, roundings) write(record + (place), from.name);

const float* recordAt(const std::vector<float>& records, size_t index, int stride) {
  return records.data() + 4 * at(index, stride);
}
// Set to zeros, as unused fields are.
float* clearedAt(std::vector<float>& records, size_t index, int stride) {
  float* record = records.data() + 4 * at(index, stride);
  std::fill_n(record, 4 * stride, 0.0f);
  return record;
}

void set(double& to, float from) { to = from; }
void set(bool& to, float from) { to = from != 0; }

// A parameter that the reference lacks does not compile in tuningOf, and one that the engine lacks does not
// compile here. A bool between doubles takes the room of a double. Beside them Tuning has `ticks`.
#define COUNT(name) +1
static_assert(sizeof(reference::Tuning) == (1 REFERENCE_PARAMETERS(COUNT)) * sizeof(double));
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
    limb.group = home.w;
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

reference::Hurt hurtOf(const HerdState& state, size_t agent, int legs) {
  const size_t first = at(agent, shared::hurtStride(legs));
  const glm::dvec4 masks = load(state.hurt, first), bones = load(state.hurt, first + 1);
  const glm::dvec4 body = load(state.hurt, first + 2);
  reference::Hurt hurt;
  hurt.lost = mask(masks.x);
  hurt.stuck = mask(masks.y);
  hurt.lame = mask(masks.z);
  hurt.groups = static_cast<int>(masks.w);
  hurt.shift = body;
  hurt.speed = body.w;
  for (int l = 0; l < legs; ++l) {
    const glm::dvec4 turn = load(state.hurt, first + shared::HURT_LEGS + static_cast<size_t>(l));
    const auto packed = static_cast<float>(bones[l / shared::HURT_BONES_LEGS]);
    hurt.legs.push_back({.group = turn.x,
                         .lag = turn.y,
                         .neighbours = mask(turn.z),
                         .slowness = turn.w,
                         .lostFrom = static_cast<size_t>(shared::packedBone(packed, l))});
  }
  return hurt;
}

void putHurtGait(HerdState& state, size_t agent, const reference::Hurt& hurt) {
  const size_t first = at(agent, shared::hurtStride(static_cast<int>(hurt.legs.size())));
  state.hurt[4 * first + 3] = static_cast<float>(hurt.groups);
  store(state.hurt, first + 2, {hurt.shift, hurt.speed});
  for (size_t l = 0; l < hurt.legs.size(); ++l) {
    const reference::Hurt::Turn& turn = hurt.legs[l];
    store(state.hurt, first + shared::HURT_LEGS + l, {turn.group, turn.lag, turn.neighbours, turn.slowness});
  }
}

reference::GaitMap gaitMapOf(const crowd::GaitMap& map, int legs) {
  reference::GaitMap result;
  for (size_t c = 0; c < map.candidates; ++c) {
    const size_t first = at(c, shared::gaitMapStride(legs));
    const glm::dvec4 head = load(map.records, first), shift = load(map.records, first + 1);
    reference::GaitCandidate& candidate = result.candidates.emplace_back();
    candidate.groups = static_cast<int>(head.x);
    candidate.speed = head.y;
    candidate.expected = head.z;
    candidate.shift = shift;
    for (int l = 0; l < legs; ++l) {
      const glm::dvec4 turn = load(map.records, first + shared::GAIT_MAP_LEGS + static_cast<size_t>(l));
      const size_t shares = first + static_cast<size_t>(shared::GAIT_MAP_LEGS + legs + l / 4);
      candidate.legs.push_back(
          {.group = turn.x, .lag = turn.y, .neighbours = mask(turn.z), .slowness = turn.w});
      candidate.shares.push_back(load(map.records, shares)[l % 4]);
    }
  }
  return result;
}

reference::Search searchOf(const HerdState& state, size_t agent) {
  const float* record = recordAt(state.search, agent, shared::SEARCH_STRIDE);
  reference::Search to;
  SKITTER_SEARCH_FIELDS(READ)
  to.does = record[2] == shared::SEARCH_SEARCHES  ? reference::Searching::searches
            : record[2] == shared::SEARCH_SETTLED ? reference::Searching::settled
                                                  : reference::Searching::atEase;
  const uint32_t trials = std::min(mask(record[3]), uint32_t{shared::SEARCH_MOST_TRIALS});
  for (size_t i = 0; i < trials; ++i) {
    const float* trial = record + 4 * shared::SEARCH_TRIALS + 2 * i;
    to.trials.push_back({mask(trial[0]), trial[1]});
  }
  return to;
}

void putSearch(HerdState& state, size_t agent, const reference::Search& from) {
  float* record = clearedAt(state.search, agent, shared::SEARCH_STRIDE);
  SKITTER_SEARCH_FIELDS(WRITE)
  record[2] = static_cast<float>(from.does);
  record[3] = static_cast<float>(from.trials.size());
  for (size_t i = 0; i < from.trials.size(); ++i) {
    float* trial = record + 4 * shared::SEARCH_TRIALS + 2 * i;
    trial[0] = static_cast<float>(from.trials[i].candidate);
    trial[1] = static_cast<float>(from.trials[i].fitness);
  }
}

double carriedMassOf(const HerdState& state, size_t agent) {
  return validation::load(state.carried, at(agent, shared::CARRIED_STRIDE)).w;
}

glm::dvec3 centreOf(const HerdState& state, size_t agent, double legLength) {
  const glm::dvec4 load = validation::load(state.carried, at(agent, shared::CARRIED_STRIDE));
  return reference::centreWith(load.w, legLength * glm::dvec3(load));
}

reference::Reaction reactionOf(const HerdState& state, size_t agent) {
  const float* record = recordAt(state.reaction, agent, shared::REACTION_STRIDE);
  reference::Reaction to;
  SKITTER_REACTION_FIELDS(READ)
  using enum reference::ReactionPhase;
  to.phase = record[0] == shared::REACTION_STUMBLING  ? stumbling
             : record[0] == shared::REACTION_FALLING  ? falling
             : record[0] == shared::REACTION_LYING    ? lying
             : record[0] == shared::REACTION_RIGHTING ? righting
             : record[0] == shared::REACTION_RISING   ? rising
                                                      : steady;
  return to;
}

void putReaction(HerdState& state, size_t agent, const reference::Reaction& from) {
  float* record = clearedAt(state.reaction, agent, shared::REACTION_STRIDE);
  SKITTER_REACTION_FIELDS(WRITE)
  record[0] = static_cast<float>(from.phase);
}

std::optional<glm::dvec2> pushOf(const HerdState& state, size_t agent, uint64_t n) {
  if (state.push.empty()) return {};
  const float* record = recordAt(state.push, agent, shared::PUSH_STRIDE);
  if (record[3] != static_cast<float>(n)) return {};
  return glm::dvec2(record[0], record[1]);
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
  const float* record = recordAt(state.goal, agent, shared::GOAL_STRIDE);
  reference::Goal to;
  SKITTER_GOAL_FIELDS(READ)
  to.kind = record[6] == shared::GOAL_CROSS      ? reference::GoalKind::cross
            : record[6] == shared::GOAL_POINT    ? reference::GoalKind::point
            : record[6] == shared::GOAL_VELOCITY ? reference::GoalKind::velocity
            : record[6] == shared::GOAL_SERIES   ? reference::GoalKind::series
                                                 : reference::GoalKind::none;
  return to;
}

void putGoal(HerdState& state, size_t agent, const reference::Goal& from) {
  float* record = clearedAt(state.goal, agent, shared::GOAL_STRIDE);
  SKITTER_GOAL_FIELDS(WRITE)
  record[6] = from.kind == reference::GoalKind::cross      ? shared::GOAL_CROSS
              : from.kind == reference::GoalKind::point    ? shared::GOAL_POINT
              : from.kind == reference::GoalKind::velocity ? shared::GOAL_VELOCITY
              : from.kind == reference::GoalKind::series   ? shared::GOAL_SERIES
                                                           : shared::GOAL_NONE;
}

glm::dvec2 desiredOf(const HerdState& state, size_t agent) {
  return load(state.steer, at(agent, shared::STEER_STRIDE));
}

bool mayRest(const HerdState& state, size_t agent) {
  return load(state.steer, at(agent, shared::STEER_STRIDE)).z == 1;
}

glm::dvec2 velocityOf(const HerdState& state, size_t agent) {
  if (state.avoid.empty()) return desiredOf(state, agent);
  return load(state.avoid, at(agent, shared::AVOID_STRIDE));
}

bool asleepOf(const HerdState& state, size_t agent) {
  if (state.avoid.empty()) return mayRest(state, agent);
  return load(state.avoid, at(agent, shared::AVOID_STRIDE)).z > 0;
}

double seenOf(const HerdState& state, size_t agent) {
  const double told = load(state.avoid, at(agent, shared::AVOID_STRIDE)).z;
  return told > 0 ? told - 1 : -told;
}

std::optional<double> mostSpeedOf(const HerdState& state, size_t agent) {
  if (state.avoid.empty()) return {};
  return load(state.avoid, at(agent, shared::AVOID_STRIDE)).w;
}

void putSteer(HerdState& state, size_t agent, const glm::dvec2& desired, bool asleep) {
  store(state.steer, at(agent, shared::STEER_STRIDE), {desired, asleep ? 1 : 0, 0});
}

reference::AgentBody bodyOf(const HerdState& state, size_t agent) {
  const float* record = recordAt(state.body, agent, shared::BODY_STRIDE);
  reference::AgentBody to;
  SKITTER_BODY_FIELDS(READ)
  to.tileX = shared::tileX(record[3]);
  to.tileZ = shared::tileZ(record[3]);
  to.absent = record[7] == 1;
  return to;
}

void putBody(HerdState& state, size_t agent, const reference::AgentBody& from) {
  float* record = clearedAt(state.body, agent, shared::BODY_STRIDE);
  SKITTER_BODY_FIELDS(WRITE)
  write(record + 3, shared::TILES * from.tileX + from.tileZ);
  record[7] = from.absent ? 1 : 0;
}

reference::Gait gaitOf(const HerdState& state, size_t agent) {
  const float* record = recordAt(state.gait, agent, shared::GAIT_STRIDE);
  reference::Gait to;
  SKITTER_GAIT_FIELDS(READ)
  to.idle = mask(record[7]);
  return to;
}

void putGait(HerdState& state, size_t agent, const reference::Gait& from) {
  float* record = clearedAt(state.gait, agent, shared::GAIT_STRIDE);
  SKITTER_GAIT_FIELDS(WRITE)
  write(record + 7, from.idle);
}

reference::Step stepOf(const HerdState& state, size_t leg) {
  const float* record = recordAt(state.step, leg, shared::STEP_STRIDE);
  reference::Step to;
  SKITTER_STEP_FIELDS(READ)
  const float packed = record[7], body = bodyTileOf(state, leg);
  const float x = shared::tileX(body), z = shared::tileZ(body);
  const float apart = shared::tilesApart(shared::tileOfTicks(packed), shared::stepTile(x, z));
  to.tileX = x + shared::apartX(apart);
  to.tileZ = z + shared::apartZ(apart);
  to.duration = std::copysign(shared::ticksOf(packed), packed);
  if (state.arc.empty()) return to;
  record = recordAt(state.arc, leg, shared::ARC_STRIDE);
  SKITTER_ARC_FIELDS(READ)
  return to;
}

void putStep(HerdState& state, size_t leg, const reference::Step& from) {
  float* record = clearedAt(state.step, leg, shared::STEP_STRIDE);
  SKITTER_STEP_FIELDS(WRITE)
  const float tile = shared::stepTile(static_cast<float>(from.tileX), static_cast<float>(from.tileZ));
  record[7] = shared::packedTicks(static_cast<float>(from.duration), tile);
  record = clearedAt(state.arc, leg, shared::ARC_STRIDE);
  SKITTER_ARC_FIELDS(WRITE)
}

reference::Foot footOf(const HerdState& state, size_t leg) {
  const float* record = recordAt(state.foot, leg, shared::FOOT_STRIDE);
  reference::Foot to;
  SKITTER_FOOT_FIELDS(READ)
  return to;
}

void putFoot(HerdState& state, size_t leg, const reference::Foot& from) {
  float* record = clearedAt(state.foot, leg, shared::FOOT_STRIDE);
  SKITTER_FOOT_FIELDS(WRITE)
}

reference::Chain chainOf(const HerdState& state, size_t leg, int bones) {
  reference::Chain to;
  to.directions = pairsOf(state.chain, at(leg, shared::chainStride(bones)), bones);
  if (state.tip.empty()) return to;
  const float* record = recordAt(state.tip, leg, shared::TIP_STRIDE);
  SKITTER_TIP_FIELDS(READ)
  return to;
}

void putChain(HerdState& state, size_t leg, int bones, const reference::Chain& from) {
  storePairs(state.chain, at(leg, shared::chainStride(bones)), from.directions);
  if (state.tip.empty()) return;
  float* record = clearedAt(state.tip, leg, shared::TIP_STRIDE);
  SKITTER_TIP_FIELDS(WRITE)
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
  const float* record = recordAt(state.pose, entry, shared::POSE_STRIDE);
  reference::BonePose to;
  SKITTER_POSE_FIELDS(READ)
  to.lost = record[7] != 0;
  return to;
}

void putBone(HerdState& state, size_t entry, const reference::BonePose& from) {
  float* record = clearedAt(state.pose, entry, shared::POSE_STRIDE);
  SKITTER_POSE_FIELDS(WRITE)
  record[7] = from.lost ? 1 : 0;
}

namespace {

// The number of an agent's first trail.
size_t trailAt(size_t slot, size_t legs) { return slot * (1 + legs); }

reference::Trail trailOf(const HerdState& state, size_t trail) {
  const float* record = recordAt(state.watch, trail, shared::WATCH_TRAIL_STRIDE);
  reference::Trail to;
  SKITTER_TRAIL_FIELDS(READ)
  return to;
}

void putTrail(HerdState& state, size_t trail, const reference::Trail& from, double slip) {
  float* record = clearedAt(state.watch, trail, shared::WATCH_TRAIL_STRIDE);
  SKITTER_TRAIL_FIELDS(WRITE)
  write(record + 3, slip);
}

}  // namespace

reference::Watched watchedOf(const HerdState& state, size_t slot, int legs) {
  size_t trail = trailAt(slot, static_cast<size_t>(legs));
  reference::Watched watched;
  watched.body = trailOf(state, trail);
  for (int leg = 0; leg < legs; ++leg) {
    ++trail;
    watched.tips.push_back(
        {trailOf(state, trail), recordAt(state.watch, trail, shared::WATCH_TRAIL_STRIDE)[3]});
  }
  return watched;
}

void putWatched(HerdState& state, size_t slot, const reference::Watched& watched) {
  size_t trail = trailAt(slot, watched.tips.size());
  putTrail(state, trail, watched.body, 0);
  for (const reference::TipTrail& tip : watched.tips) putTrail(state, ++trail, tip, tip.slip);
}

reference::Metric metricOf(const HerdState& state, size_t agent) {
  const float* record = recordAt(state.metric, agent, shared::METRIC_STRIDE);
  reference::Metric to;
  SKITTER_METRIC_FIELDS(READ)
  to.largestViolation = 2 * std::atan(double{record[7]});
  return to;
}

void putMetric(HerdState& state, size_t agent, const reference::Metric& from) {
  float* record = clearedAt(state.metric, agent, shared::METRIC_STRIDE);
  SKITTER_METRIC_FIELDS(WRITE)
  write(record + 7, std::tan(from.largestViolation / 2));
}

}  // namespace skitter::validation
