#include "cpu_reference/ik/solve.h"

#include <algorithm>
#include <stdexcept>

#include "cpu_reference/ik/active_set.h"
#include "cpu_reference/ik/ccd.h"
#include "cpu_reference/ik/deadlock.h"
#include "cpu_reference/ik/dissertation.h"
#include "cpu_reference/ik/fabrik.h"
#include "cpu_reference/ik/jacobian.h"
#include "cpu_reference/ik/loop.h"
#include "cpu_reference/ik/pace.h"
#include "cpu_reference/ik/pole.h"
#include "cpu_reference/ik/restarts.h"
#include "cpu_reference/ik/stretch_align.h"
#include "cpu_reference/ik/two_bone.h"

namespace skitter::reference {
namespace {

constexpr int trackingChords = 3;  // after a step of a solve that continues another

bool isDissertation(IkSolver solver) {
  return solver == IkSolver::dissertationKeep || solver == IkSolver::dissertationEdge;
}

bool isFinite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

OutOfCone outOfCone(IkSolver solver) {
  return solver == IkSolver::dissertationKeep ? OutOfCone::keep : OutOfCone::edge;
}

void stretchOrKeep(const IkChain& chain, const IkSettings& settings, const glm::dvec3& target,
                   Joints& joints) {
  Joints stretched = joints;
  stretchAlign(chain, target, settings.tolerance, settings.continues, stretched);
  if (glm::length(target - stretched.back()) < glm::length(target - joints.back())) joints = stretched;
}

void iterateJoints(const IkChain& chain, const IkSettings& settings, const glm::dvec3& target, int k,
                   Joints& joints) {
  switch (settings.solver) {
    case IkSolver::dissertationKeep:
    case IkSolver::dissertationEdge:
      return dissertation(outOfCone(settings.solver), chain.bones, target, joints);
    case IkSolver::ccd:
      return ccd(chain.bones, target, joints);
    case IkSolver::transpose:
    case IkSolver::pseudoinverse:
    case IkSolver::dls:
    case IkSolver::targetAttached:
      return jacobian(methodOf(settings.solver), chain.bones, target, joints);
    case IkSolver::twoBone:
      return twoBone(chain, target, joints);
    case IkSolver::stretchAlign:
      if (k == 0) return stretchOrKeep(chain, settings, target, joints);
      [[fallthrough]];
    default:
      return fabrik(chain.bones, target, joints);
  }
}

void iteratePose(const IkChain& chain, const IkSettings& settings, const glm::dvec3& target, IkState& state) {
  Posture posture(chain.bones, state.pose);
  switch (settings.solver) {
    case IkSolver::activeSet:
      activeSet({.restPull = state.damping > 1 ? 0 : settings.restPull,
                 .pullError = 0.05,
                 .tolerance = settings.tolerance,
                 .chords = settings.continues ? trackingChords : 0,
                 .ifNear = true},
                target, posture, state.damping);
      break;
    case IkSolver::ccd:
      ccd(target, posture);
      break;
    case IkSolver::fabrik:
      fabrik(target, posture);
      break;
    default:
      jacobian(methodOf(settings.solver), target, posture);
  }
  state.pose = posture.pose();
  state.joints = posture.joints();
}

IkState begun(const IkChain& chain, const IkSettings& settings, const IkState& start) {
  IkState state =
      movesJoints(chain, settings) ? IkState{start.pose, start.joints} : stateAt(chain, start.pose);
  if (settings.continues) state.damping = start.damping;
  return state;
}

IkResult straightToward(const IkChain& chain, const IkSettings& settings, const glm::dvec3& target) {
  const IkState state{{}, laidOut(chain.bones, std::vector(chain.bones.size(), normalized(target)))};
  const double error = state.error(target);
  return {state, error, 1, error <= settings.tolerance ? IkStop::tolerance : IkStop::unreachable};
}

void bendStraight(const IkChain& chain, const IkSettings& settings, const glm::dvec3& target,
                  IkState& state) {
  if (movesJoints(chain, settings)) {
    breakDeadlock(chain, target, state.joints);
  } else {
    breakDeadlock(chain, target, state);
  }
}

IkResult solveOnce(const IkChain& chain, const IkSettings& settings, const glm::dvec3& target,
                   const IkState& start) {
  IkState state = start;
  // Stretch-align gives a chain that hardly bends an arc itself.
  if (settings.solver != IkSolver::stretchAlign) bendStraight(chain, settings, target, state);
  const bool closed = settings.solver == IkSolver::twoBone;
  const auto loop = iterateUntilDone(
      settings, closed ? std::min(settings.iterations, 1) : settings.iterations, start, state,
      [&](const IkState& s) { return s.error(target); },
      [&](int k, IkState& s) { iterate(chain, settings, target, k, s); },
      settings.solver == IkSolver::stretchAlign ? 1 : 0);
  IkResult result{loop.best, loop.error, loop.iterations, loop.stop};
  // What a closed form does not reach lies nearer than two bones can fold.
  const bool beyond = closed || (!chain.free && glm::length(target) > 1);
  if (beyond && result.stop != IkStop::tolerance) result.stop = IkStop::unreachable;
  return result;
}

}  // namespace

Jacobian methodOf(IkSolver solver) {
  switch (solver) {
    case IkSolver::transpose:
      return Jacobian::transpose;
    case IkSolver::pseudoinverse:
      return Jacobian::pseudoinverse;
    case IkSolver::targetAttached:
      return Jacobian::targetAttached;
    default:
      return Jacobian::dls;
  }
}

bool movesJoints(const IkChain& chain, const IkSettings& settings) {
  return chain.free || isDissertation(settings.solver);
}

bool accepts(const IkChain& chain, IkSolver solver) {
  if (solver == IkSolver::twoBone) return chain.free && chain.bones.size() == 2;
  if (solver == IkSolver::stretchAlign) return chain.free;
  if (solver == IkSolver::activeSet) return !chain.free;
  return !isDissertation(solver) ||
         std::all_of(chain.bones.begin(), chain.bones.end(), [](const BoneRest& bone) {
           return (bone.kind == LimitKind::free || bone.kind == LimitKind::cone) &&
                  bone.tanHalfTwistLow == 0 && bone.tanHalfTwistHigh == 0;
         });
}

void iterate(const IkChain& chain, const IkSettings& settings, const glm::dvec3& target, int k,
             IkState& state) {
  if (movesJoints(chain, settings)) {
    iterateJoints(chain, settings, target, k, state.joints);
  } else {
    iteratePose(chain, settings, target, state);
  }
}

IkResult solveIk(const IkChain& chain, const IkSettings& settings, const glm::dvec3& target,
                 const IkState& start, IkMemory& memory) {
  if (!accepts(chain, settings.solver)) throw std::invalid_argument("the solver does not accept this chain");
  const IkState state = begun(chain, settings, start);
  if (!isFinite(target)) return {state, 0, 0, IkStop::skipped};
  IkResult result;
  bool jumped = false;
  if (settings.solver == IkSolver::activeSet) {
    result = solveWithRestarts(chain, settings, target, state, memory, jumped);
  } else {
    result =
        movesJoints(chain, settings) && glm::length(target) >= 1 && isOpen(settings, 0, state.error(target))
            ? straightToward(chain, settings, target)
            : solveOnce(chain, settings, target, state);
    if (chain.free && chain.pole) turnToPole(*chain.pole, result.state.joints);
  }
  if (settings.continues) keepPace(chain, settings, target, state, jumped, result, memory);
  return result;
}

}  // namespace skitter::reference
