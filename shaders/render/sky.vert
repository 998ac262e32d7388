#version 460
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"

layout(location = 0) out vec3 direction;

// One triangle over the whole picture, at infinite distance.
void main() {
  vec2 clip = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0);
  direction = picture.forward.xyz + clip.x * picture.right.xyz + clip.y * picture.up.xyz;
  gl_Position = vec4(clip, 0.0, 1.0);
}
