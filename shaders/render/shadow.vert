#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "skin.glsl"

void main() {
  vec3 position = skinned(vec3(0.0, 1.0, 0.0)).position;
  gl_Position = picture.clipFromPicture[constants.view] * vec4(position, 1.0);
}
