#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/stage.glsl"
#include "lib/crossing.glsl"
#include "lib/rarely.glsl"
#include "stages/ground.glsl"
#include "lib/trail.glsl"
#include "lib/carried.glsl"
#include "stages/hurt.glsl"

LOAD4_BUFFER(BINDING_RIG, rig);
LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_FOOT, feet);
LOAD4_BUFFER(BINDING_CHAIN, chains);
LOAD4_BUFFER(BINDING_TIP, tips);
LOAD4_BUFFER(BINDING_WATCH, watches);
STORE4_BUFFER(BINDING_WATCH_OUT, watchesOut);
LOAD4_BUFFER(BINDING_METRIC, metrics);
#ifdef HURT
LOAD4_BUFFER(BINDING_CARRIED, loads);
#endif
STORE4_BUFFER(BINDING_METRIC_OUT, metricsOut);
#include "stages/counters.glsl"
#include "stages/absent.glsl"
layout(set = 0, binding = BINDING_HISTOGRAM, std430) buffer HistogramBlock { uint histogram[]; };

const float FAR = 3e38;

bool plantedAt(int record) { return LOAD4(feet, record).w >= 1.0; }
vec4 tipOf(int record) { return LOAD4(tips, record); }

Trail loadTrail(int at, out float slip) {
  vec4 a = LOAD4(watches, at), b = LOAD4(watches, at + 1), c = LOAD4(watches, at + 2);
  slip = a.w;
  return Trail(a.xyz, b.xyz, c.xyz, b.w, c.w);
}
void storeTrail(int at, Trail trail, float slip) {
  STORE4(watchesOut, at, vec4(trail.at, slip));
  STORE4(watchesOut, at + 1, vec4(trail.first, trail.path));
  STORE4(watchesOut, at + 2, vec4(trail.second, trail.jerk));
}

// The leg behind on the same side; -1: there is none.
int neighbourOf(int leg) {
  vec3 home = LOAD4(rig, leg * rigStride(BONES) + 1).xyz;
  float nearest = -FAR;
  int found = -1;
  for (int other = 0; other < LEGS; ++other) {
    vec3 at = LOAD4(rig, other * rigStride(BONES) + 1).xyz;
    bool behind = (at.x < 0.0) == (home.x < 0.0) && at.z < home.z && at.z > nearest;
    nearest = behind ? at.z : nearest;
    found = behind ? other : found;
  }
  return found;
}

// Joint positions in model space, and the tangent of half the worst violation of a limit: the host takes the angle, for
// the precision of an arc tangent differs between devices.
struct Stretched {
  vec3 joint[BONES + 1];
  float violation;
};
void stretch(int leg, int record, inout Stretched s) {
  vec4 root = LOAD4(rig, leg * rigStride(BONES)), r = vec4(0.0, 0.0, 0.0, 1.0);
  s.joint[0] = root.xyz;
  s.violation = 0.0;
  for (int i = 0; i < BONES; ++i) {
    vec4 directions = LOAD4(chains, record * chainStride(BONES) + i / 2);
    vec2 xy = (i & 1) == 0 ? directions.xy : directions.zw;
    int bone = leg * rigStride(BONES) + RIG_LEG_STRIDE + RIG_BONE_STRIDE * i;
    vec4 a = LOAD4(rig, bone), b = LOAD4(rig, bone + 1);
    vec3 axis = cross(b.xyz, a.xyz) * xy.x - a.xyz * xy.y;
    r = quaternionProduct(r, vec4(axis, 1.0) * inversesqrt(1.0 + dot(xy, xy)));
    s.joint[i + 1] = s.joint[i] + root.w * a.w * rotate(r, b.xyz);
    float swing = length(xy);
    s.violation = max(s.violation, (swing - b.w) / (1.0 + swing * b.w));
  }
}

bool crossing(Stretched a, Stretched b) {
  bool crosses = false;
  for (int i = 0; i < BONES; ++i)
    for (int j = 0; j < BONES; ++j)
      crosses = crosses || cross2(a.joint[i].xz, a.joint[i + 1].xz, b.joint[j].xz, b.joint[j + 1].xz);
  return crosses;
}

