#include "cpu_reference/clips/keyframes.h"

#include <algorithm>
#include <cmath>

namespace skitter::reference {
namespace {

using glm::dmat4;
using glm::dvec3;
using glm::dvec4;

dvec4 valueOf(const ClipChannel& channel, size_t key) {
  return channel.values[channel.interpolation == ClipInterpolation::cubicSpline ? 3 * key + 1 : key];
}

dvec4 slerp(const dvec4& from, dvec4 to, double u) {
  double cosine = glm::dot(from, to);
  if (cosine < 0) {
    to = -to;
    cosine = -cosine;
  }
  const double angle = std::acos(std::min(cosine, 1.0));
  if (angle < 1e-6) return glm::normalize((1 - u) * from + u * to);
  return (std::sin((1 - u) * angle) * from + std::sin(u * angle) * to) / std::sin(angle);
}

// Between key k and the next.
dvec4 between(const ClipChannel& channel, size_t k, double t) {
  const double d = channel.times[k + 1] - channel.times[k], u = (t - channel.times[k]) / d;
  const dvec4 from = valueOf(channel, k), to = valueOf(channel, k + 1);
  switch (channel.interpolation) {
    case ClipInterpolation::step:
      return from;
    case ClipInterpolation::linear:
      return channel.property == ClipProperty::rotation ? slerp(from, to, u) : (1 - u) * from + u * to;
    case ClipInterpolation::cubicSpline:
      break;
  }
  const dvec4 out = channel.values[3 * k + 2], in = channel.values[3 * (k + 1)];
  const double u2 = u * u, u3 = u2 * u;
  const dvec4 v = (2 * u3 - 3 * u2 + 1) * from + d * (u3 - 2 * u2 + u) * out + (3 * u2 - 2 * u3) * to +
                  d * (u3 - u2) * in;
  return channel.property == ClipProperty::rotation && glm::length(v) < 1e-9 ? from : v;
}

dmat4 rotationMatrix(const dvec4& q) {
  const double x = q.x, y = q.y, z = q.z, w = q.w;
  return {1 - 2 * (y * y + z * z),
          2 * (x * y + z * w),
          2 * (x * z - y * w),
          0,
          2 * (x * y - z * w),
          1 - 2 * (x * x + z * z),
          2 * (y * z + x * w),
          0,
          2 * (x * z + y * w),
          2 * (y * z - x * w),
          1 - 2 * (x * x + y * y),
          0,
          0,
          0,
          0,
          1};
}

dmat4 localMatrix(const dvec3& t, const dvec4& r, const dvec3& s) {
  dmat4 m = rotationMatrix(r);
  for (int column = 0; column < 3; ++column) m[column] *= s[column];
  m[3] = dvec4(t, 1);
  return m;
}

}  // namespace

dvec4 sampleChannel(const ClipChannel& channel, double t, ClipSide side) {
  const std::vector<double>& times = channel.times;
  // The key whose stretch t is in: the last at t or before; from the left, the last before t.
  const auto after = side == ClipSide::at ? std::upper_bound(times.begin(), times.end(), t)
                                          : std::lower_bound(times.begin(), times.end(), t);
  dvec4 value;
  if (after == times.begin())
    value = valueOf(channel, 0);
  else if (after == times.end())
    value = valueOf(channel, times.size() - 1);
  else
    value = between(channel, static_cast<size_t>(after - times.begin()) - 1, t);
  return channel.property == ClipProperty::rotation ? glm::normalize(value) : value;
}

double clipSeconds(const std::vector<ClipChannel>& channels) {
  double seconds = 0;
  for (const ClipChannel& channel : channels) seconds = std::max(seconds, channel.times.back());
  return seconds;
}

std::vector<dmat4> clipPose(const std::vector<ClipNode>& nodes, const std::vector<ClipChannel>& channels,
                            double t, ClipSide side) {
  std::vector<ClipNode> posed = nodes;
  // In order: of two channels of one property the later counts.
  for (const ClipChannel& channel : channels) {
    ClipNode& node = posed[static_cast<size_t>(channel.node)];
    const dvec4 value = sampleChannel(channel, t, side);
    if (channel.property == ClipProperty::translation) node.translation = value;
    if (channel.property == ClipProperty::rotation) node.rotation = value;
    if (channel.property == ClipProperty::scale) node.scale = value;
  }
  std::vector<dmat4> global(nodes.size());
  for (const int n : clipTreeOrder(nodes)) {
    const ClipNode& node = posed[static_cast<size_t>(n)];
    const dmat4 local = node.matrix ? *node.matrix : localMatrix(node.translation, node.rotation, node.scale);
    global[static_cast<size_t>(n)] =
        node.parent < 0 ? local : global[static_cast<size_t>(node.parent)] * local;
  }
  return global;
}

std::vector<int> clipTreeOrder(const std::vector<ClipNode>& nodes) {
  std::vector<int> order;
  for (size_t n = 0; n < nodes.size(); ++n)
    if (nodes[n].parent < 0) order.push_back(static_cast<int>(n));
  for (size_t done = 0; done < order.size(); ++done) {
    const int parent = order[done];
    for (size_t n = 0; n < nodes.size(); ++n)
      if (nodes[n].parent == parent) order.push_back(static_cast<int>(n));
  }
  return order;
}

int clipRoot(const std::vector<ClipNode>& nodes, const std::vector<ClipChannel>& channels,
             const std::vector<double>& skinWeight, const std::vector<int>& legJoints) {
  const std::vector<int> order = clipTreeOrder(nodes);
  const auto parentOf = [&](int n) { return nodes[static_cast<size_t>(n)].parent; };
  std::vector<double> below = skinWeight;
  double whole = 0;
  for (const double weight : skinWeight) whole += weight;
  for (auto n = order.rbegin(); n != order.rend(); ++n)
    if (parentOf(*n) >= 0) below[static_cast<size_t>(parentOf(*n))] += below[static_cast<size_t>(*n)];
  const auto isOfLeg = [&](int n) {
    for (; n >= 0; n = parentOf(n))
      if (std::find(legJoints.begin(), legJoints.end(), n) != legJoints.end()) return true;
    return false;
  };
  const auto moves = [&](int n) {
    return !nodes[static_cast<size_t>(n)].matrix &&
           std::any_of(channels.begin(), channels.end(), [&](const ClipChannel& channel) {
             return channel.node == n && channel.property == ClipProperty::translation;
           });
  };
  // Breadth first, so the highest comes first; two that carry over half each cannot be beside one another.
  for (const int n : order)
    if (moves(n) && !isOfLeg(n) && below[static_cast<size_t>(n)] > whole / 2) return n;
  return -1;
}

dvec3 clipRootVelocity(const std::vector<ClipNode>& nodes, const std::vector<ClipChannel>& channels, int root,
                       const dmat4& modelFromFile) {
  const double seconds = clipSeconds(channels);
  if (root < 0 || seconds == 0) return dvec3(0);
  const auto placeAt = [&](double t) {
    return dvec3((modelFromFile * clipPose(nodes, channels, t)[static_cast<size_t>(root)])[3]);
  };
  dvec3 velocity = (placeAt(seconds) - placeAt(0)) / seconds;
  velocity.y = 0;
  return velocity;
}

std::vector<dmat4> crossFade(const std::vector<dmat4>& from, const std::vector<dmat4>& to, double w) {
  std::vector<dmat4> result;
  for (size_t e = 0; e < from.size(); ++e) result.push_back((1 - w) * from[e] + w * to[e]);
  return result;
}

std::vector<dmat4> playFrames(const ClipFrames& frames, double phase) {
  size_t f = 0;
  while (f + 1 < frames.times.size() && frames.times[f + 1] <= phase) ++f;
  if (f + 1 == frames.times.size()) return frames.matrices[f];
  const double u = (phase - frames.times[f]) / (frames.times[f + 1] - frames.times[f]);
  return crossFade(frames.matrices[f], frames.matrices[f + 1], u);
}

}  // namespace skitter::reference
