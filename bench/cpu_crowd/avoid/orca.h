#pragma once

#include <cmath>

#include "bench/cpu_crowd/avoid/kd_tree.h"
#include "bench/cpu_crowd/avoid/linear_program.h"

// van den Berg, Guy, Lin and Manocha 2011, "Reciprocal n-body collision avoidance": of the ten nearest agents
// each forbids a half of the velocities, and the velocity is the nearest allowed one to the desired one, or
// the one that violates the half-planes least. Written from the paper; what the paper leaves open is as in
// docs/stages/avoid.md: horizon, how soon those who overlap part, how far agents see and how fast they may
// go.
namespace skitter::cpu_avoid {

constexpr size_t orcaNeighbours = KdTree::mostFound;
constexpr double orcaHorizon = 2, orcaPushTime = 0.5;  // seconds
constexpr double orcaPushSpeed = 0.3;                  // leg lengths a second, which anybody may go at

// Section 4 of the paper: `p` leads to the other agent, `v` is the velocity relative to it, `own` the agent's
// velocity, `radii` of both, `share` of the change that the agent takes. The velocity obstacle is a cone with
// a round end; u leads from v to its nearest edge, and n is the outward normal there.
inline Allowed orcaOf(const Velocity& p, const Velocity& v, const Velocity& own, double radii, double share) {
  const double distance2 = dot(p, p);
  // Those who overlap have no cone: the round end of a nearer horizon is all there is.
  const bool overlap = distance2 <= radii * radii;
  const double inverseTime = 1 / (overlap ? orcaPushTime : orcaHorizon);
  const Velocity w{v.x - p.x * inverseTime, v.z - p.z * inverseTime};
  const double along = dot(w, p), speed2 = dot(w, w);
  Velocity n;
  double u;  // its length, outward
  if (overlap || (along < 0 && along * along > radii * radii * speed2)) {
    const double speed = std::sqrt(speed2);
    n = speed > 0 ? Velocity{w.x / speed, w.z / speed} : Velocity{1, 0};
    u = radii * inverseTime - speed;
  } else {
    // The cone's sides touch the disc about p at sines of radii / |p| from the way.
    const double leg = std::sqrt(distance2 - radii * radii);
    const double side = p.x * w.z - p.z * w.x > 0 ? 1 : -1;
    n = {(-p.z * leg * side - p.x * radii) / distance2, (p.x * leg * side - p.z * radii) / distance2};
    u = -dot(n, v);
  }
  return {n, dot(n, own) + share * u};
}

}  // namespace skitter::cpu_avoid
