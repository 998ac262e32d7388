#version 460
// Seven operations a turn (a dot product of three, an addition, a root), two outside.
layout(local_size_x = 1) in;
layout(constant_id = 3) const int TURNS = 1;
layout(constant_id = 4) const bool MORE = false;
layout(set = 0, binding = 0, std430) buffer Block { vec4 values[]; };

void main() {
  vec3 v = values[gl_GlobalInvocationID.x].xyz;
  float sum = 0.5;
  for (int i = 0; i < TURNS; ++i) sum = sqrt(sum + dot(v, v));
  if (MORE) sum *= v.x * v.y;
  values[gl_GlobalInvocationID.x].w = sum;
}
