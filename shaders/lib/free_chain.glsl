#ifndef FREE_CHAIN_GLSL
#define FREE_CHAIN_GLSL
#include "columns.glsl"
// Chains without limits (docs/ik.md): a pose is its joints alone, and every solver makes one iteration of it.
// Lengths in units of the reach, base at the origin, joint[0] = 0.

struct FreePose {
  vec3 joint[BONES + 1];
};

// The shortest rotation of unit a onto unit b; none where either is 0.
vec4 shortestArc(vec3 a, vec3 b) {
  float c = dot(a, b);
  vec4 arc = vec4(cross(a, b), 1.0 + c);
  vec3 axis = abs(a.y) > 0.9 ? vec3(0.0, -a.z, a.y) : vec3(a.z, 0.0, -a.x);  // X or Y cross a
  return c < -0.999999 ? vec4(unit(axis), 0.0)
                       : arc * inversesqrt(max(dot(arc, arc), 1e-20));
}

// Some direction perpendicular to a unit `line`, toward `pole` where that can be.
vec3 acrossLine(vec3 line, vec3 pole) {
  vec3 w = pole - line * dot(pole, line);
  vec3 other = abs(line.x) > 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
  return unit(dot(w, w) > 1e-12 ? w : other - line * dot(other, line));
}

bool freeDeadlocked(vec3 target, FreePose pose) {
  vec3 line = unit(pose.joint[BONES]);
  float off = 0.0;
  for (int i = 1; i < BONES; ++i) {
    vec3 away = cross(line, pose.joint[i]);
    off = max(off, dot(away, away));
  }
  return off < 1e-6 && length(target) < 0.999 * length(pose.joint[BONES]);
}

// From each bone's direction to the joints. A bone without length keeps its place.
void fromDirections(float bone[BONES], vec3 u[BONES], inout FreePose pose) {
  for (int i = 0; i < BONES; ++i) pose.joint[i + 1] = pose.joint[i] + bone[i] * u[i];
}

void toDirections(float bone[BONES], FreePose pose, inout vec3 u[BONES]) {
  for (int i = 0; i < BONES; ++i) u[i] = unit(pose.joint[i + 1] - pose.joint[i]);
}

float bow(int i) { return 0.1 * (1.0 - 2.0 * float(i) / float(max(BONES - 1, 1))); }

void freeBend(float bone[BONES], vec3 pole, inout FreePose pose) {
  vec3 u[BONES];
  toDirections(bone, pose, u);
  vec3 w = acrossLine(unit(pose.joint[BONES]), pole);
  for (int i = 0; i < BONES; ++i) u[i] = BONES == 1 ? u[i] : unit(u[i] + bow(i) * w);
  fromDirections(bone, u, pose);
}

void freeFabrik(float bone[BONES], vec3 target, inout FreePose pose) {
  vec3 q[BONES];  // where bone i should end
  vec3 end = target;
  for (int i = BONES - 1; i >= 0; --i) {
    q[i] = end;
    end += bone[i] * unit(pose.joint[i] - end);
  }
  vec3 p = vec3(0.0), before = vec3(0.0);
  for (int i = 0; i < BONES; ++i) {
    vec3 v = q[i] - p, kept = pose.joint[i + 1] - before;
    before = pose.joint[i + 1];
    // A bone that is sent to where it starts keeps its direction.
    float v2 = dot(v, v);
    p += v2 < 1e-12 ? kept : v * (bone[i] * inversesqrt(max(v2, 1e-20)));
    pose.joint[i + 1] = p;
  }
}

// From the last joint to the first: what turns later turns everything beyond it too, so only the tip is moved on
// the way and the turns are applied at the end.
void freeCcd(float bone[BONES], vec3 target, inout FreePose pose) {
  vec4 turn[BONES];
  vec3 tip = pose.joint[BONES];
  for (int i = BONES - 1; i >= 0; --i) {
    vec3 arm = tip - pose.joint[i], to = target - pose.joint[i];
    turn[i] = bone[i] > 0.0 ? shortestArc(unit(arm), unit(to)) : vec4(0.0, 0.0, 0.0, 1.0);
    tip = pose.joint[i] + rotate(turn[i], arm);
  }
  vec3 u[BONES];
  toDirections(bone, pose, u);
  vec4 r = vec4(0.0, 0.0, 0.0, 1.0);
  for (int i = 0; i < BONES; ++i) {
    r = quaternionProduct(r, turn[i]);
    u[i] = rotate(r, u[i]);
  }
  fromDirections(bone, u, pose);
}

