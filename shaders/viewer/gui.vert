#version 460
// Dear ImGui's triangles. Positions are pixels from the top left corner.
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 place;
layout(location = 2) in vec4 colour;
layout(location = 0) out vec2 placeOut;
layout(location = 1) out vec4 colourOut;
layout(push_constant) uniform Push { vec2 size; };

// Colours are given as sRGB, and the picture blends light.
vec3 linear(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045))); }

void main() {
  gl_Position = vec4(2.0 * position / size - 1.0, 0.0, 1.0);
  placeOut = place;
  colourOut = vec4(linear(colour.rgb), colour.a);
}