// Greatest depth below the ground of mid-bones and of joints between bones.
float depthOf(Stretched s, vec4 orientation, float y, vec2 world) {
  float depth = 0.0;
  for (int i = 0; i < BONES; ++i) {
    vec3 middle = rotate(orientation, 0.5 * (s.joint[i] + s.joint[i + 1]));
    depth = max(depth, groundAt(world + middle.xz).x - (y + middle.y));
    if (i + 1 == BONES) continue;
    vec3 end = rotate(orientation, s.joint[i + 1]);
    depth = max(depth, groundAt(world + end.xz).x - (y + end.y));
  }
  return depth;
}

// Least support of the planted tips over directions, from `centre`; `anchor` is one of them, `first` the record of
// the first leg.
float supportMargin(int first, vec2 centre, vec2 anchor) {
  vec2 q[LEGS];
  for (int k = 0; k < LEGS; ++k) q[k] = plantedAt(first + k * BLOCK) ? tipOf(first + k * BLOCK).xz - centre : anchor;
  float margin = FAR, none = 1e-12 * parameters.legLength * parameters.legLength;
  for (int i = 0; i < LEGS; ++i) {
    vec2 a = plantedAt(first + i * BLOCK) ? tipOf(first + i * BLOCK).xz - centre : anchor;
    vec2 away = -unit(a);
    float support = -FAR;
    for (int k = 0; k < LEGS; ++k) support = max(support, dot(away, q[k]));
    margin = dot(a, a) > none ? min(margin, support) : margin;
    for (int j = 0; j < i; ++j) {
      vec2 edge = (plantedAt(first + j * BLOCK) ? tipOf(first + j * BLOCK).xz - centre : anchor) - a;
      vec2 normal = unit(vec2(-edge.y, edge.x));
      float high = -FAR, low = FAR;
      for (int k = 0; k < LEGS; ++k) {
        float along = dot(normal, q[k]);
        high = max(high, along);
        low = min(low, along);
      }
      margin = dot(edge, edge) > none ? min(margin, min(high, -low)) : margin;
    }
  }
  return margin < FAR ? margin : 0.0;  // all of them right below the centre
}