// Buss 2004. Joints have three axes each, so the columns need not be written down: r cross lambda is what a joint
// turns by, and |r|^2 I - r r^T its part of J J^T. `rest`: rest directions, for the null-space part.
void freeJacobian(float bone[BONES], vec3 target, int solver, vec3 rest[BONES], inout FreePose pose) {
  vec3 e = target - pose.joint[BONES];
  float e2 = dot(e, e), pull = min(0.05, sqrt(e2));
  e *= min(1.0, 0.5 * inversesqrt(max(e2, 1e-20)));
  vec3 end = solver == SOLVER_TARGET_ATTACHED ? target : pose.joint[BONES];
  vec3 u[BONES], own[BONES];
  toDirections(bone, pose, u);
  Symmetric m = Symmetric(vec3(0.0), vec3(0.0));
  for (int i = 0; i < BONES; ++i) {
    vec3 r = bone[i] > 0.0 ? end - pose.joint[i] : vec3(0.0);
    m.diagonal += vec3(dot(r, r));
    addOuter(m, r, -1.0);
    own[i] = vec3(0.0);
    if (solver == SOLVER_PSEUDOINVERSE) {
      own[i] = bone[i] > 0.0 ? pull * cross(u[i], rest[i]) : vec3(0.0);
      e -= cross(own[i], r);
    }
  }
  vec3 lambda = lambdaOf(solver, m, e);
  float largest = 0.0;
  for (int i = 0; i < BONES; ++i) {
    vec3 r = bone[i] > 0.0 ? end - pose.joint[i] : vec3(0.0);
    own[i] += cross(r, lambda);
    largest = max(largest, dot(own[i], own[i]));
  }
  float share = largest > 1.0 ? inversesqrt(largest) : 1.0;
  vec4 r = vec4(0.0, 0.0, 0.0, 1.0);
  for (int i = 0; i < BONES; ++i) {
    vec3 half_ = 0.5 * share * own[i];
    r = quaternionProduct(r, vec4(half_, 1.0) * inversesqrt(1.0 + dot(half_, half_)));
    u[i] = unit(rotate(r, u[i]));
  }
  fromDirections(bone, u, pose);
}

// Two bones, law of cosines.
void twoBone(float bone[BONES], vec3 target, vec3 pole, inout FreePose pose) {
  float l0 = bone[0], l1 = bone[BONES - 1], away = length(target);
  vec3 tip = pose.joint[BONES];
  vec3 line = away > 1e-6 ? target / max(away, 1e-6) : (dot(tip, tip) > 1e-12 ? unit(tip) : unit(pose.joint[1]));
  float reach = clamp(away, abs(l0 - l1), l0 + l1);
  vec3 w = acrossLine(line, dot(pole, pole) > 0.0 ? pole : pose.joint[1]);
  float along = reach < 1e-6 ? 0.0 : (reach * reach + l0 * l0 - l1 * l1) / (2.0 * max(reach, 1e-6));
  pose.joint[1] = along * line + sqrt(max(l0 * l0 - along * along, 0.0)) * w;
  pose.joint[BONES] = pose.joint[1] + l1 * unit(reach * line - pose.joint[1]);
}

// What stretch-align knows: bone directions along the line and across it, and the search for lambda.
struct Stretch {
  float along[BONES];  // a_i
  vec3 across[BONES];  // b_i
  float lambda, low, high, g;
  vec3 h;
  bool done;
};

