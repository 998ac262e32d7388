#version 460
// The outputs of crowd.vert for materials: the normal in the first row of the picture, the tangent in the second.
layout(location = 1) in vec3 normal;
layout(location = 6) in vec4 tangent;
layout(location = 0) out vec4 outColour;

void main() { outColour = vec4(gl_FragCoord.y < 1.0 ? normal : tangent.xyz, 1.0); }
