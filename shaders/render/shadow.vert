#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "skin.glsl"

#ifdef CUTOUT
layout(location = 9) in vec4 uv;
layout(location = 11) in float opacity;
layout(location = 0) out vec4 outUv;
layout(location = 1) out float outOpacity;
#endif

void main() {
  Skinned s = skinned();
  spread(s, picture.sun.xyz, constants.view == 1u ? picture.shadow.x : picture.shadow.y);
  gl_Position = picture.clipFromPicture[constants.view] * vec4(s.position, 1.0);
#ifdef CUTOUT
  outUv = uv;
  outOpacity = opacity;
#endif
}
