#ifndef MATH_GLSL
#define MATH_GLSL

vec3 unit(vec3 v) { return v * inversesqrt(max(dot(v, v), 1e-20)); }
vec2 unit(vec2 v) { return v * inversesqrt(max(dot(v, v), 1e-20)); }

vec3 rotate(vec4 q, vec3 v) {
  vec3 t = 2.0 * cross(q.xyz, v);
  return v + q.w * t + cross(q.xyz, t);
}
vec3 rotateBack(vec4 q, vec3 v) { return rotate(vec4(-q.xyz, q.w), v); }

mat3 matrixOf(vec4 q) {
  vec3 t = 2.0 * q.xyz;
  vec3 d = t * q.xyz, w = t * q.w;
  float xy = t.x * q.y, xz = t.x * q.z, yz = t.y * q.z;
  return mat3(1.0 - d.y - d.z, xy + w.z, xz - w.y, xy - w.z, 1.0 - d.x - d.z, yz + w.x, xz + w.y, yz - w.x,
              1.0 - d.x - d.y);
}

vec4 quaternionProduct(vec4 a, vec4 b) {
  return vec4(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz));
}

// Quaternion of the rotation with orthonormal columns x, y, z: of its four forms, the best conditioned one.
vec4 quaternionFromColumns(vec3 x, vec3 y, vec3 z) {
  float sx = 1.0 + x.x - y.y - z.z, sy = 1.0 - x.x + y.y - z.z;
  float sz = 1.0 - x.x - y.y + z.z, sw = 1.0 + x.x + y.y + z.z;
  vec4 qx = vec4(sx, x.y + y.x, z.x + x.z, y.z - z.y);
  vec4 qy = vec4(x.y + y.x, sy, y.z + z.y, z.x - x.z);
  vec4 qz = vec4(z.x + x.z, y.z + z.y, sz, x.y - y.x);
  vec4 qw = vec4(y.z - z.y, z.x - x.z, x.y - y.x, sw);
  vec4 q = qw;
  float largest = sw;
  if (sx > largest) { q = qx; largest = sx; }
  if (sy > largest) { q = qy; largest = sy; }
  if (sz > largest) { q = qz; largest = sz; }
  return q * inversesqrt(max(dot(q, q), 1e-20));
}

// Rotation about +Y by 2 atan(theta / 2): for the small angles of a tick or a step the same as theta, and
// without a trigonometric function, whose precision differs between devices.
vec3 turn(float theta, vec3 v) {
  float t = 0.5 * theta, d = 1.0 / (1.0 + t * t);
  float c = (1.0 - t * t) * d, s = 2.0 * t * d;
  return vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
}

float squared(float x) { return x * x; }

bool finite(vec3 v) { return !(any(isnan(v)) || any(isinf(v))); }

#endif