// One step of Newton, from lambda = 0 where it is the `first`.
void stretchStep(float bone[BONES], float wanted, float goal, float enough, bool first, bool onward, inout Stretch at) {
  float g = 0.0, dg = 0.0;
  vec3 h = vec3(0.0), dh = vec3(0.0);
  for (int i = 0; i < BONES; ++i) {
    float v = first ? at.along[i] : at.along[i] + at.lambda, b2 = dot(at.across[i], at.across[i]);
    float rho = first ? 1.0 : inversesqrt(max(v * v + b2, 1e-12)), l = bone[i] * rho, l3 = l * rho * rho;
    g += l * v;
    h += l * at.across[i];
    dg += l3 * b2;
    dh -= l3 * v * at.across[i];
  }
  float s = sqrt(g * g + dot(h, h));
  at.g = g;
  at.h = h;
  at.done = abs(s - wanted) < enough;
  float slope = (g * dg + dot(h, dh)) / max(s, 1e-6), f = inversesqrt(max(1.0 - s, 1e-9));
  at.low = s < wanted ? at.lambda : at.low;
  at.high = s < wanted ? at.high : at.lambda;
  float next = at.lambda - (f - goal) / (0.5 * f * f * f * slope);
  bool inside = next > at.low && next < at.high;
  float middle = at.low < -1e8 ? at.high - 1.0 : (at.high > 1e8 ? at.low + 1.0 : 0.5 * (at.low + at.high));
  float before = at.lambda;
  // A straight chain's slope is rounding, and a step by it may be anything.
  bool sound = onward && inside && abs(next - before) < 0.5 + 0.5 * abs(before);
  at.lambda = at.done ? (sound ? max(next, -3.0) : at.lambda) : max(inside ? next : middle, -3.0);
  if (onward && at.done) {
    at.g += (at.lambda - before) * dg;
    at.h += (at.lambda - before) * dh;
  }
}

// The bends keep their directions; how far the chain must be stretched or folded along its own line for its tip
// to be as far as the target is one number, found by Newton (docs/ik.md, Stretch-align); `onward`, Newton's step is
// taken once more where the distance is near enough. With `steps` those are made in a row, and a chain that needs more, or is straight,
// is given up: false. Without, as many as it takes.
bool stretchAlign(float bone[BONES], vec3 target, vec3 pole, float tolerance, bool onward, int steps, inout FreePose pose) {
  vec3 u[BONES];
  Stretch at;
  toDirections(bone, pose, u);
  vec3 tip = pose.joint[BONES], line = dot(tip, tip) > 1e-12 ? unit(tip) : u[0];
  float wanted = min(length(target), 0.99999), spread = 0.0, enough = 0.9 * tolerance, goal = inversesqrt(1.0 - wanted);
  for (int i = 0; i < BONES; ++i) {
    at.along[i] = dot(u[i], line);
    at.across[i] = u[i] - line * at.along[i];
    spread += dot(at.across[i], at.across[i]);
  }
  bool straight = BONES > 1 && spread < float(BONES) * 0.0004 * min(1.0, 100.0 * (1.0 - wanted));
  at.lambda = 0.0;
  at.low = -1e9;
  at.high = 1e9;
  at.done = false;
  if (steps > 0) {
    [[unroll]] for (int k = 0; k < steps; ++k) stretchStep(bone, wanted, goal, enough, k == 0, onward && k + 1 == steps, at);
  } else {
    vec3 w = acrossLine(line, pole);
    for (int i = 0; i < BONES; ++i) {
      vec3 bowed = at.across[i] + bow(i) * w;
      at.across[i] = straight ? bowed : at.across[i];
      at.along[i] = straight ? (at.along[i] < 0.0 ? -1.0 : 1.0) * sqrt(max(1.0 - dot(bowed, bowed), 0.0)) : at.along[i];
    }
    // The ninth only measures.
    for (int k = 0; k <= 8 && !at.done; ++k) {
      float lambda = at.lambda;
      stretchStep(bone, wanted, goal, enough, false, onward, at);
      at.lambda = k == 8 && !at.done ? lambda : at.lambda;
    }
  }
  Frame align = frameOf(shortestArc(unit(line * at.g + at.h), unit(target)));
  for (int i = 0; i < BONES; ++i) {
    vec3 v = at.across[i] + line * (at.along[i] + at.lambda);
    u[i] = rotate(align, dot(v, v) < 1e-12 ? u[i] : unit(v));
  }
  fromDirections(bone, u, pose);
  return steps == 0 || (at.done && !straight);
}

#endif
