#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "cpu_reference/arithmetic.h"
#include "cpu_reference/heightfield.h"
#include "cpu_reference/roundoff.h"
#include "cpu_reference/stages/adapt.h"
#include "cpu_reference/stages/body.h"
#include "cpu_reference/stages/foothold.h"
#include "cpu_reference/stages/gait.h"
#include "cpu_reference/stages/react.h"
#include "cpu_reference/types.h"
#include "cpu_reference/ways/way.h"

// How far a float32 implementation of docs/stages.md may be from the reference, stage by stage, when both
// start from the same float32 records. First-order bounds: each operation errs by `roundoff` of its result;
// Vulkan allows 2.5 ulp for division, 2 for inversesqrt and 3 for sqrt, so a normalisation is counted as 6.
namespace skitter::reference::tolerance {

// Rounding of a tile-local coordinate, below 16 m.
inline constexpr double local = tileSize * roundoff;
// Difference of two tile-local points: the tile difference times 16 is exact, its sum with one coordinate is
// below 32 m (2 local), the difference with the other rounds once more (2 local at most).
inline constexpr double relative = 4 * local;
// The same of points so far apart along x or z. The tiles between them are up to `apart` and one tile; with a
// coordinate that is within a tile of a point (apart + 2 tiles) one rounding, the difference itself is the
// other.
inline double relativeOver(double apart) { return std::max(relative, (2 * apart + 2 * tileSize) * roundoff); }
// A cubic Hermite spline in tile-local coordinates: four products and three sums of terms below 16 m, the
// basis functions err by 4 roundoff each; half of these roundings cancel at worst.
inline constexpr double spline = 12 * local;
// The same of terms up to `largest`.
inline double splineOver(double largest) { return std::max(spline, 12 * roundoff * largest); }

// heightAt at a point known to within `horizontal`, on a terrain that reaches `extent` from the origin:
// forming the world coordinate errs by 1 roundoff of it, subtracting the origin and scaling by 2 each of
// twice it (6 in all); the three lerps add 8 roundoff of the height.
inline double height(const Relief& relief, double extent, double horizontal) {
  return (horizontal + 6 * roundoff * extent) * (relief.slopeX + relief.slopeZ) +
         8 * roundoff * relief.height;
}

// Difference of a target and a body in world coordinates: as in `height`, without the scaling.
inline double goalDistance(double extent) { return 4 * roundoff * extent; }
// Desired velocity as a share of the goal's speed: the angle under which the error of the difference is seen,
// and one normalisation.
inline double desiredVelocity(double extent, double distance, double slowRadius) {
  return goalDistance(extent) * (1 / std::max(distance, 1e-9) + 1 / slowRadius) + 8 * roundoff;
}
// A time of a field, as a share of it: whole units of 2^-18 of a crossing, of which an equation loses four at
// most while time goes on by 0.7 crossings, and float32 rounds at each of a thousand cells on the way.
inline constexpr double wayField = 1e-4;
// The place of an agent among cells, in cells: the world coordinate errs by 1 rounding, less the origin by 2,
// a division of twice the extent by 10 and the half by 2.
inline double wayPlace(double extent, double cell) { return 16 * roundoff * extent / cell; }
// A time between those of cells, which are the same bits: three lerps, and the place.
inline double wayTime(double extent, double cell, double rise, double time) {
  return wayPlace(extent, cell) * rise + 8 * roundoff * time;
}
// Desired velocity along a field, as a share of the speed. The gradient turns with the place on both axes;
// its differences and lerps err by 8 roundings of the largest one; it is normalised; and the time is a share
// of the slow radius.
inline double wayVelocity(double extent, double cell, const WayResult& way, double slowRadius) {
  return 2 * wayPlace(extent, cell) * way.turning + 8 * roundoff * way.magnified +
         wayTime(extent, cell, way.rise, slowRadius) / slowRadius + 12 * roundoff;
}
// Its length, whatever its direction: the distance over the slow radius, a normalisation and a length.
// Against `standing`, a product of two.
inline double stands(double extent, double speed, double slowRadius, double standing) {
  return speed * (goalDistance(extent) / slowRadius + 12 * roundoff) + 2 * roundoff * standing;
}
// So many dt / C, a quotient of records, or phi C in its place.
inline double breathedOut(const Tuning& t, int ticks, const Gait& gait) {
  return 6 * roundoff * ticks * t.dt / gait.cycle;
}

// A rotation by a unit quaternion: 12 operations on lengths up to |v|, and the quaternion's own norm.
inline double rotated(double length) { return 16 * roundoff * length; }
// A foot's target, in its step or planted. A spline errs in the coordinates that it is evaluated in; heights
// are world ones.
// How far its step's points are from a body along x or z, and how far its knot and tangents are from those:
// the knot lies half way between them, plus the lift.
inline double stepAside(const Step& step, const AgentBody& body) {
  const glm::dvec3 from = step.relative(step.liftOff, body), to = step.relative(step.landing, body);
  return std::max({std::abs(from.x), std::abs(from.z), std::abs(to.x), std::abs(to.z)});
}
inline double stepArc(const Step& step, bool sideways) {
  const glm::dvec3 lift = glm::abs(step.lift), tangent = glm::abs(step.startTangent);
  return sideways ? std::max({lift.x, lift.z, tangent.x, tangent.z}) : std::max(lift.y, tangent.y);
}
inline double footAside(const Step& step, const AgentBody& body, bool planted) {
  const double points = stepAside(step, body);
  return relativeOver(points) + (planted ? 0 : splineOver(points + stepArc(step, true)));
}
// The largest of the heights that a point of a step is made of.
inline double stepHeight(const Step& step, const AgentBody& body) {
  return std::max({std::abs(step.landing.y), std::abs(step.liftOff.y), std::abs(body.y), 1.0});
}
inline double footHeight(const Step& step, const AgentBody& body, bool planted) {
  const double points = stepHeight(step, body);
  return planted ? 4 * roundoff * points : 16 * roundoff * (points + stepArc(step, false));
}
inline double foot(const Step& step, const AgentBody& body, bool planted) {
  return std::hypot(footAside(step, body, planted), footHeight(step, body, planted));
}
// Distance of a foot from its root or home.
inline double footDistance(double length) { return relativeOver(length) + rotated(length); }

// Inputs of the body err by so much: follow, the points that its plane goes through (level and upright), and
// the blends of height and tilt.
struct BodyInputs {
  double follow = 0, horizontal = 0, vertical = 0, blend = 0;
};
// The legs' ground points, which are records, and follow of them: a stretch divided by the narrow band
// between slowing and stopping.
inline BodyInputs feltGround(const Tuning& t, const Creature& creature, const AgentBody& previous) {
  double shortest = t.legLength;
  for (const Limb& limb : creature.limbs) shortest = std::min(shortest, limb.reach);
  return {footDistance(2 * t.legLength) / shortest / (t.stretchStop - t.stretchSlow) + 4 * roundoff, relative,
          4 * roundoff * std::abs(previous.y)};
}
// The ground below the homes: a home is rotated once, then the ground looked up there.
inline BodyInputs blindGround(const Heights& heights, double extent, const Creature& creature,
                              const AgentBody& previous) {
  BodyInputs inputs;
  const glm::dvec2 position = previous.world();
  for (const Limb& limb : creature.limbs) {
    const glm::dvec3 home = previous.orientation * limb.home;
    const double horizontal = rotated(glm::length(limb.home));
    const Relief relief = reliefNear(heights, position.x + home.x, position.y + home.z);
    inputs.horizontal = std::max(inputs.horizontal, horizontal);
    inputs.vertical = std::max(inputs.vertical, height(relief, extent, horizontal));
  }
  inputs.vertical += 4 * roundoff * std::abs(previous.y);
  return inputs;
}

struct BodyBounds {
  double follow, slope, wished, turnRate, heading, speed, position, orientation, passes, height, surfaceSpeed;
};
// Follows the steps of the stage in order; each bound feeds the next.
inline BodyBounds body(const Tuning& t, const Heights& heights, double extent, const Creature& creature,
                       const BodyInputs& inputs, const BodyResult& result) {
  BodyBounds bound{};
  const AgentBody& next = result.body;
  const SupportPlane& plane = result.plane;
  bound.follow = inputs.follow;

  // (b, c) = M^-1 (Sxy, Szy): errors of the points through M^-1 (at most 1 / least eigenvalue), roundings of
  // the sums, and of the determinant in Cramer's rule (the condition number of M).
  const double legs = static_cast<double>(creature.limbs.size());
  const double slope = plane.unclampedSlope;
  const double point = inputs.horizontal;
  const double vertical = inputs.vertical + 4 * roundoff * plane.heightSpread;
  const double condition = plane.largestEigenvalue / plane.leastEigenvalue;
  bound.slope =
      (2 * std::sqrt(legs) * (plane.spread * (vertical + slope * point) + plane.heightSpread * point) +
       (8 + legs) * roundoff * plane.spread * plane.heightSpread) /
          plane.leastEigenvalue +
      8 * roundoff * condition * (1 + slope);
  // On few legs the points may lie closer together than to the body, where their sums are taken about: a sum
  // of k products rounds k times at most, and the product of means that is taken off it 4 times.
  const bool all = std::ranges::all_of(creature.limbs, [](const Limb& limb) { return limb.carries; });
  const double mean = std::hypot(plane.mean.x, plane.mean.z);
  if (!all)
    bound.slope += (8 + legs) * roundoff * legs * mean * (mean * slope + std::abs(plane.mean.y) + mean) /
                   plane.leastEigenvalue;
  // On ground that is steeper than a body tilts, a share of the velocity is lost that falls by 1 while the
  // slope grows by a quarter of that; it is lost along the slope, whose direction errs by its error over it.
  if (slope + bound.slope > t.maxSlope)
    bound.wished =
        result.wishedSpeed * (4 * bound.slope / t.maxSlope + 4 * bound.slope / slope + 24 * roundoff);
  const double aside = std::min(2.0, bound.wished / std::max(result.wantedSpeed, 1e-20));

  // omega: turnGain e with e from two normalised vectors, scaled by followTurn = 1/4 + 3/4 follow.
  bound.turnRate = t.turnGain * (10 * roundoff + aside) + 0.75 * t.turnRate * bound.follow +
                   8 * roundoff * (t.turnRate + 1);
  bound.heading = bound.turnRate * t.dt + 10 * roundoff;
  // The speed before was at most what braking adds.
  bound.speed = result.wantedSpeed * (bound.follow + bound.heading + aside + 12 * roundoff) + bound.wished +
                4 * roundoff * (result.unhinderedSpeed + t.braking * t.dt);
  // Not beyond the edge: places are records, their distance is taken within a tile of it, and divided by the
  // heading's share. The speed rises with the way, so it lies between those of the least and the longest.
  glm::dvec2 least, most;
  for (int axis = 0; axis < 2; ++axis) {
    const double share = std::max(std::abs(next.heading[axis]), 1e-6), left = result.ways[axis] * share;
    const double error = 2 * local + 8 * roundoff * left;
    least[axis] = std::max(0.0, left - error) / (share + bound.heading);
    most[axis] = (left + error) / std::max(share - bound.heading, 1e-6);
  }
  const double slowest = stoppingSpeed(t, std::min(least.x, least.y));
  const double fastest = stoppingSpeed(t, std::min(most.x, most.y));
  if (slowest <= result.unhinderedSpeed + bound.speed)
    bound.speed = std::max(bound.speed, fastest - slowest + 12 * roundoff * fastest);
  const double pushed = creature.reaction ? glm::length(creature.reaction->velocity) : 0;
  bound.position =
      3 * local + t.dt * (bound.speed + result.unhinderedSpeed * bound.heading + 4 * roundoff * pushed);

  // The lean into a turn: s omega times its gain.
  const double lean =
      t.leanGain * (result.unhinderedSpeed * bound.turnRate + std::abs(next.turnRate) * bound.speed) +
      8 * roundoff * t.leanMost + t.leanMost * bound.heading;
  // Unit vectors are at most 2 apart.
  const double up = t.tiltBlend * (bound.slope + lean) + 16 * roundoff + 2 * inputs.blend;
  // F = (h.x, -(N . h) / N.y, h.z): a steep body amplifies by 1 / N.y.
  const double upY = (next.orientation * glm::dvec3(0, 1, 0)).y;
  const double forward = 2 * (up + bound.heading) / upY + 8 * roundoff;
  bound.orientation = up + forward + 16 * roundoff;

  const double arm = (t.bodyHeight + t.bodyRadius) * (up + forward);
  const auto groundAt = [&](const glm::dvec2& place) {
    return height(reliefNear(heights, place.x, place.y), extent, bound.position + arm) + arm;
  };
  const auto planeHeight = [&] {
    return vertical + mean * bound.slope + slope * (point + bound.position) +
           t.dt * (result.unhinderedSpeed + pushed) * bound.slope + 8 * roundoff * slope * t.legLength;
  };
  // How far a body may go falls by 1 while the ground ahead rises by half of what stops it.
  const double stops = std::min(t.climbMost, t.gapMost) / 2;
  const double rises = groundAt(result.lookedAhead) + planeHeight() + 6 * roundoff * std::abs(next.y);
  if (std::min(t.climbMost - result.rises, t.gapMost + result.rises) < stops + rises ||
      t.gapMost + result.rises < t.gapMost / 2 + rises) {
    bound.passes = std::min(1.0, rises / stops + 8 * roundoff);
    const double slows = result.wantedSpeed * bound.passes + bound.wished;
    const double share = slows / std::max(result.unhinderedSpeed, 1e-6 * t.legLength);
    const double walks = std::max(result.unhinderedSpeed, std::min(result.wantedSpeed, 0.3 * t.legLength));
    bound.speed += slows;
    bound.position += t.dt * walks * std::min(1.0, share);
    bound.follow += bound.passes;
  }
  const glm::dvec3 f = next.orientation * glm::dvec3(0, 0, 1);
  const double level = std::hypot(f.x, f.z);
  bound.surfaceSpeed = (bound.speed + next.speed * forward / level) / level + 8 * roundoff;

  double below = 0;
  const glm::dvec2 position = next.world();
  for (int k = -1; k <= 1; ++k) {
    const double ends = k == 0 ? 0 : 1;  // the ground below the origin, and that below the middle line's ends
    const glm::dvec3 q = next.orientation * glm::dvec3(0, ends * t.bodyHeight, k * t.bodyRadius);
    below = std::max(below, groundAt(position + glm::dvec2(q.x, q.z)));
  }
  bound.height = t.heightBlend * (std::max(planeHeight(), below) + 24 * roundoff * t.breathHeight) +
                 t.dt * ((next.speed + pushed) * bound.slope + slope * bound.speed) +
                 6 * roundoff * std::abs(next.y) + 4 * roundoff + inputs.blend * result.rise;
  // Where the ground holds the body, its error is not blended with what the body had.
  const double held = below + 6 * roundoff * std::abs(next.y);
  if (result.heightMargin < bound.height + held) bound.height = std::max(bound.height, held);
  return bound;
}

// A reaction and the body that it moves. Numbers of the records are exact.
struct ReactBounds {
  double time, velocity, way, tilt, tiltRate, ground, frame, floor, reach;
};
inline ReactBounds react(const Tuning& t, const Heights& heights, double extent, const Creature& creature,
                         const AgentBody& body, const Reaction& before, const ReactResult& result) {
  ReactBounds bound{};
  const Reaction& next = result.reaction;
  // Sums and products of a few times; no clock is above a day.
  bound.time = 8 * roundoff * (1 + next.clock + next.down + next.downBefore);
  const double fastest =
      body.speed + std::max(glm::length(before.velocity), glm::length(next.velocity)) + t.gravity * t.dt;
  // T_c is a quotient under a root, and a push fades by another quotient.
  bound.velocity = 24 * roundoff * fastest * (1 + glm::length(creature.centre) / t.bodyHeight);
  // Where the body is held back at the edge, its place is seen over a tick.
  const glm::dvec2 extents{t.halfExtentX, t.halfExtentZ};
  const glm::dvec2 ahead = glm::abs(body.world()) + fastest * t.dt;
  if (ahead.x >= extents.x || ahead.y >= extents.y) bound.velocity += 4 * roundoff * extent / t.dt;
  const bool begins = next.isFallen() && !before.isFallen();
  bound.way = 16 * roundoff;
  if (begins) bound.way += 2 * bound.velocity / std::max(glm::length(next.velocity), t.steadySpeed);
  // A rate and a tilt by five operations each.
  bound.tiltRate = 16 * roundoff *
                   (std::abs(before.tiltRate) + std::abs(next.tiltRate) +
                    t.dt * t.tumbleRate * t.tumbleRate * t.tiltMost + 1);
  if (begins) bound.tiltRate += 2 * bound.velocity / t.bodyHeight;
  bound.tilt = t.dt * bound.tiltRate + 4 * roundoff;
  // Where legs reach to: a home and the centre are rotated once, and xi is a product. A load may hang so low
  // that T_c is the root of a small difference.
  const double load = glm::length(creature.centre);
  bound.reach = rotated(2 * t.legLength + load) + 24 * roundoff * fastest * (1 + load / t.bodyHeight) +
                8 * roundoff * (t.legLength + load);
  if (!next.isFallen() && !next.isLoose()) return bound;

  double lookUp = 0;
  const double horizontal = rotated(t.bodyHeight + t.bodyRadius) + t.dt * bound.velocity;
  for (size_t i = 0; i < result.lookups; ++i)
    lookUp = std::max(lookUp, height(reliefNear(heights, result.looked[i].x, result.looked[i].y), extent,
                                     horizontal + 2 * roundoff * extent));
  // Two differences of heights over the hull's length, normalised.
  bound.ground = t.tiltBlend * (2 * lookUp / t.bodyRadius + 8 * roundoff) + 16 * roundoff;
  bound.velocity += t.dt * t.gravity * 4 * bound.ground;
  // F divides by n.y; the turn has a dozen operations.
  bound.frame = 2 * (bound.ground + bound.way) / std::max(next.ground.y, 1e-3) + bound.tilt + 40 * roundoff;
  const double arm = (t.bodyHeight + t.bodyRadius) * bound.frame;
  double steepest = 0;
  for (size_t i = 0; i < result.lookups; ++i) {
    const Relief relief = reliefNear(heights, result.looked[i].x, result.looked[i].y);
    steepest = std::max(steepest, relief.slopeX + relief.slopeZ);
  }
  bound.floor = lookUp + (1 + steepest) * (arm + t.dt * bound.velocity) + 8 * roundoff * std::abs(body.y) +
                8 * roundoff * (t.bodyHeight + t.bodyRadius);
  return bound;
}

// The stability margin, where the tips are at most `farthest` from the centre. It is measured along normals
// of lines through two tips, and a normal turns by the error of the tips over their distance.
inline double supportMargin(std::span<const glm::dvec2> tips, double farthest) {
  double nearest = farthest;
  for (size_t a = 0; a < tips.size(); ++a)
    for (size_t b = 0; b < a; ++b) nearest = std::min(nearest, glm::distance(tips[a], tips[b]));
  return 16 * roundoff * farthest * (1 + farthest / std::max(nearest, 1e-4));
}

// The wanted speed is a root of two squares, and the threshold a product.
inline double adaptWish(double speed) { return 12 * roundoff * speed; }
// A tick of a trial. The records that it starts from are exact.
struct AdaptBounds {
  double clock = 0, margin = 0, wanted = 0, progress = 0, unstable = 0, fitness = 0;
};
inline AdaptBounds adapt(const Tuning& t, const AgentBody& body, const glm::dvec2& velocity,
                         std::span<const glm::dvec2> support, const Search& before, const Search& ticked) {
  AdaptBounds bound;
  const double wish = glm::length(velocity);
  // The clock is a sum, and the constant with which it is compared is another.
  bound.clock = 8 * roundoff * (1 + ticked.clock);
  bound.margin = supportMargin(support, 2 * t.legLength) + 2 * roundoff * t.legLength;
  // Each tick adds a product that has a quotient in it.
  bound.wanted = roundoff * (24 * wish * t.dt + 2 * ticked.wanted);
  bound.progress = roundoff * (24 * std::abs(body.speed) * t.dt +
                               2 * std::max(std::abs(before.progress), std::abs(ticked.progress)));
  bound.unstable = 2 * roundoff * ticked.unstable;
  // Both factors are quotients of 6 roundings, and one is taken off 1.
  if (ticked.wanted <= 0) return bound;
  const double progress = std::abs(ticked.progress) / ticked.wanted, counted = ticked.clock - 1;
  bound.fitness = (bound.progress + progress * bound.wanted) / ticked.wanted +
                  (bound.unstable + ticked.unstable / counted * bound.clock) / counted +
                  8 * roundoff * (2 + progress + ticked.unstable / counted);
  return bound;
}

// The map's k is at most 0.09 and rounded once. Its constants 0.3 and 1.2 are float32: the first is squared,
// and an error of the second scales r, with r dk/dr at most 0.06.
inline constexpr double gaitKernel = 4 * roundoff * 0.09;
// bound(x) = f + u . w + 2 sqrt(k(x, x) - u . u) of n trials, with K = k(X, X) + 0.001 I = M M^T.
//
// - Computed M, u and w are the exact ones of another matrix K' (Higham 2002, theorems 8.5 and 10.3).
//   Its entries differ from K's, which are at most 0.091, by the error of k and by a rounding per term:
//   n each for M, u and w, and 32 for their quotients and roots, which have up to 6.
// - With g = K^-1 k(X, x) and h = K^-1 (y - f(X)), the mean errs by g (K' - K) h and the variance by
//   g (K' - K) g. Both are at most the error of an entry times the sums of absolute values in g and h.
// - The dot products round n times: u . w is at most |u| |w|, u . u is k(x, X) g.
// - K's least eigenvalue is at least 0.001, over 80 times |K' - K|. A tenth is added for higher orders.
//
// The root of a variance near 0 may be off by the root of the variance's error.
inline double gaitBound(const Outlook& outlook, const Expectation& x) {
  const auto n = static_cast<double>(outlook.trials);
  const double entry = gaitKernel + (3 * n + 32) * roundoff * 0.091;
  const double mean = (entry * x.weights + gaitKernel) * outlook.corrections +
                      roundoff * (n * std::sqrt(x.explained * outlook.surprise) +
                                  x.weights * outlook.mostSurprise + std::abs(x.mean));
  const double variance = (entry * x.weights + 2 * gaitKernel) * x.weights + gaitKernel +
                          roundoff * (n * x.explained + x.variance);
  const double root = std::sqrt(x.variance);
  const double deviation = std::max(std::sqrt(x.variance + variance) - root,
                                    root - std::sqrt(std::max(0.0, x.variance - variance)));
  return 1.1 * (mean + 2 * deviation) + roundoff * (12 * root + 2 * std::abs(x.bound()));
}
// The threshold of a search that ends is 0.9 of the highest fitness in the map, a product.
inline double goodGait(double mostExpected) { return 4 * roundoff * mostExpected; }
// Lame legs: sigma is a product with a quotient that is taken off 1, slowness a product.
inline constexpr double lameSpeed = 12 * roundoff;
inline double lameSlowness(double slowness) { return 2 * roundoff * slowness; }

struct GaitBounds {
  double phase, halfStride, cycle, duration, length, window;
  double ground =
      1e-30;  // of the ground above a foot's way, where gait looks at it; the caller knows the relief
};
inline GaitBounds gait(const Tuning& t, const Gait& gait, int groups, double longestForecast) {
  GaitBounds bound{};
  // One addition below 2, and dt / C with C good to 16 roundoff.
  bound.phase = 6 * roundoff;
  // v_e (C - T) / 2, clamped.
  bound.halfStride = 32 * roundoff * t.halfStrideMax;
  // T / (1 - duty): duty errs by 4 roundoff, and 1 - duty is more than a fifth.
  bound.cycle = 32 * roundoff * gait.cycle;
  bound.duration = 12 * roundoff * (t.swingStill / t.dt + 1);
  // Where a foot stands in the model, and where it is predicted to (a Cayley turn and surfaceSpeed times a
  // time).
  bound.length = footDistance(2 * t.legLength) + 16 * roundoff * longestForecast;
  // A leg's own beginning: a quotient, the spread (a share below 2 of 1 / groups - T / C) times its lag.
  bound.window = groups * (bound.phase + 24 * roundoff);
  return bound;
}

// A foot on its loop. Its phase theta errs by 8 roundoff (a quotient, a sum below 2), so its time in the
// cycle by 9 of the cycle, and by 3 more against the end of stance; a share of the swing by those over the
// swing, and that quotient. What it does there is seen at its speed.
struct LoopBounds {
  double flown, place;
};
inline LoopBounds loopSwing(const Tuning& t, const Limb& limb, const AgentBody& body, const Gait& gait) {
  LoopBounds bound{};
  const double swingTime = limb.stepTicks(gait.duration) * t.dt;
  const double time = 12 * roundoff * gait.cycle;
  bound.flown = time / swingTime + 6 * roundoff;
  const double speed = body.surfaceSpeed + std::abs(body.turnRate) * glm::length(limb.home);
  const double stride = speed * gait.cycle, farthest = glm::length(limb.home) + stride + t.stepHeight;
  // A stance point is a Cayley turn and a product, the spline twelve of what it is made of; between its ends
  // it moves at most four times as far, and as high, in a swing.
  bound.place =
      28 * roundoff * farthest + rotated(farthest) + speed * time + 4 * (stride + t.stepHeight) * bound.flown;
  return bound;
}

struct FootholdBounds {
  double candidate;  // horizontally, before the ground is looked up
};
inline FootholdBounds foothold(const Tuning& t, const FootholdResult& result) {
  // tau and r': a Cayley turn of home and surfaceSpeed (t + S/2), with S = C - T.
  const double target = 16 * roundoff * (glm::length(result.target) + t.legLength);
  // The ladder's direction o / |o| turns by the error of o over |o|; rungs reach 4/3 and 2/3 of rho from r'.
  const double ladder = target * (1 + 4 * result.stretch / std::max(result.side, 1e-6));
  return {ladder + rotated(glm::length(result.target) + 2 * result.stretch)};
}
// A candidate's height above the body.
inline double candidateHeight(const Relief& relief, double extent, double candidate, double bodyY) {
  return height(relief, extent, candidate) + 4 * roundoff * std::abs(bodyY);
}
inline double candidateDistance(const Limb& limb, double candidate, double vertical) {
  return candidate + vertical + rotated(2 * limb.reach);
}

// Share of the unit quaternion's components after `bones` products of 12 operations.
inline double boneRotation(int bones) { return (12.0 * bones + 8) * roundoff; }
// Joint positions down a chain as a share of the reach: each bone adds the error of its rotation times its
// length, and the root is rotated once.
inline double bonePosition(int bones) { return (16.0 * bones + 16) * roundoff; }

// A direction just clamped: its sine is a product of a normalised pair (5 roundoff) and a quotient (4), its
// stereographic form divides once more (3 + 3 of the denominator): 15 roundoff of t = tan(angle / 2), and
// dtheta = 2 dt / (1 + t^2) is at most that.
inline constexpr double limit = 16 * roundoff;
// The angle by which a direction is beyond its limit, from the tangent of its half. The length of (X, Y) errs
// by 7 roundoff (a sum of two squares under a root), the quotient of tangents by 8 more; dtheta as above.
inline constexpr double violation = 15 * roundoff;
// Forward kinematics of `bones` bones in float32, as a share of the reach; 24 operations a bone. A bone's
// rotation divides by 1 + d.z, which at the edge of a cone with t = tan(half-angle / 2) is 2 / (1 + t^2).
inline double forwardKinematics(int bones, double t) {
  return (24.0 * bones + 32) * roundoff * std::max(1.0, (1 + t * t) / 2);
}

// The distance that is left to a target beyond the reach errs by this more than forward kinematics counts for
// one reach: the target's rotation errs by 16 roundoff, the division by the reach by 3, the difference by 1
// and the length by 4. `distance` is the target's from the root; one that is not finite is
// not aimed at.
inline double farTarget(double distance) {
  return std::isfinite(distance) ? 24 * roundoff * std::max(0.0, distance - 1) : 0;
}

// The same of roundings that have either sign and so add up as the root of their number, for those who draw
// such errors or count them in standard deviations.
inline double placing(size_t bones, double t) {
  return std::sqrt(24.0 * static_cast<double>(bones) + 32) * roundoff * std::max(1.0, (1 + t * t) / 2);
}
// How far apart the joints of two poses may be that are the same but for that, as a share of the reach: four
// standard deviations, each of which is `placing` over the root of 3 if errors up to it are uniformly
// distributed. `placing` counts every operation as one on a number of 1, which few are.
inline double samePose(size_t bones, double t) { return 4 * placing(bones, t) / std::sqrt(3.0); }
// As many are allowed of what is measured from solves with such errors: one of 5e8 normally distributed
// numbers is beyond six, and a run compares up to 1e8 legs.
inline constexpr double deviations = 6;

// The errors of a solve's arithmetic. Where they lead depends on the leg: near full stretch a damped step
// amplifies an error by up to 1 / (2 sqrt(mu)) = 158, and comparisons turn. So this is measured, leg by leg,
// from the reference's own solves with such errors (validation/check_ik.cpp).
inline Arithmetic::Roundings solving(const Limb& limb, const Foot& foot, double swing, double targetError) {
  return {roundoff, placing(limb.bones.size(), swing),
          rotated(glm::length(foot.target)) / limb.reach + targetError};
}

}  // namespace skitter::reference::tolerance
