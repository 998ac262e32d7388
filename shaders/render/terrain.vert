#version 460
#extension GL_GOOGLE_include_directive : require
// A square patch of PATCH_CELLS x PATCH_CELLS cells at a stride of its own, laid on the bilinear surface that the crowd walks
// on. Towards the end of its range a patch moves each odd vertex onto its even neighbour, so that it meets
// the coarser patch beside it without a crack and never pops (Strugar 2009, "Continuous Distance-Dependent
// Level of Detail").
#include "picture.glsl"
#include "terrain.glsl"
#include "lib/heightfield.glsl"

layout(set = 0, binding = DRAW_HEIGHTS) uniform sampler2D heights;
layout(location = 0) in vec4 patchAt;  // first sample x, z; samples a cell; metres at which the range ends

layout(location = 0) out vec3 outPosition;
layout(location = 1) out vec3 outNearAt;  // in the shadow map's cascades
layout(location = 2) out vec3 outFarAt;
layout(location = 3) out vec4 outGround;  // of dense patches, and so the next
layout(location = 4) out float outBroad;

vec2 pictureAt(vec2 at) { return picture.ground.xy + at * picture.ground.zw; }

void main() {
  vec2 grid = vec2(gl_VertexIndex % (PATCH_CELLS + 1), gl_VertexIndex / (PATCH_CELLS + 1));
  vec2 at = patchAt.xy + grid * patchAt.z;
  float away = length(vec3(pictureAt(at) - picture.eye.xz, picture.shadow.z));
  float morph = clamp((away / patchAt.w - 0.87) / 0.12, 0.0, 1.0);
  at -= 2.0 * fract(0.5 * grid) * morph * patchAt.z;
  vec2 p = pictureAt(at);
  Field field = fieldOf(heights, vec2(0.0), vec2(1.0));
  outPosition = vec3(p.x, heightAt(heights, field, foldedAt(at, field.last).at).x, p.y);
  outNearAt = (picture.clipFromPicture[1] * vec4(outPosition, 1.0)).xyz;
  outFarAt = (picture.clipFromPicture[2] * vec4(outPosition, 1.0)).xyz;
  outGround = DENSE ? groundMapAt(at) : vec4(0.0);
  outBroad = DENSE ? broadNoise(noisePlace(outPosition)) : 0.0;
  gl_Position = picture.clipFromPicture[VIEW_CAMERA] * vec4(outPosition, 1.0);
}
