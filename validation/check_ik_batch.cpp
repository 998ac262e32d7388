#include "validation/check_ik_batch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <random>

#include "cpu_reference/ik/columns.h"
#include "cpu_reference/roundoff.h"
#include "validation/convert_ik.h"

namespace skitter::validation {
namespace {

using reference::IkResult;
using reference::IkSolver;
using reference::IkState;

// How far apart rounding can bring two solves depends on the chain, the pose and the solver: a fully
// stretched chain or a nearly singular matrix amplifies it. It is measured rather than bounded in advance: a
// float iteration is as good as an exact one whose input is off by the roundings that it makes (backward
// error analysis), so the reference solves again from input that is off as much, and a batch may be as far
// from it as those solves are. Some 24 operations a bone and 32 more on quantities of at most 1: roundings
// have either sign, so that they add up as the root of their number; four standard deviations, as many
// thousand numbers are compared. Where a bone is turned by theta, a quaternion divides by 1 + cos(theta).
double inputRounding(const IkState& state, size_t bones) {
  double worst = 1;
  for (const glm::dvec2& swing : state.pose.swing) worst = std::max(worst, (1 + glm::dot(swing, swing)) / 2);
  return 4 * std::sqrt(24.0 * static_cast<double>(bones) + 32) * reference::tolerance::roundoff * worst;
}
// Disturbed solves a chain, and more where those do not explain a difference.
constexpr int fewTrials = 4, manyTrials = 64;
// The largest of a few solves disturbed at random is below the worst there may be.
constexpr double safety = 3;
// Disturbed solves that end farther apart than this, a share of the length, went different ways.
constexpr double otherWay = 1e-3;
// Solves that went different ways may end as far apart.
constexpr double elsewhere = 0.05;
// Steepest descent zigzags, and what rounding adds grows from step to step; a share of the error.
constexpr double zigzag = 0.1;

// J J^T of docs/ik.md, the sum over the columns.
glm::dmat3 gramMatrixOf(const reference::IkChain& chain, const IkState& start, const glm::dvec3& attached) {
  glm::dmat3 m(0);
  if (chain.free) {
    for (size_t i = 0; i < chain.bones.size(); ++i) {
      const glm::dvec3 r = attached - start.joints[i];
      if (chain.bones[i].length > 0) m += glm::dmat3(glm::dot(r, r)) - glm::outerProduct(r, r);
    }
    return m;
  }
  for (const reference::JointColumns& joint :
       reference::columnsAt(reference::Posture(chain.bones, start.pose), attached))
    for (const reference::Column& column : joint.columns)
      m += glm::outerProduct(column.movement, column.movement);
  return m;
}

// What the solvers that divide by J J^T + mu I lose beyond that: where the joints cannot move the tip along
// some direction, lambda is e / mu along it, and only by cancelling do the columns not see it. So a step is
// off by some roundings of |column| |lambda|.
double matrixRounding(const reference::IkChain& chain, IkSolver solver, const IkState& start,
                      const glm::dvec3& target) {
  const double e = std::min(start.error(target), 0.5);
  const bool targetAttached = solver == IkSolver::targetAttached;
  const glm::dmat3 m = gramMatrixOf(chain, start, targetAttached ? target : start.joints.back());
  const double trace = m[0][0] + m[1][1] + m[2][2];
  double mu = 0;
  if (solver == IkSolver::pseudoinverse) mu = 1e-6 * trace;
  if (solver == IkSolver::dls || targetAttached) mu = 0.01;
  if (solver == IkSolver::activeSet) mu = 0.25 * e * e + 1e-5;
  if (mu == 0) return 0;
  const glm::dmat3 inverse = glm::inverse(m + glm::dmat3(mu));
  const double norm = std::sqrt(glm::dot(inverse[0], inverse[0]) + glm::dot(inverse[1], inverse[1]) +
                                glm::dot(inverse[2], inverse[2]));
  return 8 * reference::tolerance::roundoff * std::sqrt(trace) * norm * e;
}

// Stretch-align near full stretch: the joints go as sqrt(1 - D), and 1 - D is off by some roundings of 1.
double stretchRounding(IkSolver solver, const glm::dvec3& target) {
  if (solver != IkSolver::stretchAlign) return 0;
  return 4 * reference::tolerance::roundoff / std::sqrt(1 - std::min(glm::length(target), 0.99999));
}

// Two bones folded flat: the height of their triangle is the root of a difference of squares that should be
// 0.
double foldRounding(const reference::IkChain& chain, IkSolver solver, const glm::dvec3& target) {
  if (solver != IkSolver::twoBone) return 0;
  const double least = std::abs(chain.bones[0].length - chain.bones[1].length);
  return glm::length(target) > least ? 0 : std::sqrt(8 * reference::tolerance::roundoff);
}

struct Solved {
  IkResult result;
  std::vector<glm::dvec3> joints;  // shares of the length, in the chain's own axes
};

// One quantity of one chain.
struct Difference {
  const char* quantity;
  size_t joint;
  double error, tolerance;
  glm::dvec3 expected, got;
};

class BatchComparison {
 public:
  explicit BatchComparison(const IkRun& run)
      : run_(run), chain_(referenceOf(run.chain)), layout_(chain_, referenceOf(run.options.solver)) {
    settings_.solver = referenceOf(run.options.solver);
    settings_.tolerance = run.options.tolerance;
    settings_.iterations = static_cast<int>(run.options.iterations);
    settings_.restarts = run.options.restarts;
    settings_.continues = run.options.start == ik::Start::previous;
    settings_.restPull = ik::restPullOf(run.chain, run.options);
    chain_.seeds = seedsOf(layout_, run.seeds);
  }

