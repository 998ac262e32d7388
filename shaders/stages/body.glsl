#ifndef BODY_STAGE_GLSL
#define BODY_STAGE_GLSL
// Stage body, for entry points that make it alone or together with gait; they declare its bindings.
#include "lib/aside.glsl"
#include "lib/body.glsl"
#include "stages/rig_legs.glsl"
#include "stages/ground.glsl"
#include "stages/hurt.glsl"

#ifdef REACTS
// A body that does not stand on its legs goes as react has it.
Body looseBody(Body body, Reaction r) {
  mat3 frame = tippedFrame(r.ground, body.heading, r.way, r.tilt);
  vec4 orientation = quaternionFromColumns(frame[0], frame[1], frame[2]);
  body.orientation = dot(orientation, body.orientation) < 0.0 ? -orientation : orientation;
  body.local += vec3(r.velocity.x, r.sink, r.velocity.y) * parameters.dt;
  vec2 crossed = floor(body.local.xz / TILE_SIZE);
  body.tile += crossed;
  body.local.xz -= crossed * TILE_SIZE;
  body.speed = body.turnRate = body.still = body.surfaceSpeed = 0.0;
  body.follow = parameters.followLeast;
  return body;
}
#endif

layout(constant_id = CONSTANT_AVOIDS) const bool AVOIDS = false;

// The ground below a body that has moved, with up and forward axis.
Underneath underneath(Body body, vec2 moved, vec3 normal, vec3 forward) {
  vec2 world = worldOf(vec3(body.local.x + moved.x, 0.0, body.local.z + moved.y), body.tile);
  vec3 middle = parameters.bodyHeight * normal, front = parameters.bodyRadius * forward;
  float below = groundAt(world).x, behind = groundAt(world + middle.xz - front.xz).x,
        ahead = groundAt(world + middle.xz + front.xz).x;
  float clear = parameters.bellyClearance - middle.y;
  Underneath ground;
  ground.highest = max(below, max(behind, ahead));
  ground.below = below;
  ground.ahead = ahead + clear - front.y;
  ground.belly = max(behind + clear + front.y, ground.ahead);
  return ground;
}

