#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "skitter/export.h"

namespace skitter {

// Materials of a model, as glTF 2.0 has them (section 3.9): metallic-roughness with up to five textures. A
// model whose colours are all at its vertices has none, and is drawn without a look-up.

// Which number of the surface a texture holds.
enum class TextureRole { baseColour, metallicRoughness, normal, occlusion, emissive };
inline constexpr std::array allTextureRoles = {TextureRole::baseColour, TextureRole::metallicRoughness,
                                               TextureRole::normal, TextureRole::occlusion,
                                               TextureRole::emissive};
constexpr const char* nameOf(TextureRole role) {
  constexpr std::array names = {"base colour", "metallic-roughness", "normal", "occlusion", "emissive"};
  static_assert(names.size() == allTextureRoles.size());
  return names[static_cast<size_t>(role)];
}
// Whether the role's texels are colours in sRGB. All others are numbers.
constexpr bool isColour(TextureRole role) {
  return role == TextureRole::baseColour || role == TextureRole::emissive;
}

// How a texture is looked up. What a file leaves open is as here.
struct TextureSampler {
  enum class Wrap : uint8_t { repeat, mirror, clamp };
  enum class Mips : uint8_t { none, nearest, linear };

  Wrap wrapS = Wrap::repeat, wrapT = Wrap::repeat;
  bool magNearest = false, minNearest = false;
  Mips mips = Mips::linear;

  bool operator==(const TextureSampler&) const = default;
};

struct Texture {
  int image = -1;  // into Materials::images; -1: there is no texture
  int set = 0;     // of texture coordinates, 0 or 1
  TextureSampler sampler = {};
  // KHR_texture_transform: a coordinate is scaled, then turned by `rotation` radians, then moved.
  glm::vec2 scale{1}, offset{0};
  float rotation = 0;

  // The rows of the affine map: u' = dot(rows[0], (u, v, 1)), v' likewise.
  SKITTER_API std::array<glm::vec3, 2> rows() const;
  bool operator==(const Texture&) const = default;
};

// The base colour's factor is in the vertices' colours and opacities.
struct Material {
  std::string name;  // may be empty
  std::array<Texture, allTextureRoles.size()> textures;
  float metallic = 1, roughness = 1;  // 0 to 1
  float normalScale = 1;              // of a normal's share along the surface
  float occlusionStrength = 1;        // 0 to 1
  glm::vec3 emissive{0};              // linear RGB, 0 to 1
  float alphaCutoff = 0;              // what is less opaque is not drawn; 0: all of it is
  bool doubleSided = false;

  const Texture& texture(TextureRole role) const { return textures[static_cast<size_t>(role)]; }
  Texture& texture(TextureRole role) { return textures[static_cast<size_t>(role)]; }
  bool operator==(const Material&) const = default;
};

// An image as the model has it, not decoded: only drawing and `skitter inspect` look into it.
struct ImageFile {
  std::string name;            // for messages: the model's, and which image of it
  std::vector<uint8_t> bytes;  // a PNG or a JPEG file; empty where there is none
  std::string fault;           // where there is none: why, for messages, with the name

  bool operator==(const ImageFile&) const = default;
};

struct Materials {
  std::vector<Material> list;
  std::vector<ImageFile> images;

  bool operator==(const Materials&) const = default;
};

// A vertex as its material sees it.
struct MaterialVertex {
  glm::vec2 uv[2] = {{0, 0}, {0, 0}};  // texture coordinates, (0, 0) the image's upper left corner
  glm::vec4 tangent{1, 0, 0, 1};       // unit, to the image's right; w cross(normal, tangent) is to its top
  float opacity = 1;                   // of the vertex times the base colour's factor
  uint16_t material = 0;               // into Materials::list

  bool operator==(const MaterialVertex&) const = default;
};

// The materials of a skin. Copies share the images.
struct SKITTER_API Look {
  std::vector<MaterialVertex> vertices;        // as the skin's; empty where there are no materials
  std::shared_ptr<const Materials> materials;  // never null where there are vertices

  explicit operator bool() const { return materials != nullptr; }
  bool operator==(const Look& other) const;  // by value
};

// An image, decoded: RGBA8 rows, top row first, as the file has the numbers. Grey is red, green and blue;
// an image without alpha is opaque; 16 bits lose their lower eight. Profiles and gamma are ignored, as glTF
// asks.
struct Texels {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgba;

  bool operator==(const Texels&) const = default;
};

// Throws Error(input) that names the image: there is none, it is no PNG or JPEG, it is corrupt, over 16,384
// texels wide or high, or over 2^26 in all.
SKITTER_API Texels decodeImage(const ImageFile& image);

}  // namespace skitter
