#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "skin.glsl"

void main() {
  Skinned s = skinned();
  spread(s, picture.sun.xyz, constants.view == 1u ? picture.shadow.x : picture.shadow.y);
  gl_Position = picture.clipFromPicture[constants.view] * vec4(s.position, 1.0);
}
