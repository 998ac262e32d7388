#version 460
// The ground, six vertices a cell of the heightfield.
layout(std430, binding = 0) readonly buffer Heights { float heights[]; };
layout(push_constant) uniform Constants {
  mat4 clip;
  vec3 eye;
  uint columns, rows;
  float spacingX, spacingZ;
  vec3 first;  // where sample (0, 0) is, at height 0
};
layout(location = 0) out vec3 outNormal;
layout(location = 1) out vec2 outPlace;
layout(location = 2) out float outAway;

float at(ivec2 sample_) {
  ivec2 inside = clamp(sample_, ivec2(0), ivec2(columns, rows) - 1);
  return heights[inside.y * int(columns) + inside.x];
}

void main() {
  const ivec2 corners[6] = ivec2[](ivec2(0, 0), ivec2(0, 1), ivec2(1, 0), ivec2(1, 0), ivec2(0, 1), ivec2(1, 1));
  int cell = gl_VertexIndex / 6, wide = int(columns) - 1;
  ivec2 sample_ = ivec2(cell % wide, cell / wide) + corners[gl_VertexIndex % 6];
  vec3 place = first + vec3(spacingX * float(sample_.x), at(sample_), spacingZ * float(sample_.y));
  outNormal = normalize(vec3((at(sample_ - ivec2(1, 0)) - at(sample_ + ivec2(1, 0))) / (2.0 * spacingX), 1.0,
                             (at(sample_ - ivec2(0, 1)) - at(sample_ + ivec2(0, 1))) / (2.0 * spacingZ)));
  outPlace = vec2(sample_) * vec2(spacingX, spacingZ);
  outAway = distance(place, eye);
  gl_Position = clip * vec4(place, 1.0);
}
