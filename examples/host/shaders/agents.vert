#version 460
// The crowd, skinned by the palettes that Skitter wrote.
layout(std430, binding = 0) readonly buffer Palettes { vec4 rows[]; };  // three a bone
layout(std430, binding = 1) readonly buffer Visible { uint visible[]; };
layout(push_constant) uniform Constants {
  mat4 clip;
  vec3 eye;
  uint entries;  // bones an agent
  uint list;     // where the level's list begins
  uint picked;   // an agent that is marked
};
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 colour;
layout(location = 3) in uvec4 bones;
layout(location = 4) in vec4 weights;
layout(location = 0) out vec3 outNormal;
layout(location = 1) out vec3 outColour;
layout(location = 2) out float outAway;

void main() {
  uint agent = visible[list + gl_InstanceIndex];
  vec3 place = vec3(0.0), turned = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    if (weights[i] == 0.0) continue;
    uint at = 3u * (agent * entries + bones[i]);
    mat4x3 bone = transpose(mat3x4(rows[at], rows[at + 1u], rows[at + 2u]));
    place += weights[i] * (bone * vec4(position, 1.0));
    turned += weights[i] * (mat3(bone) * normal);
  }
  gl_Position = clip * vec4(place, 1.0);
  outNormal = turned;
  outColour = agent == picked ? vec3(1.0, 0.25, 0.05) : colour;
  outAway = distance(place, eye);
}
