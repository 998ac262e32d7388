#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "stages/stage.glsl"
#include "lib/foothold.glsl"
#include "lib/gait.glsl"
#include "lib/hermite.glsl"
#include "lib/route.glsl"
#include "stages/ground.glsl"
#include "stages/hurt.glsl"

LOAD4_BUFFER(BINDING_RIG, rig);
LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_GAIT, gaits);
LOAD4_BUFFER(BINDING_STEP, steps);
LOAD4_BUFFER(BINDING_ARC, arcs);
#ifdef HURT
LOAD4_BUFFER(BINDING_CHAIN, chains);
#endif
STORE4_BUFFER(BINDING_STEP_OUT, stepsOut);
STORE4_BUFFER(BINDING_ARC_OUT, arcsOut);
layout(set = 0, binding = BINDING_LIST, std430) readonly buffer ListBlock { uint list[]; };
#include "stages/counters.glsl"
#ifdef AMONG
#include "stages/others.glsl"
#endif

#ifdef HURT
// Where a foot hangs that has not carried: the end of the leg's pose, relative to the body.
vec3 hangingFoot(int record, int leg, vec4 orientation) {
  int rigAt = leg * rigStride(BONES);
  vec4 root = LOAD4(rig, rigAt), r = orientation;
  vec3 p = rotate(r, root.xyz);
  for (int i = 0; i < BONES; ++i) {
    vec4 directions = LOAD4(chains, record * chainStride(BONES) + i / 2);
    vec2 s = (i & 1) == 0 ? directions.xy : directions.zw;
    int bone = rigAt + RIG_LEG_STRIDE + RIG_BONE_STRIDE * i;
    vec4 a = LOAD4(rig, bone), b = LOAD4(rig, bone + 1);
    vec3 axis = cross(b.xyz, a.xyz) * s.x - a.xyz * s.y;
    r = quaternionProduct(r, vec4(axis, 1.0) * inversesqrt(1.0 + dot(s, s)));
    p += root.w * a.w * rotate(r, b.xyz);
  }
  return p;
}
#endif

// Where a leg may land, and what judges it.
struct Search {
  Ladder ladder;
  Range range;
  vec3 up, root, predicted;  // along world axes, relative to the body
  vec2 world;                // the body's place
  float height;              // and height
};

// The best candidate on the ladder; with none that fits, `predicted`, which does not.
Candidate bestOn(Search search) {
  Candidate best;
  best.score = 3e38;
  best.fits = false;
  best.point = search.predicted;
  best.distance = 0.0;
  // Rung by rung and along each, some places at once: their heights, far away in memory, are waited for together.
  int k = 1, j = -1;
  for (int places = 0; places < PLACES; places += AT_ONCE) {
    vec3 q[AT_ONCE], ground[AT_ONCE];
    [[unroll]] for (int i = 0; i < AT_ONCE; ++i) {
      q[i] = placeOn(search.ladder, k, j);
      ground[i] = groundAt(search.world + q[i].xz);
      bool last = j == k;
      k += last ? 1 : 0;
      j = last ? -k : j + 1;
    }
    [[unroll]] for (int i = 0; i < AT_ONCE; ++i) {
      q[i].y = ground[i].x - search.height;
      Candidate candidate =
          judge(parameters, q[i], ground[i], search.up, search.root, search.predicted, search.range);
#ifdef AMONG
      candidate.score += costOfOthers(q[i].xz, search.range.inverseSquare);
#endif
      if (candidate.fits && candidate.score < best.score) best = candidate;
    }
  }
  return best;
}

// Where none fits, `point` moves to the candidate that is nearest to doing so: one that faces up, if there is one. Few legs
// have none that fits; where none of those solved side by side has, these loops end after a turn.
void takeLastResort(Search search, bool lastResort, int agent, inout vec3 point) {
  float nearestMiss = 3e38;
  for (int k = 1; lastResort && k <= RUNGS; ++k) {
    for (int j = -k; j <= k; ++j) {
      vec3 q = placeOn(search.ladder, k, j), ground = groundAt(search.world + q.xz);
      q.y = ground.x - search.height;
      float far = distance(q, search.root), miss = abs(far - clamp(far, search.range.least, search.range.most));
      miss += facing(ground.yz, search.up) < parameters.slopeLeast ? parameters.legLength : 0.0;
      if (miss < nearestMiss) {
        nearestMiss = miss;
        point = q;
      }
    }
  }
  if (lastResort) countForHerd(true, agent, ROW_LAST_RESORTS);
}

