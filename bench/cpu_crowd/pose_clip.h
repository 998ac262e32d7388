#pragma once

#include "bench/cpu_crowd/play.h"

namespace skitter::cpu_crowd {

// The matrices of one agent, in planes as in ClipTable. The lanes are numbers of its matrices here: they lie
// side by side, where another agent's frame is anywhere.
template <class F>
[[gnu::flatten]] void poseClip(const ClipTable& table, const Play<float>& play, const Mat3<float>& r,
                               Line* out) {
  const size_t count = table.lines * sizeof(Line) / sizeof(F);
  const auto lanes = [](const Line* lines) { return reinterpret_cast<const F*>(lines); };
  const F *a = lanes(table.frame(play.to.frame)), *b = lanes(table.frame(play.from.frame));
  const F toShare(play.to.fraction), fromShare(play.from.fraction), weight(play.weight);
  const size_t next = 3 * count;
  const bool fades = play.weight < 1;
  F* to = reinterpret_cast<F*>(out);
  for (size_t i = 0; i < count; ++i) {
    const auto blended = [&](const F* frame, const F& share) {
      const F *x = frame + i, *y = x + count, *z = y + count;
      return Vec3<F>{mix(*x, x[next], share), mix(*y, y[next], share), mix(*z, z[next], share)};
    };
    Vec3<F> m = blended(a, toShare);
    if (fades) m = mix(blended(b, fromShare), m, weight);
    const Vec3<F> turned = broadcast<F>(r) * m;
    stream(to + i, turned.x);
    stream(to + count + i, turned.y);
    stream(to + 2 * count + i, turned.z);
  }
}

}  // namespace skitter::cpu_crowd
