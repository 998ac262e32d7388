#version 460
// One triangle over the whole picture.
layout(location = 0) out vec2 outAt;  // 0..1 across the picture, down from its top

void main() {
  vec2 clip = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0);
  outAt = vec2(0.5 + 0.5 * clip.x, 0.5 - 0.5 * clip.y);
  gl_Position = vec4(clip, 0.0, 1.0);
}
