#version 460
layout(constant_id = 0) const float share = 1.0;
layout(location = 0) in float along;
layout(location = 0) out vec4 outColour;

void main() { outColour = vec4(share * along); }
