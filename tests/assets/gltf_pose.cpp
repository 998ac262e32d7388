#include "gltf_pose.h"

#include <algorithm>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <stdexcept>

namespace skitter::test {
namespace {

using Values = std::vector<double>;

// One component as its accessor's type says: a float, or a normalised integer.
double component(const uint8_t* bytes, int type) {
  const auto as = [&](auto number) {
    std::memcpy(&number, bytes, sizeof(number));
    return static_cast<double>(number);
  };
  switch (type) {
    case 5120:
      return std::max(as(int8_t{}) / 127, -1.0);
    case 5121:
      return as(uint8_t{}) / 255;
    case 5122:
      return std::max(as(int16_t{}) / 32767, -1.0);
    case 5123:
      return as(uint16_t{}) / 65535;
    case 5126:
      return as(float{});
    default:
      throw std::invalid_argument("component type " + std::to_string(type));
  }
}

Values part(const Values& values, size_t index, size_t width) {
  const auto first = values.begin() + static_cast<std::ptrdiff_t>(index * width);
  return {first, first + static_cast<std::ptrdiff_t>(width)};
}

Values mixed(const Values& a, const Values& b, double u) {
  Values result;
  for (size_t i = 0; i < a.size(); ++i) result.push_back(a[i] + u * (b[i] - a[i]));
  return result;
}

Values moved(const Values& a, const Values& b, double by) {
  Values result;
  for (size_t i = 0; i < a.size(); ++i) result.push_back(a[i] + by * b[i]);
  return result;
}

glm::dquat turnOf(const Values& v) { return glm::normalize(glm::dquat(v[3], v[0], v[1], v[2])); }

// Turns evenly about one axis, by the smaller of the two angles.
Values turned(const Values& a, const Values& b, double u) {
  glm::dquat between = glm::conjugate(turnOf(a)) * turnOf(b);
  if (between.w < 0) between = -between;
  const double angle = glm::angle(between);
  const glm::dquat q = angle > 0 ? turnOf(a) * glm::angleAxis(u * angle, glm::axis(between)) : turnOf(a);
  return {q.x, q.y, q.z, q.w};
}

// A cubic by its Bezier points (de Casteljau).
Values bezier(std::vector<Values> points, double u) {
  for (; points.size() > 1; points.pop_back())
    for (size_t i = 0; i + 1 < points.size(); ++i) points[i] = mixed(points[i], points[i + 1], u);
  return points[0];
}

}  // namespace

GltfPose::GltfPose(const Glb& glb) : glb_(glb), parents_(glb.json.at("nodes").size(), -1) {
  for (size_t node = 0; node < parents_.size(); ++node)
    for (const size_t child : glb_.json["nodes"][node].value("children", std::vector<size_t>()))
      parents_.at(child) = static_cast<int>(node);
}

Values GltfPose::numbers(size_t index) const {
  const nlohmann::json& accessor = glb_.json.at("accessors").at(index);
  const nlohmann::json& view = glb_.json.at("bufferViews").at(accessor.at("bufferView").get<size_t>());
  const std::string type = accessor.at("type");
  const size_t width = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
  const int kind = accessor.at("componentType");
  const size_t bytes = kind == 5126 ? 4 : kind < 5122 ? 1 : 2;
  const size_t stride = view.value("byteStride", width * bytes);
  const size_t begin = view.value("byteOffset", size_t{0}) + accessor.value("byteOffset", size_t{0});
  Values values;
  for (size_t i = 0; i < accessor.at("count").get<size_t>(); ++i)
    for (size_t k = 0; k < width; ++k)
      values.push_back(component(&glb_.binary.at(begin + i * stride + k * bytes), kind));
  return values;
}

Values GltfPose::sampled(const nlohmann::json& clip, size_t node, const char* path, double time) const {
  for (const nlohmann::json& channel : clip.at("channels")) {
    const nlohmann::json& target = channel.at("target");
    if (target.at("node") != node || target.at("path") != path) continue;
    const nlohmann::json& sampler = clip.at("samplers").at(channel.at("sampler").get<size_t>());
    const std::string kind = sampler.value("interpolation", "LINEAR");
    const Values times = numbers(sampler.at("input")), values = numbers(sampler.at("output"));
    const bool rotates = target.at("path") == "rotation", cubic = kind == "CUBICSPLINE";
    const size_t width = rotates ? 4 : 3;
    const auto value = [&](size_t key) { return part(values, cubic ? 3 * key + 1 : key, width); };
    if (time <= times.front()) return value(0);
    if (time >= times.back()) return value(times.size() - 1);
    size_t key = 0;
    while (times[key + 1] <= time) ++key;
    const double seconds = times[key + 1] - times[key], u = (time - times[key]) / seconds;
    if (kind == "STEP") return value(key);
    if (!cubic) return rotates ? turned(value(key), value(key + 1), u) : mixed(value(key), value(key + 1), u);
    const Values out = part(values, 3 * key + 2, width), in = part(values, 3 * key + 3, width);
    return bezier({value(key), moved(value(key), out, seconds / 3), moved(value(key + 1), in, -seconds / 3),
                   value(key + 1)},
                  u);
  }
  return {};
}

glm::dmat4 GltfPose::local(const nlohmann::json& clip, size_t index, double time) const {
  const nlohmann::json& node = glb_.json["nodes"][index];
  const auto property = [&](const char* path, const Values& otherwise) {
    const Values moving = sampled(clip, index, path, time);
    return moving.empty() ? node.value(path, otherwise) : moving;
  };
  const Values t = property("translation", {0, 0, 0}), r = property("rotation", {0, 0, 0, 1}),
               s = property("scale", {1, 1, 1});
  return glm::translate(glm::dmat4(1), glm::dvec3(t[0], t[1], t[2])) * glm::mat4_cast(turnOf(r)) *
         glm::scale(glm::dmat4(1), glm::dvec3(s[0], s[1], s[2]));
}

size_t GltfPose::indexOf(const std::string& node) const {
  for (size_t i = 0; i < parents_.size(); ++i)
    if (glb_.json["nodes"][i].value("name", "") == node) return i;
  throw std::out_of_range("no node '" + node + "'");
}

glm::dmat4 GltfPose::at(const std::string& clip, const std::string& node, double time) const {
  for (const nlohmann::json& animation : glb_.json.at("animations")) {
    if (animation.value("name", "") != clip) continue;
    glm::dmat4 matrix(1);
    for (int i = static_cast<int>(indexOf(node)); i != -1; i = parents_[static_cast<size_t>(i)])
      matrix = local(animation, static_cast<size_t>(i), time) * matrix;
    return matrix;
  }
  throw std::out_of_range("no clip '" + clip + "'");
}

glm::dmat4 GltfPose::inverseBind(const std::string& node) const {
  const nlohmann::json& skin = glb_.json.at("skins").at(0);
  const auto joints = skin.at("joints").get<std::vector<size_t>>();
  const auto place = std::find(joints.begin(), joints.end(), indexOf(node)) - joints.begin();
  const Values all = numbers(skin.at("inverseBindMatrices"));
  glm::dmat4 matrix;
  for (int k = 0; k < 16; ++k) matrix[k / 4][k % 4] = all.at(static_cast<size_t>(16 * place + k));
  return matrix;
}

}  // namespace skitter::test
