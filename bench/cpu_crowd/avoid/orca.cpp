#include "bench/cpu_crowd/avoid/orca.h"

#include <algorithm>
#include <vector>

#include "bench/cpu_crowd/avoid/walkers.h"
#include "bench/cpu_crowd/laps.h"
#include "bench/cpu_crowd/pool.h"
#include "skitter/records.h"

namespace skitter::cpu_avoid {
namespace {

constexpr size_t partAgents = 128;     // that a thread takes at a time
constexpr size_t subtreesAThread = 8;  // so that all threads are done at about the same time

// Agents are looked at in the order of the tree: the neighbours of the next one are near in memory to those
// of the last one.
class OrcaAvoider final : public Avoider {
 public:
  OrcaAvoider(const Walkers& walkers, int threads)
      : Avoider(walkers.size()),
        walkers_(walkers),
        tree_(walkers.size(), threads > 1 ? subtreesAThread * static_cast<size_t>(threads) : 1),
        moving_(walkers.size()),
        scratch_(static_cast<size_t>(threads)),
        pool_(threads) {
    for (const int32_t radius : walkers.radius) widest_ = std::max(widest_, radius);
  }

  void tick(size_t part, size_t parts) override {
    const size_t all = walkers_.size();
    overAgents(stageTree, 0, all, [this](size_t i) { move(tree_.points()[i]); });
    const auto begin = [this](size_t) { tree_.begin(); };
    over(stageTree, 1, begin);
    over(stageTree, tree_.pieces(), [this](size_t piece) { tree_.finish(piece); });
    overAgents(stageTree, 0, all, [this](size_t i) { moving_[i] = movingOf(tree_.points()[i].number); });
    overAgents(stageAvoid, all * part / parts, all * (part + 1) / parts,
               [this](size_t i) { avoid(static_cast<uint32_t>(i)); });
  }

  std::vector<cpu_crowd::StageSeconds> stageSeconds() const override {
    return cpu_crowd::sumOf(scratch_, {"tree", "avoid"});
  }

 private:
  enum { stageTree, stageAvoid };
  struct alignas(64) Scratch {
    cpu_crowd::Seconds seconds{};
  };
  // What others see of an agent beside its place; metres.
  struct Moving {
    float velocityX, velocityZ, radius, share;
  };

  template <class Work>
  void over(size_t stage, size_t pieces, const Work& work) {
    pool_.run(pieces, [&](size_t piece, int thread) {
      cpu_crowd::Laps laps(timed_ ? &scratch_[static_cast<size_t>(thread)].seconds : nullptr);
      work(piece);
      laps.end(stage);
    });
  }
  template <class Work>
  void overAgents(size_t stage, size_t begin, size_t end, const Work& work) {
    over(stage, (end - begin + partAgents - 1) / partAgents, [&](size_t piece) {
      const size_t first = begin + piece * partAgents, last = std::min(first + partAgents, end);
      for (size_t i = first; i < last; ++i) work(i);
    });
  }

  // Places are whole quanta, as for the engine.
  void move(KdTree::Point& point) const {
    const float quanta = walkers_.quanta, tile = shared::TILE_SIZE * quanta, metres = 1 / quanta;
    const size_t i = point.number;
    point.x = (walkers_.tileX[i] * tile + std::floor(walkers_.localX[i] * quanta)) * metres;
    point.z = (walkers_.tileZ[i] * tile + std::floor(walkers_.localZ[i] * quanta)) * metres;
  }
  Moving movingOf(size_t i) const {
    return {walkers_.speed[i] * walkers_.headingX[i], walkers_.speed[i] * walkers_.headingZ[i],
            static_cast<float>(walkers_.radius[i]) / walkers_.quanta, walkers_.share[i]};
  }

  void avoid(uint32_t i) {
    const std::vector<KdTree::Point>& points = tree_.points();
    const Moving& self = moving_[i];
    const size_t number = points[i].number;
    const auto reach = static_cast<float>(walkers_.radius[number] + widest_ + walkers_.look);
    const KdTree::Found found = tree_.nearest(i, reach / walkers_.quanta);
    const Velocity own{self.velocityX, self.velocityZ};
    Allowed planes[orcaNeighbours];
    for (size_t k = 0; k < found.count; ++k) {
      const KdTree::Point& there = points[found.at[k]];
      const Moving& other = moving_[found.at[k]];
      planes[k] = orcaOf({there.x - points[i].x, there.z - points[i].z},
                         {own.x - other.velocityX, own.z - other.velocityZ}, own,
                         double{self.radius} + other.radius, other.share);
    }
    const Velocity desired{walkers_.wantedX[number], walkers_.wantedZ[number]};
    const double speed = std::max(std::sqrt(dot(desired, desired)), orcaPushSpeed * walkers_.legLength);
    const std::span<const Allowed> all(planes, found.count);
    Velocity v;
    const size_t had = solveProgram(all, speed, {Aim::Kind::nearest, desired}, v);
    if (had < all.size()) solveLeastViolation<orcaNeighbours>(all, had, speed, v);
    float* record = &records_[4 * number];
    record[0] = static_cast<float>(v.x), record[1] = static_cast<float>(v.z);
    record[2] = 0, record[3] = static_cast<float>(found.count);
  }

  const Walkers& walkers_;
  int32_t widest_ = 1;
  KdTree tree_;
  std::vector<Moving> moving_;  // in the order of the tree
  std::vector<Scratch> scratch_;
  cpu_crowd::Pool pool_;
};

}  // namespace

std::unique_ptr<Avoider> orcaAvoider(const Walkers& walkers, int threads) {
  return std::make_unique<OrcaAvoider>(walkers, threads);
}

}  // namespace skitter::cpu_avoid
