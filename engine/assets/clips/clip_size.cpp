#include "assets/clips/clip_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "assets/models/clip_sampler.h"

namespace skitter {
namespace {

// Creatures breathe, squash and stretch by less. Units differ by more: an inch is 2.54 cm.
constexpr double largestChange = 1.5;
// A root that is that much further from its parent than at rest, at the beginning, the middle and the end of
// a clip, is in another unit: a creature may well lie, jump or walk away.
constexpr double furthestRoot = 20;
// A size that varies by more while the clip plays is part of the motion.
constexpr double steady = 1.05;

bool differs(double ratio, double most) { return ratio > most || ratio * most < 1; }

double sizeOf(const glm::dmat4& matrix) { return std::cbrt(std::fabs(glm::determinant(glm::dmat3(matrix)))); }

double median(std::vector<double> values) {
  if (values.empty()) return 1;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// How many times as large as at rest the skin is, and how many times as far apart its nodes are.
struct Ratio {
  double size = 1, spread = 1;
};

class Comparison {
 public:
  Comparison(const gltf::Document& document, const ClipSkin& skin) : document_(document), skin_(skin) {
    std::vector<bool> moves(document.nodes.size(), false);
    for (const ClipSkin::Entry& entry : skin.entries) moves[static_cast<size_t>(entry.node)] = true;
    for (const int node : skin.nodes) {
      const int parent = document.nodes[static_cast<size_t>(node)].parent;
      if (moves[static_cast<size_t>(node)] && parent != -1 && moves[static_cast<size_t>(parent)])
        bones_.emplace_back(parent, node);
    }
  }

  // The ratio of the whole clip; none where the size differs between its begin, middle and end. Where only
  // the spread is not, nodes move along their bones, which is no matter of units.
  std::optional<Ratio> of(const gltf::Clip& clip) const {
    ClipSampler sampler(document_, clip, skin_.nodes, glm::dmat4(1));
    std::vector<Ratio> ratios;
    for (const double share : {0.0, 0.5, 1.0}) ratios.push_back(at(sampler.sample(share * clip.seconds)));
    Ratio found = ratios[0];
    for (const Ratio& ratio : ratios) {
      if (differs(ratio.size / found.size, steady)) return {};
      if (differs(ratio.spread / ratios[0].spread, steady)) found.spread = found.size;
    }
    return found;
  }

 private:
  Ratio at(const std::vector<glm::dmat4>& modelFromNode) const {
    std::vector<double> sizes;
    for (const ClipSkin::Entry& entry : skin_.entries) {
      const auto node = static_cast<size_t>(entry.node);
      const double rest = sizeOf(document_.nodes[node].modelFromNode);
      if (rest > 0) sizes.push_back(sizeOf(modelFromNode[node]) / rest);
    }
    double apart = 0, apartAtRest = 0;
    for (const auto& [parent, node] : bones_) {
      const auto p = static_cast<size_t>(parent), n = static_cast<size_t>(node);
      apart += glm::distance(modelFromNode[p][3], modelFromNode[n][3]);
      apartAtRest += glm::distance(document_.nodes[p].modelFromNode[3], document_.nodes[n].modelFromNode[3]);
    }
    return {median(std::move(sizes)), apartAtRest > 0 ? apart / apartAtRest : 1};
  }

  const gltf::Document& document_;
  const ClipSkin& skin_;
  std::vector<std::pair<int, int>> bones_;  // parents and their children, both of which move skin
};

// How many times as far from its parent as at rest the highest node is all along that is translated and has
// most of the skin on it and below; nothing where it rests at its parent, so that there is nothing to
// compare.
std::optional<double> rootReach(const gltf::Document& document, const gltf::Clip& clip,
                                const ClipSkin& skin) {
  for (const int node : skin.nodes) {
    const auto n = static_cast<size_t>(node);
    if (!(skin.weightBelow[n] > 0.5) || skin.inLeg[n]) continue;
    for (const gltf::Channel& channel : clip.moving) {
      const gltf::Sampler& sampler = clip.samplers[channel.sampler];
      if (channel.node != node || sampler.path != gltf::Path::translation) continue;
      const double rest = glm::length(document.nodes[n].translation);
      std::vector<double> reaches;
      for (const double share : {0.0, 0.5, 1.0})
        reaches.push_back(glm::length(sampleVector(sampler, share * clip.seconds)));
      if (!(rest > 0)) return {};
      return *std::ranges::min_element(reaches) / rest;
    }
  }
  return {};
}

// Divides the scale of the highest nodes that are scaled so, whose channels are the cause.
gltf::Clip divided(const gltf::Document& document, const gltf::Clip& clip, const ClipSkin& skin,
                   double ratio) {
  gltf::Clip smaller = clip;
  std::vector<bool> done(document.nodes.size(), false);
  for (const int node : skin.nodes) {
    const auto n = static_cast<size_t>(node);
    const int parent = document.nodes[n].parent;
    done[n] = parent != -1 && done[static_cast<size_t>(parent)];
    if (done[n]) continue;
    for (gltf::Channel& channel : smaller.moving) {
      const gltf::Sampler& sampler = smaller.samplers[channel.sampler];
      if (channel.node != node || sampler.path != gltf::Path::scale) continue;
      const auto volume = [](const glm::dvec3& scale) {
        return std::cbrt(std::fabs(scale.x * scale.y * scale.z));
      };
      const double own = volume(sampleVector(sampler, 0)) / volume(document.nodes[n].scale);
      if (!(std::fabs(own / ratio - 1) < 0.05)) continue;
      // Other nodes may have the same sampler.
      gltf::Sampler copy = sampler;
      for (double& value : copy.values) value /= own;
      channel.sampler = smaller.samplers.size();
      smaller.samplers.push_back(std::move(copy));
      done[n] = true;
    }
  }
  return smaller;
}

}  // namespace

gltf::Clip inRestSize(const gltf::Document& document, const gltf::Clip& clip, const ClipSkin& skin,
                      const std::string& what, std::vector<std::string>& notes) {
  const Comparison comparison(document, skin);
  const std::optional<Ratio> ratio = comparison.of(clip);
  if (!ratio) return clip;
  if (differs(ratio->size, largestChange)) {
    gltf::Clip mended = divided(document, clip, skin, ratio->size);
    const std::optional<Ratio> after = comparison.of(mended);
    if (after && !differs(after->size, largestChange)) {
      notes.push_back(
          fmt::format("{}: its scale shows the skin {:.3g} times as large as at rest: played in "
                      "the size at rest",
                      what, ratio->size));
      return mended;
    }
    notes.push_back(fmt::format("{}: shows the skin {:.3g} times as large as at rest", what, ratio->size));
  } else if (differs(ratio->spread, largestChange)) {
    notes.push_back(
        fmt::format("{}: its joints are {:.3g} times as far apart as at rest: its translations "
                    "may be in another unit",
                    what, ratio->spread));
  } else if (const auto reach = rootReach(document, clip, skin); reach && *reach > furthestRoot) {
    notes.push_back(
        fmt::format("{}: its root is {:.3g} times as far from its parent as at rest: its "
                    "translations may be in another unit",
                    what, *reach));
  }
  return clip;
}

}  // namespace skitter