void measure(int slot, int agent) {
  int firstLeg = legRecord(agent, 0, LEGS), watchAt = slot * watchStride(LEGS);
  Body body = LOAD_BODY(agent);
  vec2 world = worldOf(body.local, body.tile);
#ifdef HURT
  vec4 load = LOAD4(loads, agent * CARRIED_STRIDE);
#else
  vec4 load = vec4(0.0);
#endif
  vec2 centre = rotate(body.orientation, vec3(0.0, parameters.bodyHeight, 0.0) + centreShift(parameters, load)).xz;
  uint watched = constants.watched, ticks = uint(parameters.jerkTicks);
  uint place = watched >= 3u ? (watched - 3u) % ticks : 0u;
  bool closes = watched >= 3u && place + 1u == ticks;

  vec4 m0 = LOAD4(metrics, agent * METRIC_STRIDE), m1 = LOAD4(metrics, agent * METRIC_STRIDE + 1);
  vec4 m2 = LOAD4(metrics, agent * METRIC_STRIDE + 2), m3 = LOAD4(metrics, agent * METRIC_STRIDE + 3);
  vec4 m4 = LOAD4(metrics, agent * METRIC_STRIDE + 4), m5 = LOAD4(metrics, agent * METRIC_STRIDE + 5);
  vec4 m6 = LOAD4(metrics, agent * METRIC_STRIDE + 6);

  float unused;
  Trail trail = advance(loadTrail(watchAt, unused), body.local, watched, place);
  storeTrail(watchAt, trail, 0.0);
  m6.zw += windowJerk(trail, closes, parameters.jerkTicks, parameters.jerkPath);

  int buckets = rowOf(agent) * HISTOGRAM_BUCKETS;
  float lost = 0.0;  // leg-ticks of lost legs
#ifdef HURT
  lost = m3.w;
#endif
  bool supported = false;
  vec2 anchor = vec2(0.0);
  for (int leg = 0; leg < LEGS; ++leg) {
    int record = firstLeg + leg * BLOCK, at = watchAt + WATCH_TRAIL_STRIDE * (1 + leg);
    vec4 tip = tipOf(record);
    bool planted = plantedAt(record);
    anchor = planted ? tip.xz - centre : anchor;
    supported = supported || planted;

    float slip;
    trail = advance(loadTrail(at, slip), tip.xyz + body.local, watched, place);
    slip = watched == 0u ? (planted ? WATCH_UNSEEN : WATCH_AIR) : slip;
    bool before = slip != WATCH_AIR, stays = planted && before;
    float slide = length(trail.first.xz);
    m0 += vec4(0.0, planted ? 1.0 : 0.0, stays && watched > 0u ? 1.0 : 0.0,
               stays && slide > parameters.skateSpeed * parameters.dt ? 1.0 : 0.0);
    m1.xy += !planted && slip >= 0.0 ? vec2(slip, 1.0) : vec2(0.0);
    slip = !planted ? WATCH_AIR : (before ? (slip >= 0.0 ? slip + slide : WATCH_UNSEEN) : 0.0);
    storeTrail(at, trail, slip);
#ifdef HURT
    // All that is left of a lost leg is where its stump is.
    if (isLost(agent, leg)) {
      m3.w = ++lost;
      continue;
    }
#endif
    m6.xy += windowJerk(trail, closes, parameters.jerkTicks, parameters.jerkPath);

    float above = tip.y + body.local.y - groundAt(world + tip.xz).x;
    float below = max(0.0, -above), over = planted ? max(0.0, above) : 0.0;
    m2 += vec4(below, max(0.0, below - parameters.deadZone), over, max(0.0, over - parameters.deadZone));

    Stretched limb, other;
    stretch(leg, record, limb);
    m1.z = max(m1.z, tip.w);
    m1.w = max(m1.w, limb.violation);
    float depth = depthOf(limb, body.orientation, body.local.y, world);
    bool breaks = 2.0 * limb.violation > parameters.limitDeadZone;
    m3 = vec4(m3.x + depth, max(m3.y, depth), m3.z + (breaks ? 1.0 : 0.0), lost);

    int neighbour = neighbourOf(leg);
#ifdef HURT
    neighbour = neighbour >= 0 && isLost(agent, neighbour) ? -1 : neighbour;
#endif
    stretch(max(neighbour, 0), firstLeg + max(neighbour, 0) * BLOCK, other);
    bool crosses = crossing(limb, other);
    m4.xy += neighbour >= 0 ? vec2(1.0, crosses ? 1.0 : 0.0) : vec2(0.0);

#ifdef HURT
    if (!carries(agent, leg)) continue;  // it has no target
#endif
    float bucket = 4.0 * (log2(max(tip.w / parameters.legLength, 1e-30)) + 20.0);
    atomicAdd(histogram[buckets + int(clamp(floor(bucket), 0.0, float(HISTOGRAM_BUCKETS - 1)))], 1u);
  }

  float margin = supportMargin(firstLeg, centre, anchor);
  m5 = supported ? vec4(m5.x + margin, m4.z > 0.0 ? min(m5.y, margin) : margin, 0.0, 0.0) : m5;
  m4.zw += vec2(supported ? 1.0 : 0.0, !supported || margin < 0.0 ? 1.0 : 0.0);
  m0.x += 1.0;

  STORE4(metricsOut, agent * METRIC_STRIDE, m0);
  STORE4(metricsOut, agent * METRIC_STRIDE + 1, m1);
  STORE4(metricsOut, agent * METRIC_STRIDE + 2, m2);
  STORE4(metricsOut, agent * METRIC_STRIDE + 3, m3);
  STORE4(metricsOut, agent * METRIC_STRIDE + 4, m4);
  STORE4(metricsOut, agent * METRIC_STRIDE + 5, m5);
  STORE4(metricsOut, agent * METRIC_STRIDE + 6, m6);
}

void main() {
  int slot = int(gl_GlobalInvocationID.x), agent = int(constants.first + gl_GlobalInvocationID.x * constants.every);
  RARELY(gl_GlobalInvocationID.x < constants.count && !absent(agent)) measure(slot, agent);
}
