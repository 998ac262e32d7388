#include "cpu_reference/ik/restarts.h"

#include <algorithm>
#include <limits>

#include "cpu_reference/ik/deadlock.h"
#include "cpu_reference/ik/pace.h"
#include "cpu_reference/ik/pole.h"
#include "cpu_reference/ik/seeds.h"

namespace skitter::reference {
namespace {

// Measured on 100,000 targets a case; docs/ik.md, Restarts.
constexpr double slowShare = 0.8;     // of the error before a step: the attempt gets nowhere
constexpr int longestAttempt = 8;     // iterations
constexpr double stillShare = 0.999;  // of the error before a step: the pose stands still
constexpr int stillSteps = 4;         // in a row: of an attempt that nothing can follow
constexpr double poseWeight = 0.1;    // of a seed's distance from the start pose against its tip's
constexpr double leapShare = 0.5;     // of the first attempt's error: worth leaving the last solve's pose for
constexpr double leapGain = 0.02;     // likewise, of the error, where the target is slow
constexpr int longestPause = 32;      // solves
constexpr double bendsAway = -1e-3;
constexpr double cells = 16;  // each way, of the cube from -1 to 1

struct Seed {
  IkState state;
  bool tried = false;
};

class RestartSearch {
 public:
  RestartSearch(const IkChain& chain, const IkSettings& settings, const glm::dvec3& target,
                const IkState& start)
      : chain_(chain), settings_(settings), target_(target), origin_(start), shapes_(aimsSeeds(chain)) {
    for (const Pose& pose : chain.seeds) {
      const IkState seed = stateAt(chain, pose);
      if (!bendsWrong(seed)) seeds_.push_back({seed});
    }
  }

  bool replaced() const { return replaced_; }

  IkResult run(IkMemory& memory) {
    const IkState* wanted = bendsWrong(origin_) ? nearestSeed() : isFarFromRest() ? seedOfCell() : nullptr;
    const IkState& first = wanted ? *wanted : origin_;
    const bool shape = wanted && shapes_;
    const bool paused = settings_.continues && memory.pause > 0;
    const bool mayRestart = settings_.restarts && !paused && untried();

    isSlow_ = memory.target && glm::length(target_ - *memory.target) < fastTarget;
    attempt(first, shape, mayRestart ? Ends::whenSlow : Ends::whenStill,
            std::numeric_limits<double>::infinity());
    const bool restarted = mayRestart && restart();
    const bool arrived = error_ <= settings_.tolerance;
    remember(arrived || replaced_, restarted, memory);
    return {best_, error_, iterations_, arrived ? IkStop::tolerance : stop()};
  }

 private:
  enum class Ends { whenSlow, whenStill };

  bool bendsWrong(const IkState& state) const {
    return chain_.pole && bendToward(*chain_.pole, state.joints) < bendsAway;
  }

  bool untried() const {
    return std::any_of(seeds_.begin(), seeds_.end(), [](const Seed& seed) { return !seed.tried; });
  }

  // What of a joint seeds are compared by: shapes point anywhere.
  glm::dvec3 compared(const glm::dvec3& joint) const {
    return shapes_ ? glm::dvec3(glm::length(joint), 0, 0) : joint;
  }

  double distance(const IkState& seed) const {
    const size_t n = chain_.bones.size();
    double apart = 0;
    for (size_t i = 1; i <= n; ++i) {
      const glm::dvec3 d = compared(seed.joints[i]) - compared(origin_.joints[i]);
      apart += glm::dot(d, d) / static_cast<double>(n);
    }
    const glm::dvec3 d = compared(seed.joints[n]) - compared(target_);
    return glm::dot(d, d) + poseWeight * apart;
  }

  // Marks the nearest one as tried; null where there is none.
  const IkState* nearestSeed() {
    Seed* nearest = nullptr;
    for (Seed& seed : seeds_) {
      if (!seed.tried && (!nearest || distance(seed.state) < distance(nearest->state))) nearest = &seed;
    }
    if (!nearest) return nullptr;
    nearest->tried = true;
    return &nearest->state;
  }

  bool isFarFromRest() const {
    return settings_.restarts && !settings_.continues && origin_.error(target_) > settings_.tolerance;
  }

  // The middle of the target's cell; of shapes, of the shell that it is in.
  glm::dvec3 middleOfCell() const {
    if (!shapes_) {
      const glm::dvec3 cell = glm::clamp(glm::floor((target_ + 1.0) * (cells / 2)), 0.0, cells - 1);
      return (cell + 0.5) * (2 / cells) - 1.0;
    }
    constexpr double shells = cells * cells * cells;
    return {(std::min(std::floor(glm::length(target_) * shells), shells - 1) + 0.5) / shells, 0, 0};
  }

