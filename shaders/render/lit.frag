#version 460
// Shades agents that are small in the picture, whose vertices are lit.
layout(location = 0) in vec3 colour;
layout(location = 0) out vec4 outColour;

void main() { outColour = vec4(colour, 1.0); }
