// A vertex of an agent, carried by up to four bones. Each influence brings the vertex relative to the rest
// start of its bone, so that a bone costs two loads: rotation and joint position.
#include "lib/load4.glsl"
#include "lib/math.glsl"

layout(constant_id = CONSTANT_INFLUENCES) const int INFLUENCES = 4;
layout(constant_id = CONSTANT_MATRICES) const bool MATRICES = false;
layout(constant_id = CONSTANT_STUMPS) const bool STUMPS = false;
layout(push_constant) uniform ConstantBlock { CrowdConstants constants; };
LOAD4_BUFFER(DRAW_BODY, bodies)
LOAD4_BUFFER(DRAW_POSE, poses)

#ifdef FADES
#include "fade.glsl"
layout(location = 0) in uint instance;
layout(location = FADE_LOCATION) flat out uint outFade;
uint agent = instance & ((1u << FADE_SHIFT) - 1u);
#else
layout(location = 0) in uint agent;
#endif
layout(location = 1) in uvec4 bones;
layout(location = 2) in vec4 influence0;  // vertex - rest start, weight
layout(location = 3) in vec4 influence1;
layout(location = 4) in vec4 influence2;
layout(location = 5) in vec4 influence3;
layout(location = 6) in vec3 normal;      // ribbons have none
layout(location = 7) in float halfWidth;  // of a ribbon, metres, of either sign; 0 on surfaces

#ifdef WORN
layout(location = 10) in vec4 tangent;  // to the image's right; w: the side of its top
#endif

struct Skinned {
  vec3 position, normal;  // picture space
  vec3 body;              // the agent's position
  vec3 first, second;     // relative to it, where the first two influences alone would bring the vertex
#ifdef WORN
  vec3 tangent;
#endif
};

void influence(uint bone, vec4 part, vec3 normal, inout Skinned s, out vec3 place) {
  int entry = (int(agent * constants.palette) + int(bone)) * (MATRICES ? MATRIX_STRIDE : POSE_STRIDE);
  if (MATRICES) {
    vec4 a = LOAD4(poses, entry), b = LOAD4(poses, entry + 1), c = LOAD4(poses, entry + 2);
    place = vec3(dot(a, vec4(part.xyz, 1.0)), dot(b, vec4(part.xyz, 1.0)), dot(c, vec4(part.xyz, 1.0)));
    s.position += part.w * place;
    // Cofactors: the inverse transpose but for its scale.
    s.normal += part.w * vec3(dot(cross(b.xyz, c.xyz), normal), dot(cross(c.xyz, a.xyz), normal),
                              dot(cross(a.xyz, b.xyz), normal));
#ifdef WORN
    s.tangent += part.w * vec3(dot(a.xyz, tangent.xyz), dot(b.xyz, tangent.xyz), dot(c.xyz, tangent.xyz));
#endif
    return;
  }
  vec4 rotation = LOAD4(poses, entry), start = LOAD4(poses, entry + 1);
  // The skin of a lost bone meets in the stump's end, so that the skin before it stays closed.
  vec3 about = STUMPS && start.w != 0.0 ? vec3(0.0) : part.xyz;
  place = start.xyz + rotate(rotation, about);
  s.position += part.w * place;
  s.normal += part.w * rotate(rotation, normal);
#ifdef WORN
  s.tangent += part.w * rotate(rotation, tangent.xyz);
#endif
}

Skinned skinned() {
#ifdef FADES
  outFade = instance >> FADE_SHIFT;
#endif
  vec4 a = LOAD4(bodies, int(agent) * BODY_STRIDE);
  Skinned s;
  s.body = a.xyz + TILE_SIZE * vec3(tileX(a.w) - picture.tile.x, 0.0, tileZ(a.w) - picture.tile.y);
  s.position = s.body;
  s.normal = vec3(0.0);
#ifdef WORN
  s.tangent = vec3(0.0);
#endif
  vec3 place;
  influence(bones.x, influence0, normal, s, s.first);
  s.second = s.first;
  if (INFLUENCES > 1) influence(bones.y, influence1, normal, s, s.second);
  if (INFLUENCES > 2) influence(bones.z, influence2, normal, s, place);
  if (INFLUENCES > 3) influence(bones.w, influence3, normal, s, place);
  return s;
}

// How far a ribbon's normals lean to the side at its edges. Light that is interpolated between them falls on more of
// the ribbon than light from normals between them: with 0.6 the mean is that of a cylinder lit from the side.
#ifdef LIT
const float ROUNDNESS = 0.6;
#else
const float ROUNDNESS = 1.0;
#endif

// Spreads a ribbon across the way to the eye (unit), at least a pixel wide, and rounds it by its normals. Half a pixel
// at either end closes the gap to a ribbon that goes another way.
void spread(inout Skinned s, vec3 toEye, float pixel) {
  if (halfWidth == 0.0) return;
  vec3 along = s.first - s.second;  // out of this end
  along *= inversesqrt(max(dot(along, along), 1e-12));
  vec3 side = cross(along, toEye);
  side *= sign(halfWidth) / max(length(side), 1e-6);
  s.position += side * max(abs(halfWidth), 0.5 * pixel) + along * (0.5 * pixel);
  s.normal = normalize(toEye + ROUNDNESS * side);
}
