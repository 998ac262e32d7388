#version 460
#extension GL_GOOGLE_include_directive : require
#include "render/bindings.h"

layout(set = 0, binding = DRAW_DRAWN) uniform sampler2D drawn;
layout(location = 0) in vec2 at;
layout(location = 0) out vec4 outColour;

void main() { outColour = texture(drawn, at); }
