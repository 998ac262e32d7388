#include "cpu_reference/stages/body.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "cpu_reference/heightfield.h"

namespace skitter::reference {
namespace {

constexpr double leastWanted = 1e-4;  // leg lengths a second; who wants less goes nowhere

LegFollow followOf(const Tuning& tuning, const Limb& limb, const AgentBody& body, const Step& step,
                   const glm::dvec2& desired, double miss, double tick) {
  LegFollow follow;
  follow.planted = step.progress(tick - 1) >= 1;
  if (!follow.planted) return follow;
  const glm::dvec3 root = body.orientation * limb.root;
  const glm::dvec3 foot = step.relative(step.landing, body);
  const double stretch = glm::length(foot - root) / limb.reach;
  follow.behind = glm::dot(normalized(root - foot), normalized(glm::dvec3(desired.x, 0, desired.y)));
  follow.factor =
      std::clamp((tuning.stretchStop - stretch) / (tuning.stretchStop - tuning.stretchSlow), 0.0, 1.0);
  follow.errorFactor = std::clamp(1 - miss / tuning.errorStop, 0.0, 1.0);
  return follow;
}

// Whether a velocity has a direction that counts.
bool goes(const Tuning& tuning, double wantedSpeed, const BodyChoices& choices) {
  return choices.goes >= 0 ? choices.goes == 1 : wantedSpeed > leastWanted * tuning.legLength;
}

void turn(const Tuning& tuning, const glm::dvec2& desired, const BodyChoices& choices, BodyResult& result) {
  AgentBody& body = result.body;
  const glm::dvec2 h = body.heading;
  double e = 0;
  result.turnMargin = std::numeric_limits<double>::infinity();
  result.goMargin = std::abs(glm::length(desired) / (leastWanted * tuning.legLength) - 1);
  if (goes(tuning, glm::length(desired), choices)) {
    const glm::dvec2 w = glm::normalize(desired);
    const double c = w.x * h.y - w.y * h.x, d = glm::dot(w, h);
    if (d > 0) {
      e = c;
    } else {
      result.turnMargin = std::abs(c);
      e = choices.turnSign != 0 ? choices.turnSign : (c >= 0 ? 1.0 : -1.0);
    }
  }
  const double followTurn = glm::mix(0.25, 1.0, body.follow);
  const double wanted = std::clamp(tuning.turnGain * e, -tuning.turnRate, tuning.turnRate) * followTurn;
  const double most = tuning.turnAcceleration * tuning.dt;
  body.turnRate += std::clamp(wanted - body.turnRate, -most, most);
  const glm::dvec3 turned = Turn(body.turnRate * tuning.dt)(glm::dvec3(h.x, 0, h.y));
  body.heading = normalized(glm::dvec2(turned.x, turned.z));
}

constexpr double asideSpeed = 0.3;  // leg lengths a second (docs/stages/avoid.md)

glm::dvec2 waysToEdges(const Tuning& tuning, const AgentBody& body, const glm::dvec2& along) {
  const glm::dvec2 halfExtent{tuning.halfExtentX, tuning.halfExtentZ}, place = body.world();
  glm::dvec2 ways;
  for (int axis = 0; axis < 2; ++axis) {
    const double h = along[axis];
    const double left = h < 0 ? halfExtent[axis] + place[axis] : halfExtent[axis] - place[axis];
    ways[axis] = std::max(0.0, left) / std::max(std::abs(h), 1e-6);
  }
  return ways;
}

// How a body goes that may go on at `most`: who is blocked ahead steps aside, along `w`.
glm::dvec2 besideOthers(const Tuning& tuning, double most, const glm::dvec2& w, const BodyResult& result) {
  const AgentBody& body = result.body;
  const double blocked = std::clamp(1 - most / (asideSpeed * tuning.legLength), 0.0, 1.0);
  const glm::dvec2 ways = waysToEdges(tuning, body, w);
  const double aside = std::min(body.follow * std::min(result.wantedSpeed, asideSpeed * tuning.legLength),
                                stoppingSpeed(tuning, std::min(ways.x, ways.y)));
  return glm::mix(body.speed * body.heading, aside * w, blocked);
}

// Returns the velocity with which the body would walk. Its heading was `before` the turn.
glm::dvec2 walk(const Tuning& tuning, const Wish& wish, const glm::dvec2& before, const BodyChoices& choices,
                BodyResult& result) {
  AgentBody& body = result.body;
  result.wantedSpeed = glm::length(wish.velocity);
  const glm::dvec2 w = goes(tuning, result.wantedSpeed, choices) ? glm::normalize(wish.velocity) : before;
  const double wanted = body.follow * result.wantedSpeed * std::max(0.0, glm::dot(w, body.heading));
  body.speed += std::clamp(wanted - body.speed, -tuning.braking * tuning.dt, tuning.acceleration * tuning.dt);
  result.ways = waysToEdges(tuning, body, body.heading);
  body.speed = std::min(body.speed, stoppingSpeed(tuning, std::min(result.ways.x, result.ways.y)));
  if (!wish.mostSpeed) return body.speed * body.heading;
  body.speed = std::min(body.speed, *wish.mostSpeed);
  return besideOthers(tuning, *wish.mostSpeed, w, result);
}

void advance(AgentBody& body, const glm::dvec2& by) {
  body.localX += by.x;
  body.localZ += by.y;
  const double overX = std::floor(body.localX / tileSize), overZ = std::floor(body.localZ / tileSize);
  body.tileX += overX;
  body.tileZ += overZ;
  body.localX -= overX * tileSize;
  body.localZ -= overZ * tileSize;
}

// Where the ground points are, relative to the previous body.
std::vector<glm::dvec3> groundPoints(const Creature& creature, const AgentBody& previous,
                                     std::span<const Step> steps, double tick) {
  std::vector<glm::dvec3> points;
  for (size_t l = 0; l < steps.size(); ++l) {
    if (!creature.limbs[l].carries) continue;
    const Step& step = steps[l];
    const double u = step.progress(tick - 1);
    const glm::dvec3 point = u >= 1 ? step.landing : glm::mix(step.liftOff, step.landing, u);
    points.push_back(step.relative(point, previous));
  }
  return points;
}

std::vector<glm::dvec3> groundBelowHomes(const Heights& heights, const Creature& creature,
                                         const AgentBody& previous) {
  std::vector<glm::dvec3> points;
  const glm::dvec2 position = previous.world();
  for (const Limb& limb : creature.limbs) {
    if (!limb.carries) continue;
    const glm::dvec3 home = previous.orientation * limb.home;
    const double ground = heightAt(heights, position.x + home.x, position.y + home.z);
    points.emplace_back(home.x, ground - previous.y, home.z);
  }
  return points;
}

// Least squares of y over (x, z) through the ground points, its normal matrix regularised by ridge k.
// Heights are relative to the body's y.
SupportPlane supportPlane(const Tuning& tuning, const std::vector<glm::dvec3>& points) {
  glm::dvec3 mean{0};
  for (const glm::dvec3& point : points) mean += point;
  const double k = std::max(1.0, static_cast<double>(points.size()));  // without points it is level
  mean /= k;
  double sxx = tuning.ridge * k, szz = tuning.ridge * k, sxz = 0, sxy = 0, szy = 0;
  SupportPlane plane;
  for (const glm::dvec3& point : points) {
    const glm::dvec3 r = point - mean;
    sxx += r.x * r.x;
    szz += r.z * r.z;
    sxz += r.x * r.z;
    sxy += r.x * r.y;
    szy += r.z * r.y;
    plane.spread += r.x * r.x + r.z * r.z;
    plane.heightSpread += r.y * r.y;
  }
  plane.mean = mean;
  plane.spread = std::sqrt(plane.spread);
  plane.heightSpread = std::sqrt(plane.heightSpread);
  const double half = (sxx + szz) / 2, root = std::hypot((sxx - szz) / 2, sxz);
  plane.leastEigenvalue = half - root;
  plane.largestEigenvalue = half + root;
  const double determinant = sxx * szz - sxz * sxz;
  plane.b = (sxy * szz - szy * sxz) / determinant;
  plane.c = (szy * sxx - sxy * sxz) / determinant;
  plane.unclampedSlope = std::hypot(plane.b, plane.c);
  if (plane.unclampedSlope > tuning.maxSlope) {
    plane.b *= tuning.maxSlope / plane.unclampedSlope;
    plane.c *= tuning.maxSlope / plane.unclampedSlope;
  }
  plane.height = mean.y - plane.b * mean.x - plane.c * mean.z;
  return plane;
}

constexpr double steepnessMost = 1.25;  // of maxSlope; on steeper ground a body goes along the slope only

// `wished` without its part up or down the slope, where this is too steep.
glm::dvec2 walkable(const Tuning& tuning, const SupportPlane& plane, const glm::dvec2& wished) {
  const double steepness = std::max(1.0, plane.unclampedSlope / tuning.maxSlope);
  const double kept = std::clamp((steepnessMost - steepness) / (steepnessMost - 1), 0.0, 1.0);
  const glm::dvec2 uphill = normalized(glm::dvec2(plane.b, plane.c));
  return wished - (1 - kept) * glm::dot(uphill, wished) * uphill;
}

// The ground below a body that has moved `by` so far.
GroundBelow groundBelow(const Tuning& tuning, const Heights& heights, const AgentBody& body,
                        const glm::dvec2& by, const glm::dvec3& up, const glm::dvec3& forward) {
  const glm::dvec2 origin = body.world() + by;
  GroundBelow ground;
  ground.atOrigin = heightAt(heights, origin.x, origin.y);
  ground.highest = ground.atOrigin;
  for (const double end : {-1.0, 1.0}) {
    const glm::dvec3 q = tuning.bodyHeight * up + end * tuning.bodyRadius * forward;
    const double height = heightAt(heights, origin.x + q.x, origin.y + q.z);
    ground.highest = std::max(ground.highest, height);
    (end > 0 ? ground.ahead : ground.behind) = height + tuning.bellyClearance - q.y;
  }
  return ground;
}

double passable(const Tuning& tuning, double rises) {
  const double wall = (tuning.climbMost - rises) / (tuning.climbMost / 2);
  const double cliff = (tuning.gapMost + rises) / (tuning.gapMost / 2);
  return std::clamp(std::min(wall, cliff), 0.0, 1.0);
}

// Square to the plane but for a share of its slope, and leaning to where a turn's middle is.
glm::dvec3 leaningNormal(const Tuning& tuning, const SupportPlane& plane, const AgentBody& body) {
  const double lean =
      std::clamp(tuning.leanGain * body.speed * body.turnRate, -tuning.leanMost, tuning.leanMost);
  const glm::dvec3 left{body.heading.y, 0, -body.heading.x};
  const double kept = 1 - tuning.leanLevel;
  return normalized(glm::dvec3(-plane.b * kept, 1, -plane.c * kept) + lean * left);
}

// From the support plane on. `points` are relative to the previous body.
void move(const Tuning& tuning, const Heights& heights, const AgentBody& previous, const Wish& wished,
          const std::vector<glm::dvec3>& points, double phase, double drop, const glm::dvec2& pushed,
          const BodyChoices& choices, BodyResult& result) {
  AgentBody& next = result.body;
  result.plane = supportPlane(tuning, points);
  const SupportPlane& plane = result.plane;
  const Wish wish{walkable(tuning, plane, wished.velocity), wished.mostSpeed};
  result.wishedSpeed = glm::length(wished.velocity);
  turn(tuning, wish.velocity, choices, result);
  glm::dvec2 walks = walk(tuning, wish, previous.heading, choices, result);

  const glm::dvec3 upBefore = previous.orientation * glm::dvec3(0, 1, 0);
  const glm::dvec3 up = normalized(glm::mix(upBefore, leaningNormal(tuning, plane, next), tuning.tiltBlend));
  const glm::dvec2 h = next.heading;
  const glm::dvec3 forward = normalized(glm::dvec3(h.x, -(up.x * h.x + up.z * h.y) / up.y, h.y));
  next.orientation = glm::quat_cast(glm::dmat3(glm::cross(up, forward), up, forward));
  if (glm::dot(next.orientation, previous.orientation) < 0) next.orientation = -next.orientation;

  const auto climbs = [&] {
    return (plane.b * (walks + pushed).x + plane.c * (walks + pushed).y) * tuning.dt;
  };
  const auto planeHeight = [&] { return previous.y + plane.height + climbs(); };
  result.ground = groundBelow(tuning, heights, previous, (walks + pushed) * tuning.dt, up, forward);
  result.rises = result.ground.ahead - planeHeight();
  const glm::dvec3 front = tuning.bodyHeight * up + tuning.bodyRadius * forward;
  result.lookedAhead = previous.world() + (walks + pushed) * tuning.dt + glm::dvec2(front.x, front.z);
  result.passes = passable(tuning, result.rises);
  result.unhinderedSpeed = next.speed;
  if (result.passes < 1) {
    const double share = std::clamp(
        result.passes * result.wantedSpeed / std::max(next.speed, 1e-6 * tuning.legLength), 0.0, 1.0);
    next.speed *= share;
    walks *= share;
    result.ground = groundBelow(tuning, heights, previous, (walks + pushed) * tuning.dt, up, forward);
  }
  next.follow *= result.passes;

  const GroundBelow& ground = result.ground;
  const double predicted = previous.y + climbs();
  const double breath =
      std::pow(4 * phase * (1 - phase), 2) * std::min(1.0, previous.still / tuning.settleTime);
  const double lowest =
      ground.atOrigin + std::max(-tuning.sinkMost - drop, tuning.bellyClearance - tuning.bodyHeight);
  const double wanted =
      std::max({planeHeight() - drop + tuning.breathHeight * breath, lowest,
                std::min(std::max(ground.ahead, ground.behind), planeHeight() + tuning.climbMost)});
  const double blended = glm::mix(predicted, wanted, tuning.heightBlend),
               least = lowest - tuning.sinkMost / 2, most = ground.highest + tuning.riseMost;
  next.y = std::min(std::max(blended, least), most);
  result.heightMargin = std::min(blended - least, most - blended);
  result.rise = std::abs(wanted - predicted);
  advance(next, (walks + pushed) * tuning.dt);

  next.surfaceSpeed = next.speed / std::hypot(forward.x, forward.z);
  const double pace = 1e-2 * tuning.legLength;
  const double busiest =
      std::max({result.wantedSpeed / pace, next.speed / pace, std::abs(next.turnRate) / 1e-2});
  result.isStill = busiest < 1;
  result.stillMargin = std::abs(busiest - 1);
  next.still = result.isStill ? previous.still + tuning.dt : 0;
}

}  // namespace

double stoppingSpeed(const Tuning& tuning, double way) {
  // s^2 / (2 braking) + s dt = way.
  const double braked = tuning.braking * tuning.dt;
  return std::sqrt(braked * braked + 2 * tuning.braking * way) - braked;
}

BodyResult body(const Tuning& tuning, const Heights& heights, const Creature& creature,
                const AgentBody& previous, const Wish& wish, std::span<const Step> steps,
                std::span<const double> misses, double tick, double phase, const BodyChoices& choices) {
  const Reaction reaction = creature.reaction.value_or(Reaction{});
  const glm::dvec2 desired = (reaction.phase == ReactionPhase::rising ? 0 : creature.speed) * wish.velocity;
  BodyResult result;
  result.body = previous;
  double follow = 1;
  for (size_t l = 0; l < creature.limbs.size(); ++l) {
    LegFollow leg;
    if (creature.limbs[l].carries)
      leg = followOf(tuning, creature.limbs[l], previous, steps[l], desired, misses[l], tick);
    if (leg.planted && leg.behind > 0) follow = std::min(follow, leg.factor);
    follow = std::min(follow, leg.errorFactor);
    result.follow.push_back(leg);
  }
  result.body.follow = std::max(choices.follow.value_or(follow), tuning.followLeast);
  move(tuning, heights, previous, {desired, wish.mostSpeed}, groundPoints(creature, previous, steps, tick),
       phase, creature.shift.y + reaction.drop, reaction.velocity, choices, result);
  if (reaction.phase != ReactionPhase::steady) {
    result.body.still = 0;
    result.stillMargin = std::numeric_limits<double>::infinity();
  }
  return result;
}

BodyResult blindBody(const Tuning& tuning, const Heights& heights, const Creature& creature,
                     const AgentBody& previous, const Wish& wish, const BodyChoices& choices) {
  BodyResult result;
  result.body = previous;
  result.body.follow = 1;
  Tuning upright = tuning;
  upright.leanGain = upright.leanLevel = upright.breathHeight = 0;
  move(upright, heights, previous, {creature.speed * wish.velocity, wish.mostSpeed},
       groundBelowHomes(heights, creature, previous), 0, creature.shift.y, {0, 0}, choices, result);
  return result;
}

}  // namespace skitter::reference
