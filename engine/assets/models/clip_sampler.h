#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <span>
#include <vector>

#include "assets/models/gltf.h"

// A clip at any time, exactly (docs/clip.md, Sampling).
namespace skitter {

// A value of the clip's, or its limit from the left, which differs at a STEP key.
enum class Side { at, before };

// The first samples translation or scale, the second rotation.
glm::dvec3 sampleVector(const gltf::Sampler& sampler, double time, Side side = Side::at);
glm::dquat sampleRotation(const gltf::Sampler& sampler, double time, Side side = Side::at);

class ClipSampler {
 public:
  // `nodes`, parents first and each with all its ancestors, are those that matter; `worldFromModel` goes
  // before all.
  ClipSampler(const gltf::Document& document, const gltf::Clip& clip, std::span<const int> nodes,
              const glm::dmat4& worldFromModel);

  // worldFromNode of all nodes until the next call, by the document's indices; of others it means nothing.
  const std::vector<glm::dmat4>& sample(double time, Side side = Side::at);

  bool translates(int node) const { return channels_[static_cast<size_t>(node)][0] != nullptr; }
  std::vector<double> keyTimes() const;   // of all channels that matter, ascending, each once
  std::vector<double> jumpTimes() const;  // of STEP keys that differ from the key before, likewise

 private:
  struct Channels {
    const gltf::Sampler* paths[3] = {};
    const gltf::Sampler*& operator[](size_t path) { return paths[path]; }
    const gltf::Sampler* operator[](size_t path) const { return paths[path]; }
  };

  std::vector<const gltf::Sampler*> samplers() const;

  const gltf::Document& document_;
  std::vector<int> order_;  // the nodes that move
  std::vector<Channels> channels_;
  std::vector<bool> moving_;
  glm::dmat4 worldFromModel_;
  std::vector<glm::dmat4> worldFromNode_;
};

}  // namespace skitter
