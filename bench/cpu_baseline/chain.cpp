#include "bench/cpu_baseline/chain.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace skitter::baseline {
namespace {

using DVec = Vec3<double>;
using DMat = Mat3<double>;

constexpr double kFreeLimit = 3.1;

DVec unit(const DVec& v) { return v * (1 / std::sqrt(std::max(dot(v, v), 1e-20))); }
DVec vector(const std::array<float, 3>& v) { return unit({v[0], v[1], v[2]}); }

DMat product(const DMat& a, const DMat& b) { return {a * b.x, a * b.y, a * b.z}; }
DMat transposed(const DMat& m) {
  return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
Vec3<float> narrowed(const DVec& v) { return {float(v.x), float(v.y), float(v.z)}; }
Mat3<float> narrowed(const DMat& m) { return {narrowed(m.x), narrowed(m.y), narrowed(m.z)}; }

// shortest(Z, d): the swing.
DMat swing(const DVec& d) {
  const double k = 1 / std::max(1 + d.z, 1e-12);
  return {{1 - k * d.x * d.x, -k * d.x * d.y, -d.x}, {-k * d.x * d.y, 1 - k * d.y * d.y, -d.y}, d};
}
DMat turnAboutZ(double angle) {
  return {{std::cos(angle), std::sin(angle), 0}, {-std::sin(angle), std::cos(angle), 0}, {0, 0, 1}};
}

// B_i and the hinge's c_i.
struct RestFrame {
  DMat frame;
  double along = 0;
};

RestFrame restFrame(const Bone& bone) {
  const DVec r = vector(bone.rest);
  if (bone.limit.kind == LimitKind::hinge) {
    const DVec x = vector(bone.limit.axis);
    const double along = dot(x, r);
    const DVec z = unit(r - x * along);
    return {{x, cross(z, x), z}, along};
  }
  const DVec carried = r.z < -0.999999 ? DVec{1, 0, 0} : swing(r).x;
  const DVec x = unit(carried - r * dot(carried, r));
  return {{x, cross(r, x), r}, 0};
}

double totalLength(const Chain& chain) {
  double total = 0;
  for (const Bone& bone : chain.bones) total += bone.length;
  return total;
}

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

double ellipseAngle(const Limit& limit, double hx, double hy) {
  return 1 / std::hypot(hx / (hx >= 0 ? limit.positiveX : limit.negativeX),
                        hy / (hy >= 0 ? limit.positiveY : limit.negativeY));
}

double widest(const Limit& limit) {
  if (limit.kind == LimitKind::cone) return limit.cone;
  if (limit.kind == LimitKind::free) return kFreeLimit;
  return std::max({limit.positiveX, limit.negativeX, limit.positiveY, limit.negativeY});
}

void refuseUnless(bool fine, const char* what) {
  if (!fine) throw std::invalid_argument(what);
}

BoneModel boneModel(const Bone& bone, const DMat& previous, double total) {
  const Limit& limit = bone.limit;
  const RestFrame rest = restFrame(bone);
  BoneModel model;
  model.length = float(bone.length / total);
  model.turns = bone.length > 0;
  model.kind = limit.kind;
  model.carry = narrowed(product(transposed(previous), rest.frame));
  if (limit.kind == LimitKind::hinge) {
    refuseUnless(std::abs(rest.along) <= 0.999, "hinge: the bone lies on its axis");
    refuseUnless(limit.low <= limit.high && limit.low >= -3.1f && limit.high <= 3.1f,
                 "hinge: the range must be within -3.1 .. 3.1");
    model.offsetX = float(rest.along);
    model.offsetZ = float(std::sqrt(1 - rest.along * rest.along));
    model.lowSine = std::sin(limit.low), model.lowCosine = std::cos(limit.low);
    model.highSine = std::sin(limit.high), model.highCosine = std::cos(limit.high);
    model.wide = limit.low < -1.5f || limit.high > 1.5f;
    model.lowTanHalf = std::tan(limit.low / 2), model.highTanHalf = std::tan(limit.high / 2);
    return model;
  }
  refuseUnless(limit.cone > 0, "cone: the angle must be above 0");
  const double cone = limit.kind == LimitKind::cone ? std::min(double(limit.cone), kFreeLimit) : kFreeLimit;
  model.coneSine = float(std::sin(cone)), model.coneCosine = float(std::cos(cone));
  model.coneTanHalf = float(std::tan(cone / 2));
  model.wide = widest(limit) > 1.5;
  for (float angle : {limit.positiveX, limit.negativeX, limit.positiveY, limit.negativeY}) {
    refuseUnless(angle > 0 && angle <= 3.1f, "ellipse: the angles must be above 0, at most 3.1");
  }
  model.inversePositiveX = 1 / limit.positiveX, model.inverseNegativeX = 1 / limit.negativeX;
  model.inversePositiveY = 1 / limit.positiveY, model.inverseNegativeY = 1 / limit.negativeY;
  refuseUnless(limit.twistLow <= limit.twistHigh && limit.twistLow >= -3.1f && limit.twistHigh <= 3.1f,
               "twist: the range must be within -3.1 .. 3.1");
  model.twists = limit.twistLow != 0 || limit.twistHigh != 0;
  model.twistLowTanHalf = std::tan(limit.twistLow / 2);
  model.twistHighTanHalf = std::tan(limit.twistHigh / 2);
  return model;
}

// The start poses of restarts: of 1024 random legal poses pulled 30 % to rest, those whose tips are farthest
// from the tips already chosen.
void pickSeeds(const Chain& chain, Model& model) {
  constexpr int kPoses = 1024;
  std::mt19937 random(1);
  std::vector<Pose> poses;
  std::vector<std::vector<DVec>> joints;
  // For shapes, only the length matters.
  const auto compared = [&](const DVec& p) { return model.aimed ? DVec{std::sqrt(dot(p, p)), 0, 0} : p; };
  for (int i = 0; i < kPoses; ++i) {
    poses.push_back(randomPose(chain, random, 0.7));
    if (model.aimed) poses.back().x[0] = poses.back().y[0] = 0;
    joints.push_back(jointsOf(chain, poses.back()));
  }
  const Vec3<float> rest = model.restJoints[model.bones - 1];
  DVec last = compared({rest.x, rest.y, rest.z});
  std::vector<double> distance(kPoses, 1e9);
  model.seedRows = Rows(7 * model.bones, Model::kSeeds);
  for (model.seeds = 0; model.seeds < Model::kSeeds; ++model.seeds) {
    for (int i = 0; i < kPoses; ++i) {
      const DVec gap = compared(joints[i].back()) - last;
      distance[i] = std::min(distance[i], dot(gap, gap));
    }
    const auto farthest = std::max_element(distance.begin(), distance.end());
    if (*farthest < 1e-12) break;
    const size_t pick = farthest - distance.begin();
    last = compared(joints[pick].back());
    for (int b = 0; b < model.bones; ++b) {
      const float row[6] = {float(joints[pick][b].x), float(joints[pick][b].y), float(joints[pick][b].z),
                            poses[pick].x[b],         poses[pick].y[b],         poses[pick].twist[b]};
      for (int k = 0; k < 3; ++k) {
        model.seedRows.at(3 * b + k, model.seeds) = row[k];
        model.seedRows.at(3 * (model.bones + b) + k, model.seeds) = row[3 + k];
      }
      model.seedRows.at(6 * model.bones + b, model.seeds) =
          float(std::sqrt(dot(joints[pick][b], joints[pick][b])));
    }
  }
}

// The seed whose tip is nearest, or -1 if all are as far as `least` (squared).
int nearestSeed(const Model& model, const Vec3<float>& at, float least) {
  const int tip = model.bones - 1;
  int nearest = -1;
  for (int s = 0; s < model.seeds; ++s) {
    const Vec3<float> place{model.seedRows.at(3 * tip, s), model.seedRows.at(3 * tip + 1, s),
                            model.seedRows.at(3 * tip + 2, s)};
    const float length = model.seedRows.at(6 * model.bones + tip, s);
    const Vec3<float> gap = (model.aimed ? Vec3<float>{length, 0, 0} : place) - at;
    if (dot(gap, gap) < least) least = dot(gap, gap), nearest = s;
  }
  return nearest;
}

void fillCells(Model& model) {
  constexpr int n = Model::kCells, shells = n * n * n;
  const auto middle = [](int i) { return (i + 0.5f) * 2 / n - 1; };
  for (int cell = 0; cell < shells; ++cell) {
    const Vec3<float> at{middle(cell % n), middle(cell / n % n), middle(cell / (n * n))};
    const Vec3<float> rest = at - model.restJoints[model.bones - 1];
    model.seedCells.push_back(int8_t(model.aimed ? nearestSeed(model, {(cell + 0.5f) / shells, 0, 0}, 1e9f)
                                                 : nearestSeed(model, at, dot(rest, rest))));
  }
}

}  // namespace

Chain bentChain(int bones, const Limit& limit) {
  Chain chain;
  for (int i = 0; i < bones; ++i) {
    const double angle = (60 - 140.0 * i / std::max(bones - 1, 1)) * std::numbers::pi / 180;
    chain.bones.push_back({1.0f / bones, {float(std::cos(angle)), float(std::sin(angle)), 0}, limit});
  }
  return chain;
}

Model::Model(const Chain& chain) : bones(int(chain.bones.size())) {
  refuseUnless(bones <= kMaxBones, "a chain has at most 15 bones");
  if (bones == 0) return;
  const double total = totalLength(chain);
  refuseUnless(total > 0, "a chain has a length");
  DMat previous{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  DVec joint{0, 0, 0};
  for (int i = 0; i < bones; ++i) {
    const Bone& source = chain.bones[i];
    bone[i] = boneModel(source, previous, total);
    limited = limited || source.limit.kind != LimitKind::free || bone[i].twists;
    previous = restFrame(source).frame;
    restDirections[i] = vector(source.rest);
    joint = joint + restDirections[i] * (source.length / total);
    restJoints[i] = narrowed(joint);
  }
  if (limited) {
    aimed = bone[0].kind == LimitKind::free && bone[0].turns;
    pickSeeds(chain, *this);
    fillCells(*this);
  }
}

Pose randomPose(const Chain& chain, std::mt19937& random, double share) {
  Pose pose;
  for (size_t i = 0; i < chain.bones.size(); ++i) {
    const Limit& limit = chain.bones[i].limit;
    if (!(chain.bones[i].length > 0)) continue;
    if (limit.kind == LimitKind::hinge) {
      const double q =
          std::clamp(share * uniform(random, limit.low, limit.high), double(limit.low), double(limit.high));
      pose.y[i] = float(-std::tan(q / 2));
      continue;
    }
    const double turn = uniform(random, 0, 2 * std::numbers::pi), hx = std::cos(turn), hy = std::sin(turn);
    const double cone = limit.kind == LimitKind::cone ? std::min(double(limit.cone), kFreeLimit) : kFreeLimit;
    const double most = limit.kind == LimitKind::ellipse ? ellipseAngle(limit, hx, hy) : cone;
    // Evenly over the solid angle of the cone.
    const double theta = (limit.kind == LimitKind::free ? 1 : share) *
                         std::acos(1 - uniform(random, 0, 1) * (1 - std::cos(most)));
    pose.x[i] = float(hx * std::tan(theta / 2));
    pose.y[i] = float(hy * std::tan(theta / 2));
    pose.twist[i] = float(std::tan(std::clamp(share * uniform(random, limit.twistLow, limit.twistHigh),
                                              double(limit.twistLow), double(limit.twistHigh)) /
                                   2));
  }
  return pose;
}

std::vector<DVec> jointsOf(const Chain& chain, const Pose& pose) {
  const double total = totalLength(chain);
  std::vector<DVec> joints;
  DMat carried{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // F_(i-1) B_(i-1)^T
  DVec joint{0, 0, 0};
  for (size_t i = 0; i < chain.bones.size(); ++i) {
    const RestFrame rest = restFrame(chain.bones[i]);
    const double x = pose.x[i], y = pose.y[i], scale = 1 / (1 + x * x + y * y);
    const DVec d{2 * x * scale, 2 * y * scale, (1 - x * x - y * y) * scale};
    const DMat frame = product(product(carried, rest.frame),
                               product(swing(d), turnAboutZ(2 * std::atan(double(pose.twist[i])))));
    const DVec offset{rest.along, 0, std::sqrt(1 - rest.along * rest.along)};
    joint = joint + frame * offset * (chain.bones[i].length / total);
    joints.push_back(joint);
    carried = product(frame, transposed(rest.frame));
  }
  return joints;
}

}  // namespace skitter::baseline
