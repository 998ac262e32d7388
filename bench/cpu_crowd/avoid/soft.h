#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "bench/cpu_crowd/avoid/equations.h"
#include "bench/cpu_crowd/laps.h"
#include "bench/cpu_crowd/parts.h"
#include "bench/cpu_crowd/pool.h"

namespace skitter::cpu_avoid {

// Two agents in one place part along a line that follows from their numbers.
inline Vec2<float> partingLine(int32_t a, int32_t b) {
  const auto low = static_cast<uint32_t>(std::min(a, b)), high = static_cast<uint32_t>(std::max(a, b));
  const uint32_t drawn = (low * 0x9E3779B1u) ^ (high * 0x85EBCA77u);
  const Vec2<float> line{static_cast<float>(drawn >> 28) - 7.5f, static_cast<float>(drawn >> 24 & 15) - 7.5f};
  const float scale = (a < b ? 1.0f : -1.0f) / std::sqrt(dot(line, line));
  return {line.x * scale, line.z * scale};
}

// The engine's grid and stage. Blocks of agents follow each other as they lie in the grid.
template <class F>
class SoftAvoider final : public Avoider {
 public:
  SoftAvoider(const Walkers& walkers, int threads)
      : Avoider(walkers.size()),
        walkers_(walkers),
        chunks_(static_cast<size_t>(threads)),
        grid_(walkers, chunks_),
        blocks_(Parts<F>::blocks(walkers.size())),
        scratch_(chunks_),
        pool_(threads) {}

  void tick(size_t part, size_t parts) override {
    const int64_t turn =
        walkers_.tick / std::max<int64_t>(1, std::llround(secondsATurn / double{walkers_.dt}));
    order_ = static_cast<int32_t>(static_cast<uint32_t>(turn) * 0x9E3779B1u);
    overChunks([this](size_t chunk) { grid_.count(chunk); });
    overChunks([this](size_t chunk) { grid_.sum(chunk); });
    grid_.begin();
    overChunks([this](size_t chunk) { grid_.place(chunk); });
    overChunks([this](size_t chunk) { grid_.scatter(chunk); });
    const size_t from = blocks_ * part / parts, blocks = blocks_ * (part + 1) / parts - from;
    pool_.run(Parts<F>::count(blocks), [&](size_t piece, int thread) {
      Scratch& scratch = scratch_[static_cast<size_t>(thread)];
      cpu_crowd::Laps laps(timed_ ? &scratch.seconds : nullptr);
      Parts<F>::eachGroup(piece, blocks, [&](size_t first, size_t last) {
        laps.stage(stageAvoid, from + first, from + last,
                   [&](size_t block) { avoid(block, scratch.nearest); });
      });
    });
  }

  std::vector<cpu_crowd::StageSeconds> stageSeconds() const override {
    return cpu_crowd::sumOf(scratch_, {"grid", "avoid"});
  }

 private:
  enum { stageGrid, stageAvoid };
  static constexpr int width = kWidth<F>;
  static constexpr double secondsATurn = 2;
  struct alignas(64) Scratch {
    Nearest<F> nearest;
    cpu_crowd::Seconds seconds{};
  };

  template <class Work>
  void overChunks(const Work& work) {
    pool_.run(chunks_, [&](size_t chunk, int thread) {
      cpu_crowd::Laps laps(timed_ ? &scratch_[static_cast<size_t>(thread)].seconds : nullptr);
      work(chunk);
      laps.end(stageGrid);
    });
  }