// The shortest lift of at least `least` that clears the ground between p0 and p1.
vec3 shortestLift(Search search, vec3 p0, vec3 p1, bool reaim, vec3 m0, float least) {
  vec3 aside = unit(cross(search.up, p1 - p0)) * parameters.routeWidth;
  vec3 lift = vec3(0.0);
  float shortest = 3e38;
  // No bow is shorter than the least lift, so most steps look along the straight lane alone.
  for (int lane = 0; lane < WAYS && shortest > 1.0001 * least * least; ++lane) {
    vec3 side = aside * sideOf(lane);
    float height = least;
    for (int i = 0; i < SAMPLES; ++i) {
      Place place = placeOf(p0, p1, reaim, m0, i);
      vec3 p = place.straight + place.share * side;
      float gap = groundAt(search.world + p.xz).x - (search.height + p.y);
      height = max(height, (gap * search.up.y + parameters.stepClearance * place.clearing) / place.share);
    }
    float over = max(0.0, height - parameters.stepHeightMax);
    vec3 bow = search.up * (height - over) + side;
    float cost = dot(bow, bow) + ROUTE_FORBIDDEN * over * over;
    if (cost < shortest) {
      shortest = cost;
      lift = bow;
    }
  }
  return lift;
}

void main() {
  uint listed = gl_GlobalInvocationID.x;
  if (listed >= counters[COUNTER_LISTED]) return;
  int record = int(list[listed] >> 1);
  bool reaim = (list[listed] & 1u) != 0u;
  if (LEVELS) {
    record &= (LIST_LEVEL >> 1) - 1;
    tickOver(float(1u << (list[listed] / uint(LIST_LEVEL))));
  }
  int agent = agentOfRecord(record, LEGS), leg = legOfRecord(record, LEGS);

  int rigAt = leg * rigStride(BONES);
  // What is far away in memory is asked for first, though the arc is needed last.
  Body body = LOAD_BODY(agent);
  Step old = LOAD_STEP(record);
  Arc oldArc = LOAD_ARC(record);
  vec4 root = LOAD4(rig, rigAt), home = LOAD4(rig, rigAt + 1);
  float reach = root.w;
  float freshTicks = LOAD4(gaits, agent * GAIT_STRIDE).w, cycle = LOAD4(gaits, agent * GAIT_STRIDE + 1).y;
#ifdef HURT
  // gait lists it as both lifted and aimed anew.
  uint both = uint(LOAD4(gaits, agent * GAIT_STRIDE).y) & uint(LOAD4(gaits, agent * GAIT_STRIDE).z);
  bool rises = (both >> leg & 1u) != 0u;
  reaim = reaim && !rises;
  home.xyz += hurtNow(agent, body.orientation).shift;
  freshTicks = slowTicks(freshTicks, HURT_LEG(agent, leg).w);
#endif
  float flown = thisTick - 1.0 - old.firstTick;
  float ticks = reaim ? max(old.ticks - flown, REAIM_LEAST) : freshTicks;
  float time = ticks * parameters.dt, stance = cycle - freshTicks * parameters.dt;

  vec3 tau = predictLanding(home.xyz, body.turnRate, body.surfaceSpeed, time, stance);
  vec3 rootThen = predictRoot(root.xyz, body.turnRate, body.surfaceSpeed, time);
  vec2 out2 = tau.xz - rootThen.xz;
  float span = length(out2);
  vec2 o = span < 1e-6 ? unit(home.xz - root.xz) : out2 / span;
  float rho = max(span, 0.1 * reach);
  Search search;
  search.up = rotate(body.orientation, vec3(0.0, 1.0, 0.0));
  search.predicted = rotate(body.orientation, tau);
  search.root = rotate(body.orientation, rootThen);
  search.world = worldOf(body.local, body.tile);
  search.height = body.local.y;
  search.ladder = Ladder(search.predicted, rotate(body.orientation, vec3(o.x, 0.0, o.y)) * (rho / 3.0),
                         rotate(body.orientation, vec3(-o.y, 0.0, o.x)) * (rho / 6.0));
  search.range = rangeOf(parameters, reach);

#ifdef AMONG
  drawLines(agent, time, stance);
#endif
  Candidate best = bestOn(search);
  bool lastResort = !best.fits;
  takeLastResort(search, lastResort, agent, best.point);

  // Relative to the body's position, as the old step too; stored relative to its tile.
  Swing flight = swingOf(old, oldArc, body.local, body.tile);
  float u = stepProgress(old, thisTick - 1.0);
  float rate = startRate(flight), way = easedTime(u, rate);
  vec3 p0 = reaim ? swingPoint(flight, way) : flight.p1;
#ifdef HURT
  if (rises) p0 = hangingFoot(record, leg, body.orientation);
#endif
  vec3 p1 = best.point;
  vec3 m0 = reaim ? swingTangent(flight, way) * (easedRate(u, rate) * ticks / old.ticks) : vec3(0.0);
  vec3 lift = shortestLift(search, p0, p1, reaim, m0, parameters.stepHeight * (reaim ? 1.0 - u : 1.0));
  m0 = reaim ? m0 : lift;

  float lasts = (lastResort ? -ticks : ticks) * tickSpan;
  STORE4_TWO(stepsOut, record * STEP_STRIDE, vec4(p1 + body.local, lastTick()),
             vec4(p0 + body.local, packedTicks(lasts, stepTile(body.tile.x, body.tile.y))));
  STORE4_TWO(arcsOut, record * ARC_STRIDE, vec4(lift, 0.0), vec4(m0, 0.0));
}
