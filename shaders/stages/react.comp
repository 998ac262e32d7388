#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Herds with reactions can be hurt, too.
#define HURT
#include "stages/awake.glsl"
#include "lib/react.glsl"

LOAD4_BUFFER(BINDING_BODY, bodies);
LOAD4_BUFFER(BINDING_GAIT, gaits);
LOAD4_BUFFER(BINDING_STEP, steps);
LOAD4_BUFFER(BINDING_MISS, misses);
LOAD4_BUFFER(BINDING_PUSH, pushes);
LOAD4_BUFFER(BINDING_CARRIED, loads);
LOAD4_BUFFER(BINDING_REACTION, reactions);
STORE4_BUFFER(BINDING_REACTION_OUT, reactionsOut);
#include "stages/rig_legs.glsl"
#include "stages/ground.glsl"
#include "stages/hurt.glsl"

// In the ticks after an edit of the heights; else no height is looked up below feet.
layout(constant_id = CONSTANT_WATCH) const int WATCH = 0;

struct Legs {
  uint carry, air, planted;  // masks
  bool disturbed;            // ground that is lost, or a foot that slips
};

Legs legsOf(int agent, Body body, uint idle) {
  Legs legs = Legs(0u, 0u, 0u, false);
  [[unroll]] for (int leg = 0; leg < LEGS; ++leg) {
    Step s = LOAD_STEP(legRecord(agent, leg, LEGS));
    bool carries = (idle >> leg & 1u) == 0u, planted = stepProgress(s, thisTick - 1.0) >= 1.0;
    legs.carry |= carries ? 1u << leg : 0u;
    legs.air |= carries && !planted ? 1u << leg : 0u;
    legs.planted |= carries && planted ? 1u << leg : 0u;
    bool slips = LOAD_MISS(agent, leg) > parameters.slipMiss;
    if (WATCH != 0) {
      vec3 landing = fromStep(s.landing, s, body.local, body.tile);
      float ground = groundAt(worldOf(body.local, body.tile) + landing.xz).x - (body.local.y + landing.y);
      slips = slips || ground < -parameters.groundTolerance;
    }
    legs.disturbed = legs.disturbed || (carries && planted && slips);
  }
  return legs;
}

// Whether a leg that can step reaches the capture point, which is `ahead` of the body's centre.
bool isCaught(int agent, Legs legs, mat3 frame, vec3 shift, vec2 ahead) {
  vec2 centre = parameters.bodyHeight * frame[1].xz;
  bool caught = bitCount(legs.carry) < FEWEST_THAT_WALK;
  [[unroll]] for (int leg = 0; leg < LEGS; ++leg) {
    uint neighbours = uint(HURT_LEG(agent, leg).z);
    bool steps = (legs.air >> leg & 1u) != 0u || ((legs.planted >> leg & 1u) != 0u && (neighbours & legs.air) == 0u);
    vec2 spoke = (frame * (RIG_LEG(leg, 1).xyz + shift)).xz - centre;
    float along = clamp(dot(ahead, spoke) / max(dot(spoke, spoke), 1e-12), 0.0, 1.0);
    caught = caught || (steps && distance(ahead, along * spoke) <= parameters.halfStrideMax);
  }
  return caught;
}

// Nobody is carried over the terrain's edge, component by component.
vec2 withinEdges(vec2 velocity, vec2 world) {
  vec2 extent = vec2(parameters.halfExtentX, parameters.halfExtentZ);
  vec2 most = max(vec2(0.0), extent - world) / parameters.dt, least = min(vec2(0.0), -extent - world) / parameters.dt;
  return clamp(velocity, least, most);
}

void beginFall(inout Reaction r, Body body, vec3 up, vec2 velocity) {
  float speed = length(velocity);
  bool again = r.phase == REACTION_RISING;
  r.falls += again ? 0.0 : 1.0;
  r.down = again ? r.down : 0.0;
  r.phase = REACTION_FALLING;
  r.clock = r.over = r.sink = r.drop = r.tilt = r.fold = 0.0;
  r.velocity = velocity;
  r.way = speed < parameters.steadySpeed ? vec2(body.heading.y, -body.heading.x) : velocity / speed;
  r.tiltRate = min(speed / parameters.bodyHeight, 2.0 * parameters.tumbleRate * parameters.lieAngle);
  r.ground = up;
}

// An agent that is not fallen, in a tick; it may fall.
void stand(inout Reaction r, int agent, Body body, mat3 frame, Legs legs, vec3 shift, vec4 load) {
  float dt = parameters.dt, fade = pendulumTime(parameters, load);
  vec2 velocity = body.heading * body.speed + r.velocity;
  bool caught = isCaught(agent, legs, frame, shift, velocity * fade + (frame * centreShift(parameters, load)).xz);
  bool held = caught || r.disturbed <= 0.0;
  // A slow agent is fast from its next tick on, and so has as long as others before it falls.
  float counted = dt * tickShare;
  r.over = held ? 0.0 : r.over + counted;
  r.clock += dt;
  r.fold = 0.0;
  bool rising = r.phase == REACTION_RISING;
  float carry = float(bitCount(legs.carry)), planted = float(bitCount(legs.planted));
  if (rising) {
    float share = carry > 0.0 ? planted / carry : 1.0;
    float height = max(0.0, parameters.bodyHeight - parameters.bellyClearance);
    r.drop = max(0.0, r.drop - share * dt * height / parameters.riseTime);
    r.down += dt;
  }
  if (r.over > 0.0 && r.over >= parameters.fallTime - 0.5 * counted) {
    beginFall(r, body, frame[1], velocity);
    return;
  }
  r.velocity *= held ? 1.0 / (1.0 + dt / fade) : 1.0;
  r.velocity = length(r.velocity) < parameters.steadySpeed ? vec2(0.0) : r.velocity;
  r.velocity = withinEdges(r.velocity, worldOf(body.local, body.tile));
  bool up = rising && r.drop == 0.0 && 2.0 * planted >= carry;
  if (up) {
    r.stands += 1.0;
    r.downBefore += r.down;
    r.down = 0.0;
  }
  if (rising && !up) return;
  bool moved = r.velocity.x != 0.0 || r.velocity.y != 0.0;
  float phase = r.disturbed > 0.0 || moved ? REACTION_STUMBLING : REACTION_STEADY;
  r.clock = phase == r.phase ? r.clock : 0.0;
  r.phase = phase;
}

