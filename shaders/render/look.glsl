// The camera's lists, whose agents are triangles, as the two looks of occlusion go through them.
layout(local_size_x = WORK_GROUP) in;
layout(push_constant) uniform ConstantBlock { OcclusionConstants constants; };
#include "fade.glsl"
#include "lists.glsl"

// Of an agent of the page: whether the last picture in which it was on a list showed it.
layout(set = 0, binding = DRAW_SEEN, std430) buffer Seen { uint seen[]; };

int cameraList(int i) { return i < CAMERA_LODS ? i : FADING; }
uint agentOf(uint entry) { return entry & ((1u << FADE_SHIFT) - 1u); }