  Neighbour<F> neighbourOf(const Nearest<F>& nearest, int k, size_t first, const Vec2<F>& own) const {
    const auto at = load<Ints<F>>(nearest.at[k]), power = load<Ints<F>>(nearest.power[k]);
    const Ints<F> radii = load<Ints<F>>(&grid_.radius[first]) + lookUp(grid_.radius.data(), at);
    const F metres(1 / walkers_.quanta);
    Neighbour<F> other;
    other.isThere = F(static_cast<float>(k)) < load<F>(nearest.count);
    other.p = {toFloats(lookUp(grid_.x.data(), at) - load<Ints<F>>(&grid_.x[first])) * metres,
               toFloats(lookUp(grid_.z.data(), at) - load<Ints<F>>(&grid_.z[first])) * metres};
    other.d = squareRoot(toFloats(power + radii * radii)) * metres;
    other.radii = toFloats(radii) * metres;
    other.lesser =
        smaller(toFloats(load<Ints<F>>(&grid_.radius[first])), toFloats(lookUp(grid_.radius.data(), at))) *
        metres;
    other.v = {own.x - lookUp(grid_.velocityX.data(), at), own.z - lookUp(grid_.velocityZ.data(), at)};
    other.share = lookUp(grid_.share.data(), at);
    const Ints<F> order(order_);
    other.goesFirst = (F(0.75f) < other.share) | isBelow(lookUp(grid_.number.data(), at) ^ order,
                                                         load<Ints<F>>(&grid_.number[first]) ^ order);
    other.part = {F(0), F(0)};
    if (const Mask<F> together = other.isThere & (other.d <= F(0)); any(together)) {
      for (int i = 0; i < width; ++i) {
        const Vec2<float> line = partingLine(grid_.number[first + static_cast<size_t>(i)],
                                             grid_.number[static_cast<size_t>(nearest.at[k][i])]);
        lane(other.part.x, i) = line.x;
        lane(other.part.z, i) = line.z;
      }
    }
    return other;
  }

  void avoid(size_t block, Nearest<F>& nearest) {
    const size_t first = block * size_t{width};
    const int here = static_cast<int>(std::min(size_t{width}, walkers_.size() - first));
    nearest.begin();
    for (int i = 0; i < width; ++i) {
      if (i < here)
        findNearest(grid_, walkers_.look, static_cast<int32_t>(first) + i, i, nearest);
      else
        nearest.tell(i, 0);
    }
    const auto number = load<Ints<F>>(&grid_.number[first]);
    const auto own = [&](const std::vector<float>& of) { return lookUp(of.data(), number); };
    const Vec2<F> velocity{load<F>(&grid_.velocityX[first]), load<F>(&grid_.velocityZ[first])};
    Wish<F> wish({own(walkers_.wantedX), own(walkers_.wantedZ)});
    const F speed = own(walkers_.speed), room = roomOf(speed, wish.speed);
    const float look = static_cast<float>(walkers_.look) / walkers_.quanta;
    const float hold = static_cast<float>(walkers_.round) * walkers_.dt;
    HalfPlane<F> planes[mostNeighbours];
    CellSide<F> sides[mostNeighbours];
    for (int k = 0; k < nearest.most; ++k) {
      const Neighbour<F> other = neighbourOf(nearest, k, first, velocity);
      wish.see(other);
      planes[k] = halfPlaneOf(other, velocity, room, look);
      sides[k] = cellSideOf(other, velocity, hold, walkers_.legLength);
    }
    Vec2<F> v = wish.wanted(speed);
    if (isForbidden(planes, nearest.most, v)) v = solved(planes, nearest.most, v);
    const Vec2<F> heading{own(walkers_.headingX), own(walkers_.headingZ)};
    v = withinCell(sides, nearest.most, resultOf(v, wish, heading, walkers_.legLength));
    const F most = speedAlong(sides, nearest.most, heading, walkers_.legLength);
    for (int i = 0; i < here; ++i) {
      float* record = &records_[4 * static_cast<size_t>(grid_.number[first + static_cast<size_t>(i)])];
      record[0] = lane(v.x, i), record[1] = lane(v.z, i), record[2] = -nearest.seen[i],
      record[3] = lane(most, i);
    }
  }

  const Walkers& walkers_;
  size_t chunks_;
  int32_t order_ = 0;  // of who goes first
  Grid<F> grid_;
  size_t blocks_;
  std::vector<Scratch> scratch_;
  cpu_crowd::Pool pool_;
};

std::unique_ptr<Avoider> simdSoftAvoider(const Walkers& walkers, int threads);
std::unique_ptr<Avoider> scalarSoftAvoider(const Walkers& walkers, int threads);

}  // namespace skitter::cpu_avoid
