#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "glb_builder.h"

namespace skitter::test {

// A file's nodes at any time of its clips, as the glTF specification has it (3.5.3, 3.11): read from the JSON
// and the buffer alone, without the engine's loader and sampler.
class GltfPose {
 public:
  explicit GltfPose(const Glb& glb);

  // The matrix from a node to the file's space.
  glm::dmat4 at(const std::string& clip, const std::string& node, double time) const;
  // The matrix from the bound skin to a joint of the file's first skin.
  glm::dmat4 inverseBind(const std::string& node) const;

 private:
  std::vector<double> numbers(size_t accessor) const;
  std::vector<double> sampled(const nlohmann::json& clip, size_t node, const char* path, double time) const;
  glm::dmat4 local(const nlohmann::json& clip, size_t node, double time) const;
  size_t indexOf(const std::string& node) const;

  Glb glb_;
  std::vector<int> parents_;
};

}  // namespace skitter::test