// `body` is the agent's, `steer` the record of it, or avoid's.
Body makeBody(int agent, Body body, vec4 steer) {
  vec2 velocity = steer.xy;
  float dt = parameters.dt;
#ifdef REACTS
  Body old = body;
  Reaction reaction = LOAD_REACTION(agent);
  velocity *= reaction.phase == REACTION_RISING ? 0.0 : 1.0;
#endif
#ifdef HURT
  Hurt hurt = hurtOf(agent);
  velocity *= hurt.speed;
  float points = max(float(LEGS - bitCount(hurt.idle)), 1.0);
#else
  const float points = float(LEGS);
#endif

  // Ground points are summed relative to the old position; the new one differs by `moved`.
  Hold hold = Hold(0.0, 0.0);
  mat3 before = matrixOf(body.orientation);
  PlaneSums sums = PlaneSums(vec3(0.0), vec3(0.0), vec2(0.0));
#ifdef BLIND
  // Legs that do not know where they stand: the body lies on the ground below their homes.
  [[unroll]] for (int leg = 0; leg < LEGS; ++leg) {
    vec3 home = RIG_LEG(leg, 1).xyz;
#ifdef HURT
    home += hurt.shift;
#endif
    home = rotate(body.orientation, home);
    WHERE_CARRIES(hurt, leg)
    addPoint(sums, vec3(home.x, groundAt(worldOf(body.local, body.tile) + home.xz).x - body.local.y, home.z));
  }
#else
  [[unroll]] for (int leg = 0; leg < LEGS; ++leg) {
    Step s = LOAD_STEP(legRecord(agent, leg, LEGS));
    float u = stepProgress(s, thisTick - 1.0);
    vec3 landing = fromStep(s.landing, s, body.local, body.tile);
    vec3 liftOff = fromStep(s.liftOff, s, body.local, body.tile);
    vec4 root = RIG_LEG(leg, 0);
    WHERE_CARRIES(hurt, leg) {
      addHold(hold, u >= 1.0, before * root.xyz, landing, RIG_LEG(leg, 2).z, LOAD_MISS(agent, leg), velocity);
      addPoint(sums, u >= 1.0 ? landing : mix(liftOff, landing, u));
    }
  }
#endif

  float follow = max(followFactor(parameters, hold), parameters.followLeast);
  Plane plane = fitPlane(parameters, sums, points);
  vec2 slope = plane.slope;
  velocity = walkableVelocity(plane, velocity);

  float commanded = length(velocity);
  bool going = commanded > 1e-4 * parameters.legLength;
  vec2 wanted = going ? velocity / commanded : body.heading;
  body.turnRate = turnRateToward(parameters, body.heading, wanted, body.turnRate, follow);
  body.heading = unit(turn(body.turnRate * dt, vec3(body.heading.x, 0.0, body.heading.y)).xz);
  float speed = follow * commanded * max(0.0, dot(wanted, body.heading));
  body.speed += clamp(speed - body.speed, -parameters.braking * dt, parameters.acceleration * dt);
  body.speed = min(body.speed, speedToEdge(parameters, body.local, body.tile, body.heading));
  if (AVOIDS) body.speed = min(body.speed, steer.w);
  vec2 walked = body.heading * (body.speed * dt);
  if (AVOIDS) {
    // Who is blocked ahead steps aside. Both displacements lie in its cell, which is convex.
    float toEdge = speedToEdge(parameters, body.local, body.tile, wanted);
    float aside = AVOID_PUSH_SPEED * parameters.legLength;
    vec2 stepped = wanted * (min(follow * min(commanded, aside), toEdge) * dt);
    walked = mix(walked, stepped, clamp(1.0 - steer.w / aside, 0.0, 1.0));
  }
  vec2 carried = vec2(0.0);
#ifdef REACTS
  carried = reaction.velocity * dt;
#endif

#ifdef BLIND
  vec3 settled = unit(vec3(-slope.x, 1.0, -slope.y));
  float breath = 0.0;
#else
  vec3 settled = leaningNormal(parameters, slope, body.heading, body.speed * body.turnRate);
  float breath = breathing(LOAD4(gaits, agent * GAIT_STRIDE).x) * min(1.0, body.still / parameters.settleTime);
#endif
  vec3 normal = rotate(body.orientation, vec3(0.0, 1.0, 0.0));
  normal = unit(mix(normal, settled, parameters.tiltBlend));
  vec3 forward = forwardAxis(normal, body.heading);
  vec4 orientation = quaternionFromColumns(cross(normal, forward), normal, forward);
  body.orientation = dot(orientation, body.orientation) < 0.0 ? -orientation : orientation;

  // A body that the ground ahead slows goes no farther than it may, and looks again at where it comes to: a loop, which
  // ends after one turn where no body does.
  vec2 moved;
  Underneath ground;
  float passes = 1.0;
  for (bool first = true, looks = true; looks; first = false) {
    moved = walked + carried;
    ground = underneath(body, moved, normal, forward);
    float rises = ground.ahead - (body.local.y + plane.height + dot(slope, moved));
    passes = first ? passable(parameters, rises) : passes;
    looks = first && passes < 1.0;
    float share = clamp(passes * commanded / max(body.speed, 1e-6 * parameters.legLength), 0.0, 1.0);
    share = looks ? share : 1.0;
    body.speed *= share;
    walked *= share;
  }
  float planeHeight = body.local.y + plane.height + dot(slope, moved);
  float standing = planeHeight;
#ifdef HURT
  planeHeight -= hurt.shift.y;  // the body is so much lower
#endif
#ifdef REACTS
  planeHeight -= reaction.drop;
#endif
  float least = ground.below + max(planeHeight - standing - parameters.sinkMost, parameters.bellyClearance - parameters.bodyHeight);
  float lowest = max(least, min(ground.belly, standing + parameters.climbMost));
  float height = max(planeHeight + parameters.breathHeight * breath, lowest);
  height = mix(body.local.y + dot(slope, moved), height, parameters.heightBlend);
  body.local.y = min(max(height, least - 0.5 * parameters.sinkMost), ground.highest + parameters.riseMost);

  body.local.xz += moved;
  vec2 crossed = floor(body.local.xz / TILE_SIZE);
  body.tile += crossed;
  body.local.xz -= crossed * TILE_SIZE;

  body.surfaceSpeed = body.speed * inversesqrt(max(dot(forward.xz, forward.xz), 1e-20));
  float l = parameters.legLength;
  bool still = commanded < 1e-2 * l && body.speed < 1e-2 * l && abs(body.turnRate) < 1e-2;
  body.still = still ? body.still + dt : 0.0;
  body.follow = follow * passes;
#ifdef REACTS
  body.still = reaction.phase == REACTION_STEADY ? body.still : 0.0;
  if (isLoose(reaction)) body = looseBody(old, reaction);
#endif

  int at = agent * BODY_STRIDE;
  STORE4_TWO(bodiesOut, at, vec4(body.local, packedTile(body.tile.x, body.tile.y)), vec4(body.heading, body.speed, 0.0));
  STORE4_TWO(bodiesOut, at + 2, body.orientation, vec4(body.turnRate, body.still, body.follow, body.surfaceSpeed));
  return body;
}

#endif
