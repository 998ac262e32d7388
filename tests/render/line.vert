#version 460
// One triangle over the whole picture; `along` runs from 0 at its left edge to 1 at its right one.
layout(location = 0) out float along;

void main() {
  vec2 clip = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0);
  along = 0.5 + 0.5 * clip.x;
  gl_Position = vec4(clip, 0.0, 1.0);
}
