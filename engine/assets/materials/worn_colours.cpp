#include "assets/materials/worn_colours.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "assets/materials/mip_levels.h"
#include "base/srgb.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr uint32_t mostTexels = 64;  // a side

std::optional<Texels> coarseImage(const ImageFile& file) {
  try {
    std::vector<Texels> levels = mipLevels(decodeImage(file), TexelKind::srgb);
    const auto found = std::find_if(levels.begin(), levels.end(), [](const Texels& level) {
      return std::max(level.width, level.height) <= mostTexels;
    });
    return std::move(*found);
  } catch (const Error&) {
    return {};  // whoever draws it says so
  }
}

size_t texelAt(float coordinate, uint32_t size, TextureSampler::Wrap wrap) {
  using Wrap = TextureSampler::Wrap;
  if (wrap == Wrap::mirror) coordinate = std::fabs(coordinate - 2 * std::floor(0.5f * coordinate + 0.5f));
  if (wrap == Wrap::repeat) coordinate -= std::floor(coordinate);
  const float last = static_cast<float>(size) - 1;
  return static_cast<size_t>(std::clamp(std::floor(coordinate * static_cast<float>(size)), 0.0f, last));
}

glm::vec3 colourAt(const Texels& image, const Texture& texture, const MaterialVertex& vertex) {
  const std::array<glm::vec3, 2> rows = texture.rows();
  const glm::vec3 from(vertex.uv[texture.set], 1);
  const size_t x = texelAt(glm::dot(rows[0], from), image.width, texture.sampler.wrapS),
               y = texelAt(glm::dot(rows[1], from), image.height, texture.sampler.wrapT);
  const uint8_t* texel = &image.rgba[4 * (y * image.width + x)];
  return {base::linearOfByte(texel[0]), base::linearOfByte(texel[1]), base::linearOfByte(texel[2])};
}

}  // namespace

std::vector<glm::vec3> wornColours(const std::vector<SkinVertex>& vertices, const Look& look) {
  std::vector<glm::vec3> colours;
  for (const SkinVertex& vertex : vertices) colours.push_back(vertex.colour);
  if (!look) return colours;
  std::map<int, std::optional<Texels>> images;
  for (size_t v = 0; v < colours.size(); ++v) {
    const MaterialVertex& vertex = look.vertices[v];
    const Texture& texture = look.materials->list[vertex.material].texture(TextureRole::baseColour);
    if (texture.image == -1) continue;
    const auto [image, isNew] = images.try_emplace(texture.image);
    if (isNew) image->second = coarseImage(look.materials->images[static_cast<size_t>(texture.image)]);
    if (image->second) colours[v] *= colourAt(*image->second, texture, vertex);
  }
  return colours;
}

}  // namespace skitter
