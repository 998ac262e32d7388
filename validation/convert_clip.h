#pragma once

#include "cpu_reference/clips/table.h"
#include "cpu_reference/stages/ik_planted.h"
#include "cpu_reference/stages/swing_planted.h"
#include "crowd/clip_records.h"
#include "skitter/crowd.h"

// As convert.h, of the records of herds that play clips.
namespace skitter::validation {

reference::ClipTable clipTableOf(const crowd::ClipRecords& records, int legs, int bones);

// A clip or frame that the table does not have reads as its first.
reference::Play playOf(const HerdState& state, size_t agent, const reference::ClipTable& table);
reference::Plant plantOf(const HerdState& state, size_t leg);
reference::PlantedStart startOf(const HerdState& state, size_t leg, int bones);
// Bone i of the leg, its turn as a quaternion.
struct FixRecord {
  glm::dquat turn{1, 0, 0, 0};
  glm::dvec3 move{0};
};
FixRecord fixOf(const HerdState& state, size_t leg, int bones, int bone);
// An entry of the clips' palette; `entry` is agent * joints + joint.
reference::Affine matrixOf(const HerdState& state, size_t entry);

// Rounded to float into records that are already of full size.
void putPlay(HerdState& state, size_t agent, const reference::Play& play);
void putPlant(HerdState& state, size_t leg, const reference::Plant& plant);
void putStart(HerdState& state, size_t leg, int bones, const reference::PlantedStart& start);
void putFix(HerdState& state, size_t leg, int bones, int bone, const reference::BoneFix& fix);
void putMatrix(HerdState& state, size_t entry, const reference::Affine& matrix);

}  // namespace skitter::validation
