#version 460
#extension GL_GOOGLE_include_directive : require
// Which agents each list draws: an agent in the camera's pyramid joins the list of its level of detail, one
// in reach of a shadow cascade one of that cascade's. The order within a list is of no consequence.
#include "fade.glsl"
#include "picture.glsl"
#include "lib/load4.glsl"

layout(local_size_x = WORK_GROUP) in;
layout(push_constant) uniform ConstantBlock { CullConstants constants; };
LOAD4_BUFFER(DRAW_BODY, bodies)
#include "lists.glsl"

// Texels of the far cascade from a point within which shadow.glsl looks: how far off along the longest way and
// across, a square, and the way off the surface.
const float FAR_REACH = 11.0;
// Splats are projected point by point: all of an agent lies well ahead of the eye, and within what a splat's depth
// tells apart (splat.glsl).
const float LEAST_AHEAD = 4.0;  // of the agent's radius
const float MOST_AHEAD = 3000.0;  // metres

// Into a list that a shader goes through, and so its work groups.
void appendForDispatch(int list, uint agent) {
  uint place = append(uint(list), agent);
  if (place % WORK_GROUP == 0u) atomicAdd(commands[list * DRAW_WORDS + 2], 1u);
}

// The further of the ways along a cascade's sides, half of which is 1; `margin` is an agent's radius.
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

  float inside = picture.tile.z - away;
  for (int i = 0; i < 4; ++i) inside = min(inside, dot(picture.planes[i].xyz, p) + picture.planes[i].w);
  bool seen = inside > -constants.radius;
  float pixels = constants.radius / (max(away, 1e-3) * picture.eye.w);
  float ahead = dot(p - picture.eye.xyz, picture.forward.xyz);
  bool splat =
      seen && pixels < constants.splatPixels && ahead > LEAST_AHEAD * constants.radius && ahead < MOST_AHEAD;
  bool shade = splat && pixels < constants.shadePixels;
  uint fade = fadeOf(pixels, constants.splatPixels);
  uint shadeFade = fadeOf(pixels, constants.shadePixels);
  if (seen) {
    uint list = 0u;
    for (int i = 0; i < CAMERA_LODS - 1; ++i) list += pixels < constants.lodPixels[i] ? 1u : 0u;
    if (splat) appendForDispatch(SPLATS, agent);
    else append(list, agent);
    if (splat && fade < FADED) append(uint(FADING), agent | fade << FADE_SHIFT);
    if (pixels >= constants.contactPixels) append(uint(CONTACTS), agent);
  }
  // An agent outside the picture may cast its shadow into it, but none is seen where shadows have faded. The far
  // cascade is not looked up where the near one holds the whole shadow and all from where it would be looked up.
  bool casts = min(inside, picture.forward.w - ahead) > -4.0 * constants.radius && !(shade && shadeFade == FADED);
  float nearMargin, farMargin;
  float outOfNear = outOfCascade(0, p, nearMargin), outOfFar = outOfCascade(1, p, farMargin);
  float nearAlone = 0.98 - 2.0 * FAR_REACH * picture.shadow.y / (picture.shadow.x * picture.shadow.w);
  uint caster = shade ? agent | shadeFade << FADE_SHIFT : agent;
  bool castsNear = casts && outOfNear < 1.0 + nearMargin;
  bool castsFar = casts && outOfFar < 1.0 + farMargin && outOfNear + nearMargin > nearAlone;
  if (castsNear)
    append(uint(shade ? NEAR_FADING : pixels < constants.lodPixels[1] ? NEAR_COARSE : NEAR_FINE), caster);
  if (castsFar) append(uint(shade ? FAR_FADING : FAR_SHADOWS), caster);
  if (constants.listsShown != 0u && (seen || castsNear || castsFar)) appendForDispatch(SHOWN, agent);
}
