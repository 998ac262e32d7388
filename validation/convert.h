#pragma once

#include <optional>
#include <vector>

#include "cpu_reference/stages/adapt.h"
#include "cpu_reference/stages/hurt.h"
#include "cpu_reference/stages/measure.h"
#include "cpu_reference/stages/react.h"
#include "cpu_reference/stages/swing_key_poses.h"
#include "cpu_reference/types.h"
#include "crowd/gait_map.h"
#include "crowd/key_poses.h"
#include "shared/parameters.h"
#include "skitter/crowd.h"

// Between the float records of include/skitter/records.h and the reference's structs. An `agent` or
// `leg` index counts within the herd; a leg is agent * legs + leg of the agent.
namespace skitter::validation {

reference::Tuning tuningOf(const shared::Parameters& parameters);
// Heights stay owned by the field.
reference::Heights heightsOf(const Heightfield& field, const shared::Parameters& parameters);
reference::Creature creatureOf(const std::vector<float>& rigRecords, int legs, int bones, int groups);
reference::KeyPoses keyPosesOf(const crowd::KeyPoses& poses, int legs, int bones);
reference::GaitMap gaitMapOf(const crowd::GaitMap& map, int legs);

// The state is a herd's that can be hurt.
reference::Hurt hurtOf(const HerdState& state, size_t agent, int legs);
// The state is a herd's that adapts.
reference::Search searchOf(const HerdState& state, size_t agent);
// The mass that the agent carries, times its own. The state is a herd's that can be hurt.
double carriedMassOf(const HerdState& state, size_t agent);
// How far what the agent carries moves its centre of mass, model space; of the same herd.
glm::dvec3 centreOf(const HerdState& state, size_t agent, double legLength);
// The state is a herd's with reactions. What the host has pushed the agent with for tick n, if anything.
reference::Reaction reactionOf(const HerdState& state, size_t agent);
std::optional<glm::dvec2> pushOf(const HerdState& state, size_t agent, uint64_t n);

reference::Goal goalOf(const HerdState& state, size_t agent);
// Navigate's velocity, and whether it lets the agent sleep.
glm::dvec2 desiredOf(const HerdState& state, size_t agent);
bool mayRest(const HerdState& state, size_t agent);
// The velocity of the later stages: the same, or avoid's where the herd avoids.
glm::dvec2 velocityOf(const HerdState& state, size_t agent);
bool asleepOf(const HerdState& state, size_t agent);
// Agents in reach, as avoid has them.
double seenOf(const HerdState& state, size_t agent);
// How fast the body may be along its heading, where the herd avoids.
std::optional<double> mostSpeedOf(const HerdState& state, size_t agent);
reference::AgentBody bodyOf(const HerdState& state, size_t agent);
reference::Gait gaitOf(const HerdState& state, size_t agent);
// Without lift and tangent where the controller has no arcs.
reference::Step stepOf(const HerdState& state, size_t leg);
reference::Foot footOf(const HerdState& state, size_t leg);
reference::Chain chainOf(const HerdState& state, size_t leg, int bones);
// Chain::miss of an agent's leg after tick n; 0 where the controller's ik tells of none.
double missOf(const HerdState& state, size_t agent, size_t leg, int legs, uint64_t n);
reference::KeyPoses::Directions springOf(const HerdState& state, size_t leg, int bones);
reference::BonePose boneOf(const HerdState& state, size_t entry);
reference::Metric metricOf(const HerdState& state, size_t agent);
// `slot`: the agent's place in HerdState::watch.
reference::Watched watchedOf(const HerdState& state, size_t slot, int legs);

// Rounded to float into records that are already of full size.
void putGoal(HerdState& state, size_t agent, const reference::Goal& goal);
void putSteer(HerdState& state, size_t agent, const glm::dvec2& desired, bool asleep);
void putBody(HerdState& state, size_t agent, const reference::AgentBody& body);
void putSearch(HerdState& state, size_t agent, const reference::Search& search);
// The gait alone: the damage is the host's.
void putHurtGait(HerdState& state, size_t agent, const reference::Hurt& hurt);
void putReaction(HerdState& state, size_t agent, const reference::Reaction& reaction);
void putGait(HerdState& state, size_t agent, const reference::Gait& gait);
void putStep(HerdState& state, size_t leg, const reference::Step& step);
void putFoot(HerdState& state, size_t leg, const reference::Foot& foot);
void putChain(HerdState& state, size_t leg, int bones, const reference::Chain& chain);
void putSpring(HerdState& state, size_t leg, int bones, const reference::KeyPoses::Directions& rates);
void putMiss(HerdState& state, size_t agent, size_t leg, int legs, uint64_t n, double miss);
void putBone(HerdState& state, size_t entry, const reference::BonePose& bone);
void putMetric(HerdState& state, size_t agent, const reference::Metric& metric);
void putWatched(HerdState& state, size_t slot, const reference::Watched& watched);

}  // namespace skitter::validation
