#pragma once

#include <cmath>

#include "fuzz.h"
#include "skitter/error.h"
#include "skitter/material.h"

namespace skitter::fuzz {

// Checks all that drawing takes for granted of a skin's materials, and that images are decoded or refused.
inline void checkLook(const Look& look, size_t vertices) {
  expect(look.vertices.size() == (look ? vertices : 0), "a look that is not the skin's");
  if (!look) return;
  for (const MaterialVertex& vertex : look.vertices) {
    expect(vertex.material < look.materials->list.size(), "a vertex of no material");
    for (int k = 0; k < 4; ++k) expect(std::isfinite(vertex.tangent[k]), "a tangent that is not finite");
    expect(vertex.opacity >= 0 && vertex.opacity <= 1, "an opacity out of range");
  }
  for (const Material& material : look.materials->list)
    for (const Texture& texture : material.textures) {
      expect(texture.image >= -1 && texture.image < static_cast<int>(look.materials->images.size()),
             "a texture of no image");
      expect(texture.set == 0 || texture.set == 1, "a texture of no coordinates");
    }
  for (const ImageFile& image : look.materials->images) {
    try {
      const Texels texels = decodeImage(image);
      expect(texels.rgba.size() == size_t{4} * texels.width * texels.height, "texels that are not whole");
    } catch (const Error& error) {
      expect(error.kind() == Error::Kind::input, "an image refused for something else");
    }
  }
}

}  // namespace skitter::fuzz
