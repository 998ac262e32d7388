#include "app/common/drawn.h"

#include <algorithm>

#include "crowd/controller.h"
#include "skitter/records.h"

namespace skitter::app {
namespace {

using namespace shared;

laws::SkinVertex skinOf(const SkinVertex& vertex) {
  laws::SkinVertex made{.rest = vertex.position};
  for (size_t k = 0; k < made.bones.size(); ++k) {
    made.bones[k] = vertex.bones[k];
    made.weights[k] = double{vertex.weights[k]};
  }
  return made;
}

glm::dmat4x3 turned(const glm::dmat3& rotation, const glm::dvec3& position, const glm::dvec3& rest) {
  return {rotation[0], rotation[1], rotation[2], position - rotation * rest};
}

// A lost bone's skin lies in one point.
glm::dmat4x3 pointAt(const glm::dvec3& position) {
  return {glm::dvec3(0), glm::dvec3(0), glm::dvec3(0), position};
}

std::vector<glm::dmat4x3> byMatrices(std::span<const float> pose, size_t joints, const glm::dvec3& at) {
  std::vector<glm::dmat4x3> bones;
  for (uint32_t j = 0; j < joints; ++j) {
    bones.emplace_back(glm::transpose(jointRowsOf(pose, j)));
    bones.back()[3] += at;
  }
  return bones;
}

std::vector<glm::dmat4x3> byPose(std::span<const float> pose, const Rig& rig, const glm::dvec3& at) {
  const std::vector<glm::vec3> starts = rig.restStarts();
  std::vector<glm::dmat4x3> bones;
  for (uint32_t entry = 0; entry < starts.size(); ++entry) {
    const BonePose bone = bonePoseOf(pose, entry);
    const glm::dvec3 place = at + glm::dvec3(bone.position);
    const bool isLost = pose[size_t{entry} * 4 * POSE_STRIDE + 7] != 0;
    bones.push_back(isLost ? pointAt(place)
                           : turned(glm::mat3_cast(glm::dquat(bone.rotation)), place, starts[entry]));
  }
  return bones;
}

// The directions of a bone, by which it is turned from the one before it.
glm::dvec2 directionsOf(std::span<const float> chain, size_t bone) {
  return {double{chain[2 * bone]}, double{chain[2 * bone + 1]}};
}

std::vector<glm::dmat4x3> byChains(const HerdState& state, const crowd::Kind& kind, size_t agent,
                                   const BodyState& body) {
  const Rig& rig = kind.rig;
  const auto most = static_cast<size_t>(rig.maxBones());
  std::vector<glm::dmat4x3> bones(static_cast<size_t>(rig.paletteSize()));
  bones[0] = turned(glm::mat3_cast(glm::dquat(body.rotation)), body.position, glm::dvec3(0));
  for (size_t l = 0; l < rig.legs.size(); ++l) {
    const std::span<const float> chain =
        recordOf(state.chain, agent * rig.legs.size() + l, chainStride(static_cast<int>(most)));
    glm::dquat rotation(body.rotation);
    glm::dvec3 place = body.position + rotation * glm::dvec3(rig.legs[l].root());
    for (size_t b = 0; b < most; ++b) {
      const bool isThere = b < rig.legs[l].bones.size();
      if (isThere) {
        const float* row =
            kind.rigRecords.data() + 4 * (l * static_cast<size_t>(rigStride(static_cast<int>(most))) +
                                          RIG_LEG_STRIDE + RIG_BONE_STRIDE * b);
        const glm::dvec3 x(row[0], row[1], row[2]), z(row[4], row[5], row[6]), y = glm::cross(z, x);
        const glm::dvec2 d = directionsOf(chain, b);
        rotation = glm::normalize(rotation * glm::dquat(1, d.x * y - d.y * x));
      }
      const Bone& bone = rig.legs[l].bones[std::min(b, rig.legs[l].bones.size() - 1)];
      bones[1 + l * most + b] = turned(glm::mat3_cast(rotation), place, glm::dvec3(bone.start));
      if (isThere) place += double{bone.length} * (rotation * glm::dvec3(bone.direction));
    }
  }
  return bones;
}

laws::Leg legOf(const Leg& leg, uint32_t firstBone) {
  laws::Leg made;
  for (const Bone& bone : leg.bones)
    made.push_back({bone.start, firstBone + static_cast<uint32_t>(made.size())});
  const Bone& last = leg.bones.back();
  made.push_back(
      {glm::dvec3(last.start) + double{last.length} * glm::dvec3(last.direction), made.back().bone});
  return made;
}

laws::Leg legOf(const ClipLeg& leg) {
  laws::Leg made;
  for (size_t j = 0; j < leg.joints.size(); ++j) made.push_back({leg.starts[j], leg.joints[j]});
  return made;
}

}  // namespace

std::span<const float> recordOf(const std::vector<float>& records, size_t number, int stride) {
  const size_t floats = 4 * static_cast<size_t>(stride);
  return std::span(records).subspan(number * floats, floats);
}

laws::Creature drawnCreature(const crowd::Kind& kind) {
  const bool playsClips = crowd::traitsOf(kind.controller).playsClips;
  const std::vector<SkinVertex>& vertices = playsClips ? kind.clipSet.vertices : kind.rig.vertices;
  laws::Creature made{.triangles = playsClips ? kind.clipSet.indices : kind.rig.indices,
                      .legLength = double{kind.rig.legLength}};
  std::ranges::transform(vertices, std::back_inserter(made.vertices), skinOf);
  if (playsClips) {
    for (const ClipJoint& joint : kind.clipSet.joints) made.legOfBone.push_back(joint.leg);
    for (const ClipLeg& leg : kind.clipSet.legs) made.legs.push_back(legOf(leg));
    return made;
  }
  made.legOfBone.assign(static_cast<size_t>(kind.rig.paletteSize()), -1);
  const auto bones = static_cast<uint32_t>(kind.rig.maxBones());
  for (uint32_t l = 0; l < kind.rig.legs.size(); ++l) {
    std::fill_n(made.legOfBone.begin() + 1 + l * bones, bones, static_cast<int>(l));
    made.legs.push_back(legOf(kind.rig.legs[l], 1 + l * bones));
  }
  return made;
}

std::vector<glm::dmat4x3> drawnBones(const HerdState& state, const crowd::Kind& kind, size_t agent,
                                     const BodyState& body) {
  const bool playsClips = crowd::traitsOf(kind.controller).playsClips;
  if (state.pose.empty())
    return playsClips ? std::vector<glm::dmat4x3>() : byChains(state, kind, agent, body);
  const int joints = playsClips ? kind.clips.joints : 0;
  const std::span<const float> pose = recordOf(state.pose, agent, poseStride(kind.legs, kind.bones, joints));
  return playsClips ? byMatrices(pose, static_cast<size_t>(joints), body.position)
                    : byPose(pose, kind.rig, body.position);
}

}  // namespace skitter::app
