#version 460
#extension GL_GOOGLE_include_directive : require
// Which agents each list draws: an agent in the camera's pyramid joins the list of its level of detail, one
// in reach of a shadow cascade that cascade's. The order within a list is of no consequence.
#include "picture.glsl"
#include "lib/load4.glsl"

layout(local_size_x = WORK_GROUP) in;
layout(push_constant) uniform ConstantBlock { CullConstants constants; };
LOAD4_BUFFER(DRAW_BODY, bodies)
layout(set = 0, binding = DRAW_INSTANCES, std430) writeonly buffer Instances { uint instances[]; };
layout(set = 0, binding = DRAW_COMMANDS, std430) buffer Commands { uint commands[]; };

// Texels of the far cascade from a point within which shadow.glsl looks: half its longest way, across, and a square.
const float FAR_REACH = 18.0;

void append(uint list, uint agent) {
  uint place = atomicAdd(commands[list * DRAW_WORDS + 1], 1u);
  instances[list * constants.agents + place] = agent;
}

// Half of the cascade's square is 1; `margin` is an agent's radius.
float outOfCascade(int cascade, vec3 p, out float margin) {
  vec4 clip = picture.clipFromPicture[1 + cascade] * vec4(p, 1.0);
  float texel = cascade == 0 ? picture.shadow.x : picture.shadow.y;
  margin = 2.0 * constants.radius / (texel * picture.shadow.w);
  return max(abs(clip.x), abs(clip.y));
}

void main() {
  uint agent = gl_GlobalInvocationID.x;
  if (agent >= constants.agents) return;
  vec4 a = LOAD4(bodies, int(agent) * BODY_STRIDE);
  vec3 p = a.xyz + TILE_SIZE * vec3(tileX(a.w) - picture.tile.x, 0.0, tileZ(a.w) - picture.tile.y);
  float away = distance(p, picture.eye.xyz);
  float pixels = constants.radius / (max(away, 1e-3) * picture.eye.w);

  float inside = picture.tile.z - away;
  for (int i = 0; i < 4; ++i) inside = min(inside, dot(picture.planes[i].xyz, p) + picture.planes[i].w);
  bool seen = inside > -constants.radius;
  if (seen) {
    uint lod = 0u;
    for (int i = 0; i < CAMERA_LODS - 1; ++i) lod += pixels < constants.lodPixels[i] ? 1u : 0u;
    append(pixels < constants.splatPixels ? uint(SPLAT_LIST) : lod, agent);
  }

  // An agent outside the picture may cast its shadow into it. Where the near cascade holds the whole shadow, and
  // all from where the far one is looked up about it, the far one is not looked up.
  if (inside <= -4.0 * constants.radius) return;
  float nearMargin, farMargin;
  float outOfNear = outOfCascade(0, p, nearMargin), outOfFar = outOfCascade(1, p, farMargin);
  float lookedUp = 0.98 - 2.0 * FAR_REACH * picture.shadow.y / (picture.shadow.x * picture.shadow.w);
  bool inNear = outOfNear < 1.0 + nearMargin;
  bool inFar = outOfFar < 1.0 + farMargin && outOfNear + nearMargin > lookedUp;
  if ((inNear || inFar) && pixels < constants.leastShadow) {
    atomicAdd(commands[LEFT_OUT * DRAW_WORDS + 1], 1u);
    return;
  }
  if (inNear) append(uint(SHADOW_LISTS) + (pixels < constants.shadowPixels[0] ? 1u : 0u), agent);
  if (inFar) append(uint(SHADOW_LISTS + CASCADE_LISTS) + (pixels < constants.shadowPixels[1] ? 1u : 0u), agent);
}
