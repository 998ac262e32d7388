#include "assets/models/clip_sampler.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace skitter {
namespace {

using gltf::Interpolation;
using gltf::Path;
using gltf::Sampler;

template <typename Value>
Value valueAt(const Sampler& sampler, size_t index) {
  const double* at = sampler.values.data() + index * static_cast<size_t>(Value::length());
  Value value;
  for (int k = 0; k < Value::length(); ++k) value[k] = at[k];
  return value;
}

// The keys around a time: at `key` + `u`, 0 <= u <= 1, towards the next, `seconds` later.
struct Between {
  size_t key = 0;
  double u = 0, seconds = 0;
};

Between placeOf(const std::vector<double>& times, double time, Side side) {
  const auto next = side == Side::at ? std::upper_bound(times.begin(), times.end(), time)
                                     : std::lower_bound(times.begin(), times.end(), time);
  if (next == times.begin()) return {};
  const auto key = static_cast<size_t>(next - times.begin()) - 1;
  if (next == times.end()) return {key, 0, 0};
  const double seconds = *next - times[key];
  return {key, (time - times[key]) / seconds, seconds};
}

template <typename Value>
Value spline(const Sampler& sampler, const Between& place) {
  const size_t k = 3 * place.key;
  const auto v = valueAt<Value>(sampler, k + 1);
  if (place.seconds <= 0) return v;
  const double u = place.u, d = place.seconds, u2 = u * u, u3 = u2 * u;
  return v * (2 * u3 - 3 * u2 + 1) + valueAt<Value>(sampler, k + 2) * (d * (u3 - 2 * u2 + u)) +
         valueAt<Value>(sampler, k + 4) * (3 * u2 - 2 * u3) +
         valueAt<Value>(sampler, k + 3) * (d * (u3 - u2));
}

glm::dquat rotationOf(const glm::dvec4& xyzw) {
  const double length = glm::length(xyzw);
  return {xyzw.w / length, xyzw.x / length, xyzw.y / length, xyzw.z / length};
}

// Along the shorter arc.
glm::dvec4 slerp(const glm::dvec4& from, glm::dvec4 to, double u) {
  double cosine = glm::dot(from, to);
  if (cosine < 0) {
    to = -to;
    cosine = -cosine;
  }
  const double angle = std::acos(std::min(cosine, 1.0));
  if (angle < 1e-6) return from * (1 - u) + to * u;
  return (from * std::sin((1 - u) * angle) + to * std::sin(u * angle)) / std::sin(angle);
}

std::vector<double> eachOnce(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

}  // namespace

glm::dvec3 sampleVector(const Sampler& sampler, double time, Side side) {
  const Between place = placeOf(sampler.times, time, side);
  if (sampler.interpolation == Interpolation::cubicSpline) return spline<glm::dvec3>(sampler, place);
  const auto value = valueAt<glm::dvec3>(sampler, place.key);
  if (sampler.interpolation == Interpolation::step || place.u <= 0) return value;
  return value * (1 - place.u) + valueAt<glm::dvec3>(sampler, place.key + 1) * place.u;
}

glm::dquat sampleRotation(const Sampler& sampler, double time, Side side) {
  const Between place = placeOf(sampler.times, time, side);
  if (sampler.interpolation == Interpolation::cubicSpline) {
    const auto value = spline<glm::dvec4>(sampler, place);
    return rotationOf(glm::length(value) < 1e-9 ? valueAt<glm::dvec4>(sampler, 3 * place.key + 1) : value);
  }
  const auto value = valueAt<glm::dvec4>(sampler, place.key);
  if (sampler.interpolation == Interpolation::step || place.u <= 0) return rotationOf(value);
  return rotationOf(slerp(value, valueAt<glm::dvec4>(sampler, place.key + 1), place.u));
}

ClipSampler::ClipSampler(const gltf::Document& document, const gltf::Clip& clip, std::span<const int> nodes,
                         const glm::dmat4& worldFromModel)
    : document_(document),
      channels_(document.nodes.size()),
      moving_(document.nodes.size(), false),
      worldFromModel_(worldFromModel),
      worldFromNode_(document.nodes.size(), glm::dmat4(1)) {
  std::vector<bool> matters(document.nodes.size(), false);
  for (const int node : nodes) matters[static_cast<size_t>(node)] = true;
  for (const gltf::Channel& channel : clip.moving) {
    const auto node = static_cast<size_t>(channel.node);
    if (!matters[node]) continue;
    const Sampler& sampler = clip.samplers[channel.sampler];
    channels_[node][static_cast<size_t>(sampler.path)] = &sampler;
    moving_[node] = true;
  }
  for (const int i : nodes) {
    const auto n = static_cast<size_t>(i);
    const int parent = document.nodes[n].parent;
    if (parent != -1 && moving_[static_cast<size_t>(parent)]) moving_[n] = true;
    if (moving_[n]) order_.push_back(i);
    worldFromNode_[n] = worldFromModel * document.nodes[n].modelFromNode;
  }
}

const std::vector<glm::dmat4>& ClipSampler::sample(double time, Side side) {
  for (const int i : order_) {
    const auto n = static_cast<size_t>(i);
    const gltf::Node& node = document_.nodes[n];
    const Channels& channels = channels_[n];
    glm::dmat4 local = node.parentFromNode;
    if (channels[1] || channels[2]) {
      const glm::dquat rotation = channels[1] ? sampleRotation(*channels[1], time, side) : node.rotation;
      const glm::dvec3 scale = channels[2] ? sampleVector(*channels[2], time, side) : node.scale;
      const glm::dmat3 turn = glm::mat3_cast(rotation);
      for (int k = 0; k < 3; ++k) local[k] = glm::dvec4(turn[k] * scale[k], 0);
    }
    if (channels[0]) local[3] = glm::dvec4(sampleVector(*channels[0], time, side), 1);
    worldFromNode_[n] =
        (node.parent == -1 ? worldFromModel_ : worldFromNode_[static_cast<size_t>(node.parent)]) * local;
  }
  return worldFromNode_;
}

// Those of the nodes that move, each once however many channels share it.
std::vector<const Sampler*> ClipSampler::samplers() const {
  std::vector<const Sampler*> found;
  for (const int node : order_) {
    for (const Sampler* sampler : channels_[static_cast<size_t>(node)].paths) {
      if (sampler) found.push_back(sampler);
    }
  }
  std::sort(found.begin(), found.end(), std::less<>());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<double> ClipSampler::keyTimes() const {
  std::vector<double> times;
  for (const Sampler* sampler : samplers()) {
    times.insert(times.end(), sampler->times.begin(), sampler->times.end());
  }
  return eachOnce(std::move(times));
}

std::vector<double> ClipSampler::jumpTimes() const {
  std::vector<double> times;
  for (const Sampler* sampler : samplers()) {
    if (sampler->interpolation != Interpolation::step) continue;
    const size_t width = sampler->path == Path::rotation ? 4 : 3;
    for (size_t k = 1; k < sampler->times.size(); ++k) {
      const auto value = sampler->values.begin() + static_cast<std::ptrdiff_t>(k * width);
      const auto before = value - static_cast<std::ptrdiff_t>(width);
      if (!std::equal(before, value, value)) times.push_back(sampler->times[k]);
    }
  }
  return eachOnce(std::move(times));
}

}  // namespace skitter
