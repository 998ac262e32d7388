#version 460
#extension GL_GOOGLE_include_directive : require
// Draws agents that are a few pixels large: shapes of the pose, pixel by pixel, into a buffer that holds the nearest.
// The smallest cast their shadows so, too, onto the plane of the ground below them.
#include "fade.glsl"
#include "picture.glsl"
#include "fold.glsl"
#include "lib/heightfield.glsl"
#include "lib/load4.glsl"
#include "lib/math.glsl"
#include "light.glsl"
#include "posed.glsl"
#include "shadow_map.glsl"
#include "splat.glsl"
#include "variation.glsl"

layout(local_size_x = WORK_GROUP) in;
layout(constant_id = CONSTANT_SPLAT_PARTS) const int PARTS = 1;
layout(push_constant) uniform ConstantBlock { SplatConstants constants; };
LOAD4_BUFFER(DRAW_BODY, bodies)
LOAD4_BUFFER(DRAW_SPLAT_PARTS, parts)
layout(set = 0, binding = DRAW_HEIGHTS) uniform sampler2D heights;
layout(set = 0, binding = DRAW_GROUND) uniform sampler2D groundMap;
layout(set = 0, binding = DRAW_INSTANCES, std430) readonly buffer Instances { uint instances[]; };
layout(set = 0, binding = DRAW_COMMANDS, std430) readonly buffer Commands { uint commands[]; };
layout(set = 0, binding = DRAW_SPLATS, std430) buffer Splats { uint splats[]; };
layout(set = 0, binding = DRAW_SPLAT_TILES, std430) buffer Tiles { uint tiles[]; };

// Normals of what is round lean so far to both sides, and the rim adds so much of the sky's light, as in lit
// vertices (skin.glsl, crowd.vert).
const float ROUNDNESS = 0.6, RIM = 0.35 * 0.1;
const float THIN = 0.75;  // pixels; what has a smaller radius is one pixel wide
// A shadow's strength by the radius in pixels, at least and at most; the sun is as steep as that to the ground, at
// least; and a shadow is at most so many of the agent's radii away.
const float LEAST_SHADE = 0.2, MOST_SHADE = 0.9, LEAST_SUN = 0.1, MOST_WAY = 1.2;

// Pixels from the upper left corner, and the depth.
vec3 seenAt(vec3 p) {
  vec4 clip = picture.clipFromPicture[VIEW_CAMERA] * vec4(p, 1.0);
  vec3 seen = clip.xyz / clip.w;
  return vec3((0.5 + vec2(0.5, -0.5) * seen.xy) * vec2(constants.width, constants.height), seen.z);
}

// A capsule of radii in pixels, into the plane that begins at `plane`. `low` is of its two halves.
void stroke(vec3 here, vec3 there, vec2 radii, uvec2 low, uint plane, uint fade) {
  ivec2 end = ivec2(constants.width, constants.height);
  int steps = 1 + int(length(there.xy - here.xy) / max(1.0, 0.5 * max(radii.x, radii.y)));
  for (int s = 0; s < steps; ++s) {
    float t = (float(s) + 0.5) / float(steps), wide = mix(radii.x, radii.y, t);
    if (wide < THIN) wide = 0.0;
    vec3 at = mix(here, there, t);
    uint splat = packedDepth(at.z) | (t < 0.5 ? low.x : low.y);
    ivec2 first = clamp(ivec2(floor(at.xy - wide)), ivec2(0), end);
    ivec2 last = clamp(ivec2(floor(at.xy + wide)), ivec2(-1), end - 1);
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) {
        vec2 off = vec2(x, y) + 0.5 - at.xy;
        if ((wide == 0.0 || dot(off, off) <= wide * wide) && isFaded(uvec2(x, y), fade)) atomicMax(splats[plane + y * constants.width + x], splat);
      }
  }
}

// Marks the squares of the picture that a drawing within `reach` pixels of the body may touch.
void mark(vec3 body, float reach) {
  ivec2 most = ivec2(constants.width, constants.height) - 1;
  vec2 middle = seenAt(body).xy;
  ivec2 first = clamp(ivec2(floor(middle - reach)), ivec2(0), most) / SPLAT_TILE;
  ivec2 last = clamp(ivec2(floor(middle + reach)), ivec2(0), most) / SPLAT_TILE;
  int across = (most.x + SPLAT_TILE) / SPLAT_TILE;
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) atomicOr(tiles[y * across + x], 1u);
}

