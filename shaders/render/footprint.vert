#version 460
#extension GL_GOOGLE_include_directive : require
// A print that a foot left, as a small square on the ground.
#include "decal.glsl"
#include "footprint.glsl"
#include "lib/load4.glsl"

LOAD4_BUFFER(DRAW_PRINTS, prints)
layout(set = 0, binding = DRAW_PRINT_COUNTS, std430) readonly buffer CountsBlock { uint counts[]; };

layout(location = 0) in uint slot;
layout(location = 1) in vec2 fromMiddle;  // in radii
layout(location = 0) out vec2 outFromMiddle;
layout(location = 1) out float outShare;

// What a fresh print dims, and the shares of its life and of the ring's places after which it fades.
const float SHARE = 0.75, STAYS = 0.5, HAS_ROOM = 0.75;

void main() {
  Print print = LOAD_PRINT(slot);
  float age = (constants.tick - print.tick) / constants.life;
  // How many have been left since, by the place in the ring.
  float since = float((counts[PRINT_TOTAL] - 1u - slot) % uint(PRINTS)) / float(PRINTS);
  outShare = SHARE * (1.0 - smoothstep(STAYS, 1.0, age)) * (1.0 - smoothstep(HAS_ROOM, 1.0, since));
  outFromMiddle = fromMiddle;
  gl_Position = decalAt(decalField(), placeOf(print).xz + fromMiddle * print.radius, outShare);
}
