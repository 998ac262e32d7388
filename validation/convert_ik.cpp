#include "validation/convert_ik.h"

#include <algorithm>

#include "shared/ik_batch.h"

namespace skitter::validation {
namespace {

reference::IkBone boneOf(const ik::Bone& given) {
  reference::IkBone bone;
  bone.length = given.length;
  bone.direction = given.direction;
  bone.limit = referenceLimit(given.limit);
  if (const auto* hinge = std::get_if<ik::Hinge>(&given.limit)) bone.hingeAxis = hinge->axis;
  if (given.twistMin != 0 || given.twistMax != 0)
    bone.limit = reference::withTwist(bone.limit, given.twistMin, given.twistMax);
  bone.stiffness = given.stiffness;
  return bone;
}

bool hasTwist(const reference::Limit& limit) {
  return limit.tanHalfTwistLow != 0 || limit.tanHalfTwistHigh != 0;
}

// Directions of two bones a vec4, then twists of four.
reference::Pose poseOf(const IkLayout& layout, std::span<const glm::vec4> record) {
  const auto bones = static_cast<size_t>(layout.bones);
  reference::Pose pose = reference::Pose::rest(bones);
  const auto twists = static_cast<size_t>(shared::stateTwists(layout.bones));
  for (size_t i = 0; i < bones; ++i) {
    const glm::vec4& two = record[i / 2];
    pose.swing[i] = i % 2 == 0 ? glm::dvec2(two.x, two.y) : glm::dvec2(two.z, two.w);
    if (layout.twists) pose.twist[i] = record[twists + i / 4][static_cast<int>(i % 4)];
  }
  return pose;
}

}  // namespace

reference::IkChain referenceOf(const ik::Chain& chain) {
  std::vector<reference::IkBone> bones;
  for (const ik::Bone& bone : chain.bones) bones.push_back(boneOf(bone));
  std::optional<glm::dvec3> pole;
  if (chain.pole) pole = glm::dvec3(*chain.pole);
  return reference::makeIkChain(bones, pole);
}

reference::IkSolver referenceOf(ik::Solver solver) {
  // Both list the same solvers in the same order; the batch's begin with `automatic`.
  return static_cast<reference::IkSolver>(static_cast<int>(solver) - 1);
}

IkJudge judgeOf(const ik::Chain& chain) {
  std::vector<IkJudge::Bone> bones;
  for (const ik::Bone& bone : chain.bones) {
    bones.push_back({bone.length, bone.direction, judgedLimit(bone.limit), bone.twistMin, bone.twistMax});
  }
  return IkJudge(bones);
}

IkLayout::IkLayout(const reference::IkChain& chain, reference::IkSolver solver)
    : bones(static_cast<int>(chain.bones.size())),
      twists(std::any_of(chain.bones.begin(), chain.bones.end(), hasTwist)),
      positional(chain.free || solver == reference::IkSolver::dissertationKeep ||
                 solver == reference::IkSolver::dissertationEdge) {}

size_t IkLayout::stateStride() const {
  return static_cast<size_t>(positional ? bones : shared::stateStride(bones, twists));
}

size_t IkLayout::seedStride() const { return static_cast<size_t>(shared::seedStride(bones, twists)); }

reference::IkState stateOf(const reference::IkChain& chain, const IkLayout& layout,
                           std::span<const glm::vec4> record) {
  if (!layout.positional) return reference::stateAt(chain, poseOf(layout, record));
  reference::IkState state;
  state.joints.emplace_back(0);
  for (const glm::vec4& p : record) state.joints.push_back(glm::dvec3(p) / chain.length);
  return state;
}

std::vector<reference::Pose> seedsOf(const IkLayout& layout, std::span<const glm::vec4> records) {
  std::vector<reference::Pose> seeds;
  for (; !records.empty(); records = records.subspan(layout.seedStride()))
    seeds.push_back(poseOf(layout, records));
  return seeds;
}

void append(const reference::IkChain& chain, const IkLayout& layout, const reference::IkState& state,
            std::vector<glm::vec4>& records) {
  const auto bones = static_cast<size_t>(layout.bones);
  if (layout.positional) {
    for (size_t i = 1; i <= bones; ++i) records.emplace_back(chain.length * state.joints[i], 0);
    return;
  }
  std::vector<glm::vec4> record(layout.stateStride(), glm::vec4(0));
  const auto twists = static_cast<size_t>(shared::stateTwists(layout.bones));
  for (size_t i = 0; i < bones; ++i) {
    glm::vec4& two = record[i / 2];
    (i % 2 == 0 ? two.x : two.z) = static_cast<float>(state.pose.swing[i].x);
    (i % 2 == 0 ? two.y : two.w) = static_cast<float>(state.pose.swing[i].y);
    if (layout.twists)
      record[twists + i / 4][static_cast<int>(i % 4)] = static_cast<float>(state.pose.twist[i]);
  }
  records.insert(records.end(), record.begin(), record.end());
}

}  // namespace skitter::validation
