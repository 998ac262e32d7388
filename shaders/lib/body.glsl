#ifndef BODY_GLSL
#define BODY_GLSL
// The pieces of the body stage (docs/stages/body.md).

// 1. Of the planted legs, in reaches: the longest that is being stretched, squared, and the largest miss.
struct Hold {
  float stretch2, miss;
};

void addHold(inout Hold hold, bool planted, vec3 root, vec3 foot, float inverseReach, float miss, vec2 velocity) {
  vec3 d = (foot - root) * inverseReach;
  float stretch2 = dot(d, d);
  bool stretching = planted && dot(d.xz, velocity) < 0.0;
  hold.stretch2 = stretching && stretch2 > hold.stretch2 ? stretch2 : hold.stretch2;
  hold.miss = planted ? max(hold.miss, miss) : hold.miss;
}

// How much they slow the body: 1 not at all, 0 to a stop.
float followFactor(Parameters q, Hold hold) {
  float slack = (q.stretchStop - sqrt(hold.stretch2)) / (q.stretchStop - q.stretchSlow);
  return clamp(min(slack, 1.0 - hold.miss / q.errorStop), 0.0, 1.0);
}

// 2. Turn rate and heading toward `wanted` (unit).
float turnRateToward(Parameters q, vec2 heading, vec2 wanted, float turnRate, float follow) {
  float c = wanted.x * heading.y - wanted.y * heading.x, d = dot(wanted, heading);
  float e = d > 0.0 ? c : (c >= 0.0 ? 1.0 : -1.0);
  float rate = clamp(q.turnGain * e, -q.turnRate, q.turnRate) * mix(0.25, 1.0, follow);
  float limit = q.turnAcceleration * q.dt;
  return turnRate + clamp(rate - turnRate, -limit, limit);
}

// 3. From this speed `braking` stops the body at the terrain's edge: the way that is left along the heading is
// s^2 / (2 braking) + s dt. Tiles are subtracted first, which is exact near the edge. Compilers may add tile and local
// coordinate instead, unless they are told not to: at 4 km such a sum is off by a quarter of a millimetre.
float speedToEdge(Parameters q, vec3 local, vec2 tile, vec2 heading) {
  vec2 outward = sign(heading);
  precise vec2 left = vec2(q.halfExtentX, q.halfExtentZ) - outward * (tile * TILE_SIZE) - outward * local.xz;
  vec2 ways = max(left, vec2(0.0)) / max(abs(heading), vec2(1e-6));
  float way = min(ways.x, ways.y), halfTick = 0.5 * q.dt;
  return way / (halfTick + sqrt(halfTick * halfTick + way / (2.0 * q.braking)));
}

// 4. Weighted sums of ground points for the plane y = mean + b (x - mean.x) + c (z - mean.z).
struct PlaneSums {
  vec3 sum;         // x, y, z
  vec3 xx_xz_zz;
  vec2 xy_zy;
};

void addPoint(inout PlaneSums s, vec3 g) {
  s.sum += g;
  s.xx_xz_zz += vec3(g.x * g.x, g.x * g.z, g.z * g.z);
  s.xy_zy += vec2(g.x * g.y, g.z * g.y);
}

// The plane, which is no steeper than the body can tilt, and how much steeper the ground points lie: 1 as the plane.
struct Plane {
  vec2 slope;  // (b, c)
  float height;  // at x = z = 0
  float steepness;
};

Plane fitPlane(Parameters q, PlaneSums s, float count) {
  vec3 m = s.sum / count;
  vec3 a = s.xx_xz_zz - count * vec3(m.x * m.x, m.x * m.z, m.z * m.z);
  vec2 r = s.xy_zy - count * vec2(m.x * m.y, m.z * m.y);
  float ridge = q.ridge * count;
  float xx = a.x + ridge, zz = a.z + ridge;
  float inverse = 1.0 / (xx * zz - a.y * a.y);
  vec2 slope = vec2(r.x * zz - r.y * a.y, r.y * xx - r.x * a.y) * inverse;
  float share = min(1.0, q.maxSlope * inversesqrt(max(dot(slope, slope), 1e-20)));
  slope *= share;
  return Plane(slope, m.y - slope.x * m.x - slope.y * m.z, 1.0 / share);
}

// From here on up and down ground that is steeper than the body can tilt, it goes along the slope only.
const float STEEPNESS_MOST = 1.25;

// 2. The velocity without the part of it up or down ground that is too steep.
vec2 walkableVelocity(Plane plane, vec2 velocity) {
  float kept = clamp((STEEPNESS_MOST - plane.steepness) / (STEEPNESS_MOST - 1.0), 0.0, 1.0);
  float lost = (1.0 - kept) / max(dot(plane.slope, plane.slope), 1e-20);
  return velocity - plane.slope * (dot(plane.slope, velocity) * lost);
}

// 5. Where the body's up axis is drawn to: square to the plane, a little more level, and into the turn. `toward`: the
// acceleration toward the turn's middle, to the left.
vec3 leaningNormal(Parameters q, vec2 slope, vec2 heading, float toward) {
  float lean = clamp(q.leanGain * toward, -q.leanMost, q.leanMost);
  vec2 up = vec2(heading.y, -heading.x) * lean - slope * (1.0 - q.leanLevel);
  return unit(vec3(up.x, 1.0, up.y));
}

// 6. A breath a cycle of the gait's phase, between 0 and 1.
float breathing(float phase) {
  float x = phase * (1.0 - phase);
  return 16.0 * x * x;
}

// 6. The ground below a body.
struct Underneath {
  float highest;  // of the ground below the origin and the ends of the middle line
  float below;    // below the origin
  float belly;    // where the origin may be for both ends,
  float ahead;    // and for the front end alone
};

// 6. The share of its speed that the ground ahead leaves to a body: 0 before a wall, or before a cliff. `rises`: the
// ground ahead, above where a body on the support plane has it.
float passable(Parameters q, float rises) {
  return clamp(min((q.climbMost - rises) / (0.5 * q.climbMost), (q.gapMost + rises) / (0.5 * q.gapMost)), 0.0, 1.0);
}

// 5. R_0 with up axis `normal` and a forward axis whose horizontal direction is `heading`.
vec3 forwardAxis(vec3 normal, vec2 heading) {
  return unit(vec3(heading.x, -(normal.x * heading.x + normal.z * heading.y) / normal.y, heading.y));
}

#endif
