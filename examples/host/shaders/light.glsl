const vec3 SUN = normalize(vec3(0.45, 0.6, 0.35));

vec3 lit(vec3 colour, vec3 normal) {
  return colour * (vec3(1.5, 1.35, 1.1) * max(dot(normal, SUN), 0.0) + mix(vec3(0.16, 0.13, 0.10), vec3(0.26, 0.33, 0.45), 0.5 + 0.5 * normal.y));
}

// Through haze, for a plain attachment.
vec3 seen(vec3 colour, float away) {
  vec3 hazed = mix(vec3(0.62, 0.71, 0.82), colour, exp(-away * away * 6e-5));
  return pow(min(hazed, vec3(1.0)), vec3(1.0 / 2.2));
}
