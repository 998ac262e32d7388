#include "bench/cpu_crowd/rig.h"

#include <algorithm>

#include "crowd/controller.h"
#include "skitter/error.h"
#include "skitter/records.h"

namespace skitter::cpu_crowd {
namespace {

Vec3<float> vectorAt(const float* record) { return {record[0], record[1], record[2]}; }

BoneModel boneOf(const float* records) {
  const auto record = [&](int i) { return records + 4 * i; };
  BoneModel bone;
  bone.restX = vectorAt(record(0));
  bone.rest = vectorAt(record(1));
  bone.restY = cross(bone.rest, bone.restX);
  bone.stiffness = record(2)[3];
  const Vec3<float> x = vectorAt(record(5)), z = vectorAt(record(6));
  bone.carry = {x, cross(z, x), z};
  bone.length = record(5)[3];
  bone.edge = record(6)[3];
  bone.inverseEdgeSquared = 1 / std::max(bone.edge * bone.edge, 1e-20f);
  bone.leastK = 2 / (1 + bone.edge * bone.edge);
  return bone;
}

LegModel legOf(const float* records, int bones) {
  LegModel leg;
  leg.root = vectorAt(records);
  leg.reach = records[3];
  leg.home = vectorAt(records + 4);
  leg.group = records[7];
  leg.lag = records[8];
  leg.neighbours = uint32_t(records[9]);
  for (int b = 0; b < bones; ++b)
    leg.bones.push_back(boneOf(records + 4 * (shared::RIG_LEG_STRIDE + b * shared::RIG_BONE_STRIDE)));
  return leg;
}

// From records of three rows a joint, a frame after another, and one that counts for nothing.
ClipTable clipTableOf(const crowd::ClipRecords& records) {
  ClipTable table;
  for (size_t c = 0; c < records.heads.size(); c += 4) {
    const float* head = records.heads.data() + c;
    table.clips.push_back({head[0], head[1], head[2], head[3]});
    table.standing = table.standing || head[3] == 0;
  }
  for (size_t f = 0; f < records.times.size(); f += 4) {
    table.times.push_back(records.times[f]);
    table.perSecond.push_back(records.times[f + 1]);
  }
  constexpr size_t kJointsALine = 4;
  const size_t joints = size_t(records.joints), frames = records.rows.size() / (12 * joints);
  table.joints = records.joints;
  table.lines = (joints + kJointsALine - 1) / kJointsALine;
  table.planes.resize(frames * 3 * table.lines);
  for (size_t i = 0; i < frames * joints * 3; ++i) {
    const size_t row = i % 3, joint = i / 3 % joints, frame = i / 3 / joints;
    float* plane = table.planes[(frame * 3 + row) * table.lines].at;
    std::copy_n(records.rows.data() + 4 * i, 4, plane + 4 * joint);
  }
  return table;
}

}  // namespace

World worldOf(const validation::HerdFacts& facts) {
  World world;
  world.q = facts.parameters;
  const Heightfield& field = facts.terrain;
  world.terrain = {field.heights,   int(field.columns),      int(field.rows),        world.q.originX,
                   world.q.originZ, world.q.inverseSpacingX, world.q.inverseSpacingZ};
  world.bones = facts.rig.maxBones();
  world.groups = facts.rig.groupCount();
  world.approach = facts.ik.approach;
  world.chords = facts.ik.polish - 1;
  if (crowd::traitsOf(facts.controller).playsClips) {
    world.clips = clipTableOf(facts.clips);
    world.q.leanGain = world.q.leanLevel = world.q.breathHeight = 0;
  }
  const size_t stride = size_t(4 * shared::rigStride(world.bones)), expected = facts.rig.legs.size() * stride;
  if (facts.rigRecords.size() != expected) {
    throw inputError("rig records: found " + std::to_string(facts.rigRecords.size()) + " floats, expected " +
                     std::to_string(expected));
  }
  for (size_t l = 0; l < facts.rig.legs.size(); ++l)
    world.legs.push_back(legOf(facts.rigRecords.data() + l * stride, int(facts.rig.legs[l].bones.size())));
  return world;
}

}  // namespace skitter::cpu_crowd
