// The numbers of a material, a uniform block to GLSL (std140: vec4 only) and a struct to C++.
#ifndef SKITTER_RENDER_MATERIAL_H
#define SKITTER_RENDER_MATERIAL_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace skitter::shared {
#define MATERIAL_CONST inline constexpr int
using glm::vec4;
#else
#define MATERIAL_CONST const int
#endif

// The order of skitter::TextureRole.
MATERIAL_CONST BASE_COLOUR = 0;
MATERIAL_CONST METALLIC_ROUGHNESS = 1;
MATERIAL_CONST NORMAL = 2;
MATERIAL_CONST OCCLUSION = 3;
MATERIAL_CONST EMISSIVE = 4;
MATERIAL_CONST TEXTURES = 5;

struct MaterialNumbers {
  vec4 factors;             // metallic, roughness, scale of normals, strength of occlusion
  vec4 emissive;            // linear RGB; alpha's cutoff
  vec4 rows[2 * TEXTURES];  // of a texture's affine map, two each: u' = dot(xyz, (u, v, 1)), then v';
                            // w of the first: which texture coordinates
};

#ifdef __cplusplus
}  // namespace skitter::shared
#endif
#undef MATERIAL_CONST
#endif
