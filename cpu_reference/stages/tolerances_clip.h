#pragma once

#include "cpu_reference/stages/clip.h"
#include "cpu_reference/stages/tolerances.h"

// As tolerances.h, of the stages that play clips.
namespace skitter::reference::tolerance {

// v_e: one product, one sum.
inline double pace(const Tuning& t, const AgentBody& body) { return 2 * roundoff * body.pace(t); }
// A sum below 2.
inline constexpr double fade = 2 * roundoff;
// Vulkan allows log2 an error of 2^-21 near 1 and 3 ulp elsewhere; its argument errs by v_e's 2 roundoff and
// a quotient's 5, which log2 multiplies by 1 / ln 2; the sums round once or twice more.
inline double clipCost(double cost) { return 0x1p-21 + (12 + 8 * std::abs(cost)) * roundoff; }
// A clip's time: a rate (v_e and a quotient) times dt, a sum, and a multiple of the length taken off.
inline double clipTime(const Tuning& t, double before, double rate) {
  return roundoff * (8 * rate * t.dt + 6 * (before + rate * t.dt));
}
// (t - t_f) times what 1 / (t_(f+1) - t_f) was rounded to.
inline constexpr double fraction = 8 * roundoff;

// A point that blended matrices carry: four roundings a mix and two of them, then four products and their
// sums, each of at most what the frames have without their signs. w = 0 for a direction.
inline double blended(const ClipTable& table, const Play& play, size_t joint, const glm::dvec4& point) {
  glm::dvec3 most(0);
  const auto see = [&](size_t frame) {
    const Affine& m = table.matrix(frame, joint);
    glm::dvec3 sum(0);
    for (int c = 0; c < 4; ++c) sum += glm::abs(m[c]) * std::abs(point[c]);
    most = glm::max(most, sum);
  };
  for (const Play::Played& played : {play.to, play.from}) {
    see(played.frame);
    if (played.fraction > 0) see(played.frame + 1);
  }
  return 16 * roundoff * glm::length(most);
}

}  // namespace skitter::reference::tolerance
