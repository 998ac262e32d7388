#ifndef DECAL_GLSL
#define DECAL_GLSL
// Squares that lie on the ground and dim it.
#include "picture.glsl"
#include "fold.glsl"
#include "lib/heightfield.glsl"

layout(set = 0, binding = DRAW_HEIGHTS) uniform sampler2D heights;

// Height of the ground at a place in picture space.
float groundAt(Field field, vec2 p) {
  vec2 at = (p - picture.ground.xy) / picture.ground.zw;
  return heightAt(heights, field, foldedAt(at, field.last).at).x;
}
Field decalField() { return fieldOf(heights, vec2(0.0), vec2(1.0)); }

// Where a square's corner is drawn, moved a little towards the eye. `share` is what the square dims.
vec4 decalAt(Field field, vec2 p, inout float share) {
  vec3 position = vec3(p.x, groundAt(field, p), p.y);
  // The ground's triangles differ from the ground by half a pixel, root mean square.
  vec3 toEye = picture.eye.xyz - position;
  float away = length(toEye), depth = away * picture.tile.w;
  share *= exp(-depth * depth);
  position += toEye * ((0.012 + 2.0 * picture.eye.w * away) / away);
  return share > 0.0 ? picture.clipFromPicture[VIEW_CAMERA] * vec4(position, 1.0) : vec4(0.0, 0.0, 0.0, 1.0);
}

#endif
