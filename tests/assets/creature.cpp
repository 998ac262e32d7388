#include "creature.h"

#include <cmath>

namespace skitter::test {
namespace {

std::vector<float> floats(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

std::vector<float> floats(const glm::dquat& q) {
  return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w)};
}

template <typename Value>
void extend(std::vector<float>& to, const Value& value) {
  const std::vector<float> more = floats(value);
  to.insert(to.end(), more.begin(), more.end());
}

// Where a joint is, seen from its parent.
struct Local {
  glm::dvec3 place;
  glm::dquat turn;
};

// Whether any of the keys is not the value at rest.
bool moves(const std::vector<float>& keys, const std::vector<float>& rest) {
  for (size_t k = 0; k < keys.size(); ++k) {
    if (std::fabs(keys[k] - rest[k % rest.size()]) > 1e-6f) return true;
  }
  return false;
}

}  // namespace

glm::dquat arc(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 a = glm::normalize(from), b = glm::normalize(to);
  if (glm::dot(a, b) < -0.999999)
    return {0, 1, 0, 0};  // half a turn about x; +Y is the only `from` that meets it
  const glm::dvec3 axis = glm::cross(a, b);
  return glm::normalize(glm::dquat(1 + glm::dot(a, b), axis.x, axis.y, axis.z));
}

Pose::Pose(const Creature& creature) : creature_(creature) {
  for (const Creature::Joint& joint : creature.joints()) places.push_back(joint.at);
  turns.assign(places.size(), glm::dquat(1, 0, 0, 0));
  scales.assign(places.size(), 1);
}

bool Pose::below(size_t joint, size_t ancestor) const {
  while (joint != ancestor) {
    const int parent = creature_.joints()[joint].parent;
    if (parent == -1) return false;
    joint = static_cast<size_t>(parent);
  }
  return true;
}

void Pose::turn(size_t joint, const glm::dquat& by) {
  const glm::dvec3 about = places[joint];
  for (size_t j = 0; j < places.size(); ++j) {
    if (!below(j, joint)) continue;
    places[j] = about + by * (places[j] - about);
    turns[j] = by * turns[j];
  }
}

void Pose::move(size_t joint, const glm::dvec3& by) {
  for (size_t j = 0; j < places.size(); ++j) {
    if (below(j, joint)) places[j] += by;
  }
}

void Pose::reach(size_t root, const glm::dvec3& target) {
  const size_t knee = root + 1, end = root + 2;
  const double upper = glm::length(places[knee] - places[root]),
               lower = glm::length(places[end] - places[knee]);
  const glm::dvec3 way = target - places[root], bent = places[knee] - places[root];
  const double far = std::min(glm::length(way), 0.9999 * (upper + lower));
  const glm::dvec3 along = glm::normalize(way);
  const glm::dvec3 off = glm::normalize(bent - along * glm::dot(bent, along));
  const double share = (far * far + upper * upper - lower * lower) / (2 * far);
  turn(root, arc(bent, along * share + off * std::sqrt(upper * upper - share * share)));
  turn(knee, arc(places[end] - places[knee], places[root] + along * far - places[knee]));
  turn(end, glm::inverse(turns[end]));
}

size_t Creature::joint(const std::string& name, int parent, const glm::dvec3& at, const glm::dvec3& end,
                       double radius) {
  joints_.push_back({name, parent, at, end, radius});
  return joints_.size() - 1;
}

size_t Creature::limb(const std::vector<std::string>& names, int parent,
                      const std::vector<glm::dvec3>& points, double radius) {
  const size_t root = joints_.size();
  for (size_t k = 0; k < names.size(); ++k) {
    joint(names[k], k == 0 ? parent : static_cast<int>(joints_.size()) - 1, points[k], points[k + 1], radius);
  }
  return root;
}

void Creature::clip(const std::string& name, double seconds, size_t keys, const Motion& motion,
                    bool allChannels) {
  Clip clip{name, {}, {}, allChannels};
  for (size_t k = 0; k < keys; ++k) {
    const double time = seconds * static_cast<double>(k) / static_cast<double>(keys - 1);
    clip.times.push_back(static_cast<float>(time));
    clip.poses.emplace_back(*this);
    motion(clip.poses.back(), time);
  }
  clips_.push_back(std::move(clip));
}

glm::dquat Creature::turnAtRest(size_t joint) const {
  const glm::dvec3 bone = joints_[joint].end - joints_[joint].at;
  return glm::length(bone) > 0 ? arc({0, 1, 0}, bone) : glm::dquat(1, 0, 0, 0);
}

glm::dquat Creature::armature() const {
  return zUp ? glm::angleAxis(glm::radians(-90.0), glm::dvec3(1, 0, 0)) : glm::dquat(1, 0, 0, 0);
}

Glb Creature::glb() const {
  Glb glb;
  glb.json = {{"asset", {{"version", "2.0"}}}, {"buffers", {{{"byteLength", 0}}}}};
  addNodes(glb);
  addSkin(glb);
  for (const Clip& clip : clips_) addClip(glb, clip);
  return glb;
}

namespace {

Local localOf(const Creature& creature, const Pose& pose, const std::vector<glm::dquat>& rest, size_t joint,
              const glm::dquat& armature) {
  const int parent = creature.joints()[joint].parent;
  const glm::dquat turn = pose.turns[joint] * rest[joint];
  if (parent == -1) return {glm::inverse(armature) * pose.places[joint], glm::inverse(armature) * turn};
  const auto p = static_cast<size_t>(parent);
  const glm::dquat back = glm::inverse(pose.turns[p] * rest[p]);
  return {back * (pose.places[joint] - pose.places[p]), back * turn};
}

}  // namespace