// Where the body's origin may be lowest.
float hullFloor(vec2 world, mat3 frame) {
  float most = -3e38;
  [[unroll]] for (int k = -1; k <= 1; ++k) {
    vec3 hull = parameters.bodyHeight * frame[1] + float(k) * parameters.bodyRadius * frame[2];
    most = max(most, groundAt(world + hull.xz).x + parameters.bellyClearance - hull.y);
  }
  return most;
}

void tumble(inout Reaction r, Body body, mat3 before) {
  float dt = parameters.dt, reach = parameters.bodyRadius;
  vec2 world = worldOf(body.local, body.tile), middle = world + parameters.bodyHeight * before[1].xz;
  vec3 ground = unit(vec3(groundAt(middle - vec2(reach, 0.0)).x - groundAt(middle + vec2(reach, 0.0)).x, 2.0 * reach,
                          groundAt(middle - vec2(0.0, reach)).x - groundAt(middle + vec2(0.0, reach)).x));
  r.ground = unit(mix(r.ground, ground, parameters.tiltBlend));
  if (r.over > 0.0) {
    r.velocity += dt * parameters.gravity * r.ground.y * r.ground.xz;
    float friction = dt * parameters.slideFriction * parameters.gravity * r.ground.y;
    r.velocity *= max(0.0, 1.0 - friction / max(length(r.velocity), 1e-6));
  }
  r.velocity = withinEdges(r.velocity, world);

  float goal = r.phase == REACTION_RIGHTING ? 0.0 : parameters.lieAngle, spring = parameters.tumbleRate;
  r.tiltRate = (r.tiltRate + dt * spring * spring * (goal - r.tilt)) / (1.0 + 2.0 * parameters.tumbleDamping * spring * dt);
  r.tilt = clamp(r.tilt + dt * r.tiltRate, 0.0, parameters.tiltMost);

  mat3 frame = tippedFrame(r.ground, body.heading, r.way, r.tilt);
  float here = hullFloor(world, frame), there = hullFloor(world + r.velocity * dt, frame);
  bool blocked = there - here > parameters.wallSlope * length(r.velocity) * dt + parameters.wallLeast;
  r.velocity = blocked ? vec2(0.0) : r.velocity;
  float falls = min(r.sink, 0.0) - parameters.gravity * dt, rests = ((blocked ? here : there) - body.local.y) / dt;
  bool touches = rests > falls;
  r.sink = max(falls, rests);
  r.over = touches ? 1.0 : 0.0;

  r.fold = min(1.0, r.fold + dt / parameters.foldTime);
  r.clock += dt;
  r.down += dt;
  bool slow = touches && length(r.velocity) <= parameters.restSpeed;
  float phase = r.phase;
  if (r.phase == REACTION_FALLING) {
    phase = slow && abs(r.tiltRate) <= parameters.restRate ? REACTION_LYING : phase;
  } else if (r.phase == REACTION_LYING) {
    phase = !slow ? REACTION_FALLING : (r.clock >= parameters.lieTime - 0.5 * dt ? REACTION_RIGHTING : phase);
  } else if (touches && r.tilt <= parameters.uprightTilt) {
    phase = REACTION_RISING;
    r.drop = max(0.0, parameters.bodyHeight - parameters.bellyClearance);
    r.over = 0.0;
  }
  r.clock = phase == r.phase ? r.clock : 0.0;
  r.phase = phase;
}

void main() {
  int agent = agentAt(int(gl_GlobalInvocationID.x));
  if (agent < 0) return;
  Body body = LOAD_BODY(agent);
  Reaction r = LOAD_REACTION(agent);
  Hurt hurt = hurtOf(agent);
  mat3 frame = matrixOf(body.orientation);
  vec4 push = LOAD4(pushes, agent), load = LOAD4(loads, agent * CARRIED_STRIDE);
  bool pushed = push.w == crowdTick;
  r.velocity += pushed ? push.xy / (1.0 + load.w) : vec2(0.0);
  Legs legs = legsOf(agent, body, hurt.idle);
  bool loses = (hurt.idle & ~uint(LOAD4(gaits, agent * GAIT_STRIDE + 1).w)) != 0u;
  bool disturbed = pushed || loses || legs.disturbed;
  r.disturbed = disturbed ? parameters.disturbTime : max(0.0, r.disturbed - parameters.dt);
  if (!isFallen(r.phase)) stand(r, agent, body, frame, legs, hurt.shift, load);
  if (isFallen(r.phase)) tumble(r, body, frame);

  int at = agent * REACTION_STRIDE;
  STORE4(reactionsOut, at, vec4(r.phase, r.clock, r.disturbed, r.over));
  STORE4(reactionsOut, at + 1, vec4(r.velocity, r.sink, r.drop));
  STORE4(reactionsOut, at + 2, vec4(r.way, r.tilt, r.tiltRate));
  STORE4(reactionsOut, at + 3, vec4(r.ground, r.fold));
  STORE4(reactionsOut, at + 4, vec4(r.falls, r.stands, r.down, r.downBefore));
}