  IkParity run() {
    for (size_t c = 0; c < run_.targets.size(); ++c) check(c);
    return parity_;
  }

 private:
  struct Input {
    IkState start;
    glm::dvec3 target;
    std::optional<glm::dvec3> last;
  };
  struct Spread {
    std::vector<double> joints;
    double amplified = 0;  // roundings that the solver amplifies
    double error = 0, worstError = 0;
    bool tie = false;
  };

  Input inputOf(size_t c) const {
    Input input{reference::restState(chain_), targetOf(c), {}};
    if (!run_.lastTargets.empty()) input.last = inward(c, run_.lastTargets[c]);
    if (run_.before.empty()) return input;
    const auto record = std::span(run_.before).subspan(c * layout_.stateStride(), layout_.stateStride());
    input.start = stateOf(chain_, layout_, record);
    return input;
  }

  // In the chain's own axes and lengths.
  glm::dvec3 inward(size_t c, const glm::dvec3& point) const {
    if (run_.bases.empty()) return point / chain_.length;
    const ik::Base& base = run_.bases[c];
    return glm::conjugate(glm::dquat(base.rotation)) * (point - glm::dvec3(base.position)) / chain_.length;
  }
  glm::dvec3 targetOf(size_t c) const { return inward(c, run_.targets[c]); }

  Solved solve(const reference::IkChain& chain, const Input& input) const {
    reference::IkMemory memory;
    memory.target = input.last;
    Solved solved{solveIk(chain, settings_, input.target, input.start, memory), {}};
    solved.joints = solved.result.state.joints;
    return solved;
  }

  glm::dvec3 nudge(double by) {
    std::normal_distribution<double> normal;
    const glm::dvec3 v(normal(random_), normal(random_), normal(random_));
    return v * (by / std::max(glm::length(v), 1e-9));
  }

  Input disturbed(const Input& input, double by) {
    Input other = input;
    const glm::dvec3 moved = nudge(by);
    other.target += moved;
    if (other.last) *other.last += moved;
    for (size_t i = 1; i < other.start.joints.size(); ++i) other.start.joints[i] += nudge(by);
    for (size_t i = 0; i < other.start.pose.swing.size(); ++i) {
      if (chain_.bones[i].length == 0) continue;
      glm::dvec2& swing = other.start.pose.swing[i];
      double& twist = other.start.pose.twist[i];
      swing += glm::dvec2(nudge(by)) * ((1 + glm::dot(swing, swing)) / 2);
      twist += nudge(by).x * (1 + twist * twist) / 2;
    }
    return other;
  }

  // By the first step and the last one.
  double amplified(const Input& input, const Solved& expected) const {
    return matrixRounding(chain_, settings_.solver, input.start, input.target) +
           matrixRounding(chain_, settings_.solver, expected.result.state, input.target) +
           stretchRounding(settings_.solver, input.target) +
           foldRounding(chain_, settings_.solver, input.target);
  }

  void disturb(const Input& input, const Solved& expected, int trials, Spread& spread) {
    const double by = inputRounding(input.start, chain_.bones.size());
    reference::IkChain chain = chain_;
    for (int trial = 0; trial < trials; ++trial) {
      // Lengths are rounded too: where a chain is all but stretched, what is left of the reach is as
      // uncertain.
      for (size_t i = 0; i < chain.bones.size(); ++i)
        chain.bones[i].length = chain_.bones[i].length * (1 + nudge(4 * reference::tolerance::roundoff).x);
      const Solved other = solve(chain, disturbed(input, by));
      spread.tie = spread.tie || other.result.stop != expected.result.stop ||
                   other.result.iterations != expected.result.iterations;
      spread.worstError = std::max(spread.worstError, other.result.error);
      spread.error = std::max(spread.error, std::abs(other.result.error - expected.result.error));
      for (size_t j = 0; j < expected.joints.size(); ++j) {
        const double apart = glm::length(other.joints[j] - expected.joints[j]);
        spread.joints[j] = std::max(spread.joints[j], apart);
        spread.tie = spread.tie || apart > otherWay;
      }
    }
  }

