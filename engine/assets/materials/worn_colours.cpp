#include "assets/materials/worn_colours.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "assets/materials/mip_levels.h"
#include "base/srgb.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr uint32_t mostTexelsFromAfar = 64;  // a side

// None where the image cannot be decoded.
std::vector<Texels> levelsUpTo(const ImageFile& file, uint32_t mostTexels) {
  try {
    std::vector<Texels> levels = mipLevels(decodeImage(file), TexelKind::srgb);
    const auto first = std::find_if(levels.begin(), levels.end(), [&](const Texels& level) {
      return std::max(level.width, level.height) <= mostTexels;
    });
    levels.erase(levels.begin(), first);
    return levels;
  } catch (const Error&) {
    return {};
  }
}

glm::vec2 placeIn(const Texture& texture, const MaterialVertex& vertex) {
  const std::array<glm::vec3, 2> rows = texture.rows();
  const glm::vec3 from(vertex.uv[texture.set], 1);
  return {glm::dot(rows[0], from), glm::dot(rows[1], from)};
}

size_t texelAt(float coordinate, uint32_t size, TextureSampler::Wrap wrap) {
  using Wrap = TextureSampler::Wrap;
  if (!std::isfinite(coordinate)) return 0;
  if (wrap == Wrap::mirror) coordinate = std::fabs(coordinate - 2 * std::floor(0.5f * coordinate + 0.5f));
  if (wrap == Wrap::repeat) coordinate -= std::floor(coordinate);
  const float last = static_cast<float>(size) - 1;
  return static_cast<size_t>(std::clamp(std::floor(coordinate * static_cast<float>(size)), 0.0f, last));
}

}  // namespace

BaseColours::BaseColours(const Look& look, uint32_t mostTexels) : look_(look) {
  if (!look) return;
  std::set<int> seen{-1};
  for (const Material& material : look.materials->list) {
    const int image = material.texture(TextureRole::baseColour).image;
    if (!seen.insert(image).second) continue;
    std::vector<Texels> levels = levelsUpTo(look.materials->images[static_cast<size_t>(image)], mostTexels);
    if (!levels.empty()) images_[image] = std::move(levels);
  }
}

const Texture& BaseColours::textureOf(const MaterialVertex& vertex) const {
  return look_.materials->list[vertex.material].texture(TextureRole::baseColour);
}

glm::vec4 BaseColours::at(const MaterialVertex& vertex, size_t level) const {
  const Texture& texture = textureOf(vertex);
  const auto found = images_.find(texture.image);
  if (found == images_.end()) return glm::vec4(1);
  const Texels& image = found->second[std::min(level, found->second.size() - 1)];
  const glm::vec2 place = placeIn(texture, vertex);
  const size_t x = texelAt(place.x, image.width, texture.sampler.wrapS),
               y = texelAt(place.y, image.height, texture.sampler.wrapT);
  const uint8_t* texel = &image.rgba[4 * (y * image.width + x)];
  return {base::linearOfByte(texel[0]), base::linearOfByte(texel[1]), base::linearOfByte(texel[2]),
          static_cast<float>(texel[3]) / 255};
}

size_t BaseColours::levelOf(const std::array<MaterialVertex, 3>& corners, float pixels) const {
  const Texture& texture = textureOf(corners[0]);
  const auto found = images_.find(texture.image);
  if (found == images_.end()) return 0;
  const Texels& finest = found->second.front();
  const glm::vec2 size(finest.width, finest.height), from = placeIn(texture, corners[0]) * size,
                                                     a = placeIn(texture, corners[1]) * size - from,
                                                     b = placeIn(texture, corners[2]) * size - from;
  const float texels = 0.5f * std::fabs(a.x * b.y - a.y * b.x);
  // Each level has a quarter of the texels of the one before.
  const float level = 0.5f * std::log2(texels / pixels);
  const float last = static_cast<float>(found->second.size()) - 1;
  return level > 0 ? static_cast<size_t>(std::min(std::round(level), last)) : 0;
}

std::vector<glm::vec3> wornColours(const std::vector<SkinVertex>& vertices, const Look& look) {
  std::vector<glm::vec3> colours;
  for (const SkinVertex& vertex : vertices) colours.push_back(vertex.colour);
  if (!look) return colours;
  const BaseColours textures(look, mostTexelsFromAfar);
  for (size_t v = 0; v < colours.size(); ++v) colours[v] *= glm::vec3(textures.at(look.vertices[v]));
  return colours;
}

}  // namespace skitter
