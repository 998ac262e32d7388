#version 460
// The host's own culling: appends each agent in the picture to the list of its level of detail.
layout(local_size_x = 64) in;
struct Draw {
  uint indexCount, instanceCount, firstIndex, vertexOffset, firstInstance;
};
layout(std430, binding = 0) readonly buffer Instances { vec4 instances[]; };  // rotation; position, scale
layout(std430, binding = 1) writeonly buffer Visible { uint visible[]; };     // a list a level
layout(std430, binding = 2) buffer Draws { Draw draws[]; };
layout(push_constant) uniform Constants {
  mat4 clip;
  vec4 pixels;      // of the radius, from which each level but the last serves
  vec3 eye;
  float pixelsAway; // pixels of a metre, a metre away
  uint agents;
  uint levels;
  float radius;
};

void main() {
  uint agent = gl_GlobalInvocationID.x;
  if (agent >= agents) return;
  vec3 position = instances[2 * agent + 1].xyz;
  // Outside one of the sides of the camera's pyramid.
  vec4 x = vec4(clip[0].x, clip[1].x, clip[2].x, clip[3].x), y = vec4(clip[0].y, clip[1].y, clip[2].y, clip[3].y);
  vec4 w = vec4(clip[0].w, clip[1].w, clip[2].w, clip[3].w);
  vec4 sides[4] = vec4[](w + x, w - x, w + y, w - y);
  for (int i = 0; i < 4; ++i)
    if (dot(sides[i], vec4(position, 1.0)) < -radius * length(sides[i].xyz)) return;
  float size = radius * pixelsAway / max(distance(position, eye), 1e-3);
  uint level = 0u;
  while (level + 1u < levels && size < pixels[level]) ++level;
  visible[level * agents + atomicAdd(draws[level].instanceCount, 1u)] = agent;
}