  std::vector<Difference> differences(size_t c, const Solved& expected, const Spread& spread) const {
    const ik::Report& got = run_.reports[c];
    const double least = inputRounding(expected.result.state, chain_.bones.size());
    if (spread.tie) return {tied(expected, got, spread, least)};
    std::vector<Difference> all;
    const auto exact = [&](const char* quantity, double wanted, double found) {
      all.push_back({quantity, 0, wanted == found ? 0.0 : 1.0, 0.5, glm::dvec3(wanted), glm::dvec3(found)});
    };
    if (!standsStill(expected, got)) {
      exact("stop reason", static_cast<double>(expected.result.stop), static_cast<double>(got.stop));
      exact("iterations", expected.result.iterations, got.iterations);
    }
    double error = safety * spread.error + least * expected.result.iterations + spread.amplified;
    if (settings_.solver == IkSolver::transpose && expected.result.iterations > 1)
      error += zigzag * expected.result.error;
    all.push_back({"error", 0, std::abs(got.error - expected.result.error), error,
                   glm::dvec3(expected.result.error), glm::dvec3(got.error)});
    // Iteration by iteration rounding drifts along the ways that do not move the tip.
    if (isWhole()) return all;
    const double base = run_.bases.empty() ? 0
                                           : glm::length(glm::dvec3(run_.bases[c].position)) / chain_.length *
                                                 8 * reference::tolerance::roundoff;
    for (size_t j = 0; j < expected.joints.size(); ++j) {
      const glm::dvec3 at = inward(c, run_.joints[c * expected.joints.size() + j]);
      all.push_back({"joint", j, glm::length(at - expected.joints[j]),
                     safety * spread.joints[j] + least + spread.amplified + base, expected.joints[j], at});
    }
    return all;
  }

  // A solve stands still when its error changes by less than a thousandth of the tolerance, a dozen
  // roundings: when exactly, and whether at the cap, is theirs to say. A target out of reach hides it.
  static bool standsStill(const Solved& expected, const ik::Report& got) {
    using reference::IkStop;
    const auto may = [](IkStop stop) {
      return stop == IkStop::stall || stop == IkStop::cap || stop == IkStop::unreachable;
    };
    return expected.result.iterations > 1 && may(expected.result.stop) &&
           may(static_cast<IkStop>(got.stop)) &&
           (expected.result.stop != IkStop::cap || got.stop != ik::Stop::cap);
  }

  // A batch that goes another way in one iteration comes as near to the target as the reference may. Over a
  // whole solve it may end elsewhere; what ships must arrive if the reference does whichever way it goes, but
  // for what a float32 error is off by, `rounding`.
  Difference tied(const Solved& expected, const ik::Report& got, const Spread& spread,
                  double rounding) const {
    const double reached = std::max(expected.result.error, spread.worstError);
    const bool ships = settings_.solver == IkSolver::stretchAlign || settings_.solver == IkSolver::activeSet;
    const bool must = ships && reached <= settings_.tolerance;
    return {"error in a tie",
            0,
            std::max(0.0, got.error - std::max(reached, settings_.tolerance)),
            must        ? rounding
            : isWhole() ? elsewhere
                        : otherWay,
            glm::dvec3(expected.result.error),
            glm::dvec3(got.error)};
  }

  bool isWhole() const { return settings_.iterations > 1; }

  static bool passes(const std::vector<Difference>& all) {
    return std::all_of(all.begin(), all.end(), [](const Difference& d) { return d.error <= d.tolerance; });
  }

  void check(size_t c) {
    random_.seed(run_.seed * 0x9e3779b97f4a7c15 + c);
    const Input input = inputOf(c);
    const Solved expected = solve(chain_, input);
    Spread spread{std::vector<double>(expected.joints.size(), 0.0)};
    spread.amplified = amplified(input, expected);
    disturb(input, expected, fewTrials, spread);
    std::vector<Difference> all = differences(c, expected, spread);
    if (!passes(all)) {
      disturb(input, expected, manyTrials, spread);
      // The roundings of dozens of iterations are not all those of their input.
      spread.tie = spread.tie || (isWhole() && !passes(differences(c, expected, spread)));
      all = differences(c, expected, spread);
    }
    ++parity_.chains;
    if (spread.tie) ++parity_.ties;
    for (const Difference& difference : all) note(c, difference);
  }

  void note(size_t c, const Difference& d) {
    const double error = std::isfinite(d.error) ? d.error : std::numeric_limits<double>::infinity();
    const double ratio = error / d.tolerance;
    if (ratio <= parity_.worst && !parity_.text.empty()) return;
    parity_.worst = ratio;
    char text[400];
    std::snprintf(text, sizeof text,
                  "%s, %d joints: %s, seed %llu, chain %zu, joint %zu: off by %.3g, tolerance %.3g, expected "
                  "(%.9g, %.9g, %.9g), got (%.9g, %.9g, %.9g)",
                  run_.name.c_str(), layout_.bones + 1, d.quantity,
                  static_cast<unsigned long long>(run_.seed), c, d.joint, d.error, d.tolerance, d.expected.x,
                  d.expected.y, d.expected.z, d.got.x, d.got.y, d.got.z);
    parity_.text = text;
  }

  const IkRun& run_;
  reference::IkChain chain_;
  IkLayout layout_;
  reference::IkSettings settings_;
  std::mt19937_64 random_;
  IkParity parity_;
};

}  // namespace

IkParity checkIkBatch(const IkRun& run) { return BatchComparison(run).run(); }

}  // namespace skitter::validation