// The joints, the mesh and the armature, in this order.
void Creature::addNodes(Glb& glb) const {
  const Pose pose(*this);
  std::vector<glm::dquat> rest;
  for (size_t j = 0; j < joints_.size(); ++j) rest.push_back(turnAtRest(j));
  auto& nodes = glb.json["nodes"];
  const size_t mesh = joints_.size();
  nlohmann::json top = {{"name", "Armature"}, {"children", {mesh}}};
  for (size_t j = 0; j < mesh; ++j) {
    const Local local = localOf(*this, pose, rest, j, armature());
    nodes.push_back({{"translation", floats(local.place)}, {"rotation", floats(local.turn)}});
    if (named) nodes[j]["name"] = joints_[j].name;
    const int parent = joints_[j].parent;
    (parent == -1 ? top : nodes[static_cast<size_t>(parent)])["children"].push_back(j);
  }
  if (zUp) top["matrix"] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
  nodes.push_back({{"name", meshName}, {"mesh", 0}, {"skin", 0}});
  nodes.push_back(std::move(top));
  glb.json["scenes"] = {{{"nodes", {mesh + 1}}}};
  glb.json["scene"] = 0;
}

// A box a bone. The ring at its beginning follows the joint before it by half.
void Creature::addSkin(Glb& glb) const {
  std::vector<float> positions, weights, bind;
  std::vector<uint8_t> influences;
  std::vector<uint16_t> indices, joints;
  for (size_t j = 0; j < joints_.size(); ++j) {
    const Joint& joint = joints_[j];
    const glm::dquat turn = turnAtRest(j);
    const glm::dmat4 inverse = glm::inverse(glm::translate(glm::dmat4(1), joint.at) * glm::mat4_cast(turn));
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 4; ++row) bind.push_back(static_cast<float>(inverse[column][row]));
    }
    joints.push_back(static_cast<uint16_t>(j));
    if (joint.radius == 0) continue;
    const auto first = static_cast<uint16_t>(positions.size() / 3);
    for (const bool far : {false, true}) {
      for (const auto& [x, z] : {std::pair(1, 1), std::pair(1, -1), std::pair(-1, -1), std::pair(-1, 1)}) {
        extend(positions, (far ? joint.end : joint.at) + turn * (joint.radius * glm::dvec3(x, 0, z)));
        const bool shared = !far && joint.parent != -1;
        const double sum = x > 0 ? weightSum : 1;
        const auto own = static_cast<uint8_t>(j);
        influences.insert(influences.end(), {own, shared ? static_cast<uint8_t>(joint.parent) : own, 0, 0});
        const auto share = static_cast<float>(sum * (shared ? 0.5 : 1));
        weights.insert(weights.end(), {share, shared ? share : 0.0f, 0, 0});
      }
    }
    for (uint16_t i = 0; i < 4; ++i) {
      const auto a = static_cast<uint16_t>(first + i), b = static_cast<uint16_t>(first + (i + 1) % 4);
      for (const int corner : {int{a}, int{b}, b + 4, int{a}, b + 4, a + 4})
        indices.push_back(static_cast<uint16_t>(corner));
    }
    for (const int corner : {0, 3, 2, 0, 2, 1, 4, 5, 6, 4, 6, 7})
      indices.push_back(static_cast<uint16_t>(first + corner));
  }
  nlohmann::json primitive;
  if (!indexed) {
    const auto unrolled = [&](const auto& values, size_t width) {
      std::remove_cvref_t<decltype(values)> all;
      for (const uint16_t index : indices) {
        const auto at = values.begin() + static_cast<std::ptrdiff_t>(width * index);
        all.insert(all.end(), at, at + static_cast<std::ptrdiff_t>(width));
      }
      return all;
    };
    positions = unrolled(positions, 3);
    influences = unrolled(influences, 4);
    weights = unrolled(weights, 4);
  } else {
    primitive["indices"] = glb.append(indices, "SCALAR");
  }
  primitive["attributes"] = {{"POSITION", glb.append(positions, "VEC3")},
                             {"JOINTS_0", glb.append(influences, "VEC4")},
                             {"WEIGHTS_0", glb.append(weights, "VEC4")}};
  glb.json["meshes"] = {{{"primitives", {primitive}}}};
  glb.json["skins"] = {{{"joints", joints}, {"inverseBindMatrices", glb.append(bind, "MAT4")}}};
}

void Creature::addClip(Glb& glb, const Clip& clip) const {
  glb.json["animations"].push_back({{"name", clip.name}});
  std::vector<glm::dquat> rest;
  for (size_t j = 0; j < joints_.size(); ++j) rest.push_back(turnAtRest(j));
  const Pose still(*this);
  for (size_t j = 0; j < joints_.size(); ++j) {
    const Local unmoved = localOf(*this, still, rest, j, armature());
    std::vector<float> places, turns, scales;
    glm::dquat before = unmoved.turn;
    for (const Pose& pose : clip.poses) {
      Local local = localOf(*this, pose, rest, j, armature());
      // Both signs are the same turn.
      if (glm::dot(local.turn, before) < 0) local.turn = -local.turn;
      before = local.turn;
      extend(places, local.place);
      extend(turns, local.turn);
      extend(scales, glm::dvec3(pose.scales[j]));
    }
    const auto animate = [&](const char* path, const std::vector<float>& keys,
                             const std::vector<float>& atRest) {
      if (clip.allChannels || moves(keys, atRest)) glb.animate(j, path, "LINEAR", clip.times, keys);
    };
    animate("translation", places, floats(unmoved.place));
    animate("rotation", turns, floats(unmoved.turn));
    animate("scale", scales, {1, 1, 1});
  }
}

}  // namespace skitter::test
