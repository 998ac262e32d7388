#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <span>

#include "skitter/crowd.h"
#include "skitter/export.h"

// Records (skitter/records.h) as numbers with a meaning, on the host. A record is given as the floats that it
// begins with: of a HerdState, of a Snapshot (skitter/readback.h) or of the caller's own copy of a buffer.
// Too few throw Error(input).
//
// World positions are relative to an `origin` that the caller names, in world metres. A body's position
// is a tile and an offset in it, so x and z are exact to 1e-6 m wherever on the map the body is.
namespace skitter {

struct BodyState {
  glm::dvec3 position{0};          // on the ground below the body: model space's origin
  glm::quat rotation{1, 0, 0, 0};  // R_0, world from model
  glm::vec2 heading{0, 1};         // unit, world x and z
  glm::vec3 velocity{0};           // m/s, horizontal
  float turnRate = 0;              // radians per second
  bool present = true;             // false: nobody is in this place of the herd
};
SKITTER_API BodyState bodyOf(std::span<const float> body, const glm::dvec3& origin = glm::dvec3(0));

// How a leg goes from where it left the ground to where it lands.
struct StepState {
  glm::dvec3 liftOff{0}, landing{0};
  float firstTick = 0, ticks = 0;
  bool lastResort = false;  // nothing better was found to land on
};
// `body`: of the leg's agent, after the same tick.
SKITTER_API StepState stepOf(std::span<const float> step, std::span<const float> body,
                             const glm::dvec3& origin = glm::dvec3(0));

// A foot record: where the foot should be. `body` has the origin that the position is relative to.
struct FootState {
  glm::dvec3 place{0};
  float progress = 1;  // of its step; 1: planted
  bool planted() const { return progress >= 1; }
};
SKITTER_API FootState footOf(std::span<const float> foot, const BodyState& body);

// A tip record: where the foot is.
struct TipState {
  glm::dvec3 place{0};
  float error = 0;  // metres from where it should be
};
SKITTER_API TipState tipOf(std::span<const float> tip, const BodyState& body);

// A bone of a pose record: entry 0 is the body, 1 + leg * Rig::maxBones() + bone a leg's bone. A vertex v of
// it is at position + rotation (v - rest start), relative to the body's position along world axes.
struct BonePose {
  glm::quat rotation{1, 0, 0, 0};
  glm::vec3 position{0};  // of the joint at its start
};
SKITTER_API BonePose bonePoseOf(std::span<const float> pose, uint32_t entry);

// A joint of a pose record of the controllers clip and planted: its columns are the rows of the matrix that
// takes a vertex of the clips' skin to world axes about the body's position. transpose() makes a mat4x3 of
// it.
SKITTER_API glm::mat3x4 jointRowsOf(std::span<const float> pose, uint32_t joint);

// Decodes an event of Crowd::footfallBuffers(). `firstAgent` is FootfallBuffer's; Footfall::agent is of the
// herd if it is less than FootfallBuffer::agents, else the event is another herd's. Its number in the herd is
// then FootfallBuffer::firstOfHerd more.
SKITTER_API Footfall footfallOf(std::span<const float> event, uint32_t firstAgent, double dt);

}  // namespace skitter
