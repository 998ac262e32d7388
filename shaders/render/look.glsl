// The two looks of occlusion go through the camera's lists, whose agents are triangles.
layout(local_size_x = WORK_GROUP) in;
layout(push_constant) uniform ConstantBlock { OcclusionConstants constants; };
#include "fade.glsl"
#include "lists.glsl"

// Whether an agent of the page was shown by the last picture in which it was on a list.
layout(set = 0, binding = DRAW_SEEN, std430) buffer Seen { uint seen[]; };

uint agentOf(uint entry) { return entry & ((1u << FADE_SHIFT) - 1u); }