  // Marks the seed of the target's cell as tried; null where that is the pose at rest.
  const IkState* seedOfCell() {
    const glm::dvec3 middle = middleOfCell();
    Seed* nearest = nullptr;
    double least = shapes_ ? std::numeric_limits<double>::infinity() : origin_.error(middle);
    for (Seed& seed : seeds_) {
      const double apart = glm::length(compared(seed.state.joints.back()) - middle);
      if (apart < least) {
        nearest = &seed;
        least = apart;
      }
    }
    if (!nearest) return nullptr;
    nearest->tried = true;
    return &nearest->state;
  }

  // Whether any attempt was made from a seed.
  bool restart() {
    const double firstError = error_;
    bool any = false;
    const double leap = isSlow_ ? leapGain : 0;
    while (error_ > settings_.tolerance && firstError > leap && iterations_ < most(Ends::whenSlow)) {
      const IkState* seed = nearestSeed();
      if (!seed) break;
      any = true;
      const double bound = settings_.continues ? std::min(leapShare * firstError, firstError - leap) : error_;
      replaced_ = attempt(*seed, shapes_, Ends::whenSlow, std::min(bound, error_)) || replaced_;
    }
    if (error_ > settings_.tolerance) attempt(IkState(best_), false, Ends::whenStill, error_);
    return any;
  }

  // Attempts that may be followed by another leave a quarter of the iterations, to bring the best pose nearer
  // to a target out of reach than attempts that are cut short do.
  int most(Ends ends) const {
    return ends == Ends::whenStill ? settings_.iterations : settings_.iterations - settings_.iterations / 4;
  }

  bool isPulled() const { return settings_.restPull > 0 && iterations_ == 0; }

  // Iterates from `start`. The best pose of it is the result if its error is below `bound`; whether it is. A
  // shape strives to reach as far as the target, and is then aimed.
  bool attempt(const IkState& start, bool shape, Ends ends, double bound) {
    const glm::dvec3 goal = shape ? glm::length(target_) * normalized(start.joints.back()) : target_;
    IkState best = start, state = start;
    if (iterations_ == 0 && (!settings_.restarts || seeds_.empty())) breakDeadlock(chain_, target_, state);
    if (iterations_ > 0) state.damping = 1;
    double least = best.error(goal), error = state.error(goal);
    int slow = 0;
    for (int k = 0; (isOpen(settings_, iterations_, least) || isPulled()) && iterations_ < most(ends); ++k) {
      if (ends == Ends::whenSlow ? slow >= 1 || k >= longestAttempt : slow >= stillSteps) break;
      iterate(chain_, settings_, goal, iterations_++, state);
      const double before = error;
      error = state.error(goal);
      slow = error > (ends == Ends::whenSlow ? slowShare : stillShare) * before ? slow + 1 : 0;
      if (error < least || error <= settings_.tolerance) {
        least = error;
        best = state;
      }
    }
    if (shape) {
      best = aimed(chain_, best, target_);
      least = best.error(target_);
    }
    if (least >= bound) return false;
    best_ = best;
    best_.damping = state.damping;
    error_ = least;
    return true;
  }

  IkStop stop() const {
    if (glm::length(target_) > 1) return IkStop::unreachable;
    return iterations_ == settings_.iterations ? IkStop::cap : IkStop::stall;
  }

  static void remember(bool well, bool restarted, IkMemory& memory) {
    if (well) {
      memory.pause = memory.nextPause = 0;
    } else if (restarted) {
      memory.pause = memory.nextPause;
      memory.nextPause = std::clamp(2 * memory.nextPause, 1, longestPause);
    } else if (memory.pause > 0) {
      --memory.pause;
    }
  }

  const IkChain& chain_;
  const IkSettings& settings_;
  const glm::dvec3 target_;
  const IkState origin_;
  const bool shapes_;  // seeds are
  std::vector<Seed> seeds_;
  IkState best_;
  double error_ = 0;
  int iterations_ = 0;
  bool replaced_ = false;
  bool isSlow_ = false;  // the target
};

}  // namespace

IkResult solveWithRestarts(const IkChain& chain, const IkSettings& settings, const glm::dvec3& target,
                           const IkState& start, IkMemory& memory, bool& jumped) {
  RestartSearch search(chain, settings, target, start);
  const IkResult result = search.run(memory);
  jumped = search.replaced();
  return result;
}

}  // namespace skitter::reference
