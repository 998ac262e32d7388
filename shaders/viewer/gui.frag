#version 460
layout(set = 0, binding = 0) uniform sampler2D coverage;
layout(location = 0) in vec2 place;
layout(location = 1) in vec4 colour;
layout(location = 0) out vec4 outColour;

void main() { outColour = vec4(colour.rgb, colour.a * texture(coverage, place).r); }