void main() {
  uint place = gl_GlobalInvocationID.x;
  if (place >= commands[SPLATS * DRAW_WORDS + 1]) return;
  uint agent = instances[SPLATS * constants.agents + place];
  vec4 a = LOAD4(bodies, int(agent) * BODY_STRIDE);
  vec3 body = a.xyz + TILE_SIZE * vec3(tileX(a.w) - picture.tile.x, 0.0, tileZ(a.w) - picture.tile.y);
  vec3 sun = picture.sun.xyz, toEye = picture.eye.xyz - body;
  float away = length(toEye);
  toEye /= away;
  float metresAPixel = away * picture.eye.w, pixels = constants.radius / metresAPixel;

  vec2 at = (body.xz - picture.ground.xy) / picture.ground.zw;
  vec4 ground = textureLod(groundMap, (at + 0.5) / vec2(textureSize(groundMap, 0)), 0.0);
  vec3 slope = normalize(vec3(-ground.x, 1.0, -ground.y));
  Field field = fieldOf(heights, vec2(0.0), vec2(1.0));
  float below = heightAt(heights, field, foldedAt(at, field.last).at).x - body.y;
  // Where the sun does not reach the ground nobody casts a shadow. The plane is not quite the ground that is drawn.
  float steep = dot(sun, slope);
  uint fade = fadeOf(pixels, constants.splatPixels);
  float shadeShare = float(fadeOf(pixels, constants.shadePixels)) / FADE_STEPS;
  // The agent's own shadow does not reach beyond its radius towards the sun.
  float lit = ground.w * sunlightOnce(body + constants.radius * sun, sun, 0.0);
  bool casts = pixels < constants.shadePixels && steep > LEAST_SUN && lit > 0.5;
  mark(body, (casts ? 1.0 + MOST_WAY : 1.0) * pixels + 2.0);
  vec3 lifted = toEye * (0.012 + 2.0 * metresAPixel);
  uint shades = constants.width * constants.height;
  Variation variation = variationOf(agent, agent + constants.firstAgent, constants.kind);
  int palette = int(agent * constants.palette);
  Haze haze = hazeOf(-toEye, away, picture.tile.w, sun);
  // The mean over the half of a sphere that is seen, (sin a + (pi - a) cos a) 2 / (3 pi) at an angle a between sun and
  // eye, to 0.01.
  float ballFacing = 0.667 * pow(0.5 + 0.5 * clamp(dot(sun, toEye), -0.999, 1.0), 1.65);

  for (int i = 0; i < PARTS; ++i) {
    vec4 from = LOAD4(parts, 4 * i), to = LOAD4(parts, 4 * i + 1);
    vec4 colourFrom = LOAD4(parts, 4 * i + 2), colourTo = LOAD4(parts, 4 * i + 3);
    bool lostFrom, lostTo;
    vec3 first = posed(palette + int(colourFrom.w), from.xyz, lostFrom);
    vec3 second = posed(palette + int(colourTo.w), to.xyz, lostTo);

    // Both sides' light, of whatever is round about its middle line.
    vec3 across = cross(second - first, toEye);
    bool isBall = dot(across, across) < 1e-12;
    if (isBall) across = sun - dot(sun, toEye) * toEye;
    across *= ROUNDNESS * inversesqrt(max(dot(across, across), 1e-12));
    vec3 oneSide = normalize(toEye + across), otherSide = normalize(toEye - across);
    float facing = isBall ? ballFacing : 0.5 * (max(dot(oneSide, sun), 0.0) + max(dot(otherSide, sun), 0.0));
    float above = 0.5 * dot(first + second, slope);
    vec3 ambient = 0.5 * (ambientLight(oneSide) + ambientLight(otherSide)) *
                   (ground.z * clamp(0.45 + 1.1 * above, 0.3, 1.0));
    vec3 light = SUN_LIGHT * (facing * lit) + ambient, rim = RIM * ambient;
    uvec2 colours = uvec2(packedColour(developed(hazed(varied(variation, colourFrom.rgb) * light + rim, haze))),
                          packedColour(developed(hazed(varied(variation, colourTo.rgb) * light + rim, haze))));

    vec2 radii = vec2(from.w, to.w) / metresAPixel;
    if (!(lostFrom && lostTo)) {
      stroke(seenAt(body + first), seenAt(body + second), radii, colours, 0u, fade);
      if (casts) {
        vec2 ways = vec2(dot(first, slope), dot(second, slope)) - below * slope.y;
        ways = clamp(ways / steep, 0.0, MOST_WAY * constants.radius);
        vec3 start = body + lifted;
        stroke(seenAt(start + first - ways.x * sun), seenAt(start + second - ways.y * sun), radii,
               uvec2(packedShade(shadeShare * clamp(max(radii.x, radii.y), LEAST_SHADE, MOST_SHADE))), shades, FADED);
      }
    }
  }
}
