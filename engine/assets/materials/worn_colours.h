#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <vector>

#include "skitter/rig.h"

namespace skitter {

// The base colour textures of a look, decoded, with their levels; as they are seen where no device draws. An
// image that cannot be decoded is as none: whoever draws it on a device says so.
class BaseColours {
 public:
  // The look outlives it. Levels with more than `mostTexels` a side are left out.
  explicit BaseColours(const Look& look, uint32_t mostTexels = UINT32_MAX);

  // Linear red, green and blue, and alpha, of the texel where `vertex` is; white without a texture.
  glm::vec4 at(const MaterialVertex& vertex, size_t level = 0) const;
  // The level at which a triangle that covers `pixels` has about a texel a pixel.
  size_t levelOf(const std::array<MaterialVertex, 3>& corners, float pixels) const;

 private:
  const Texture& textureOf(const MaterialVertex& vertex) const;

  const Look& look_;
  std::map<int, std::vector<Texels>> images_;  // levels by the image's place; those that are none are missing
};

// The colour of each vertex as one sees it from afar: its own times that of the base colour texture there,
// of a level with at most 64 texels a side. Without a look, or where an image cannot be decoded, its own.
std::vector<glm::vec3> wornColours(const std::vector<SkinVertex>& vertices, const Look& look);

}  // namespace skitter
