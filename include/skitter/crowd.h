#pragma once

#include <vulkan/vulkan.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skitter/buffers.h"
#include "skitter/device.h"
#include "skitter/export.h"
#include "skitter/forage.h"
#include "skitter/heightfield.h"
#include "skitter/levels.h"
#include "skitter/picking.h"
#include "skitter/records.h"
#include "skitter/rig.h"
#include "skitter/scene.h"
#include "skitter/steering.h"

namespace skitter {

struct State;  // skitter/state.h

// Another shader for a stage: a changed copy of shaders/stages/<stage>.comp, compiled once for each load
// path, of which the device takes one, with the defines that engine/crowd/CMakeLists.txt has for it:
//   options="-V --target-env vulkan1.3 -Ishaders -Iinclude"
//   glslangValidator $options -DLOAD4_TEXEL=1 changed.comp -o texel.spv
//   glslangValidator $options -DLOAD4_TEXEL=0 changed.comp -o storage.spv
// It keeps the bindings, push constants and specialisation constants. The bytes are read while the crowd is
// made.
struct StageShader {
  std::string stage;
  std::span<const uint8_t> texel, storage;
};

struct CrowdOptions {
  bool pose = true;         // bone rotations and positions, for drawing and traces
  bool measure = true;      // keep the fidelity figures
  uint32_t watchEvery = 0;  // figures are of one agent in this many at a time, each in its turn; 0: of all
                            // in a crowd of at most 256, of one in 64 in a larger one;
                            // agents of herds that events add count from the start
  bool feet = false;        // keep where feet should be and are, as measure and footfalls have it, though no
                            // later tick needs it: else they may have no foot and tip records
  uint32_t footfalls = 0;   // keep so many touchdowns per tick and page of records, at most one per leg;
                            // 0: none
  bool sleep = false;     // an agent that has stood still for seconds is passed over, without a breath, until
                          // its goal or the ground moves: standing crowds cost next to nothing
  bool crowding = false;  // measure how far agents overlap (Crowd::crowding)
  bool fuse = true;       // stages that are faster when fused are fused: the same records, in fewer passes
  bool timestamps = false;                // time every stage on the device
  uint32_t pageAgents = 0;                // most agents per page; 0: as many as the device's limits allow
  std::vector<StageShader> shaders = {};  // in place of the built-in ones, for experiments
  // One per herd, in place of those that the scene names, but for herds that events add; empty: the scene's.
  // Of a state: one for each herd, by number, that the crowd began with; herds that came later have their
  // files'.
  std::vector<Rig> rigs = {};
  // Agents that are far from the camera (Crowd::lookFrom) tick less often (docs/levels.md). There must be no
  // sleep.
  std::optional<Levels> levels = {};
};

// How well agents moved in the ticks in which they were watched (docs/stages/measure.md defines each).
// Lengths in leg lengths. A figure without a sample is 0.
struct Fidelity {
  uint64_t agentTicks = 0;  // ticks watched, of all agents
  uint64_t stances = 0;     // ended while watched, and seen from their touchdown
  double slip = 0;          // mean horizontal slide of a planted foot per stance
  double skating = 0;  // share of planted leg-ticks in which the foot slides faster than 0.1 leg lengths/s
  double penetration = 0;             // mean depth of all feet below the ground
  double penetrationBeyond = 0;       // the same, of what is deeper than 0.005 leg lengths
  double floating = 0;                // mean height of planted feet above the ground
  double floatingBeyond = 0;          // the same, of what is higher than 0.005 leg lengths
  double segmentPenetration = 0;      // mean depth of a leg's deepest point between root and foot
  double segmentPenetrationMost = 0;  // the deepest
  double crossing = 0;                // share of ticks in which a leg crosses its neighbour, seen from above
  double reachErrorP99 = 0;           // 99th percentile distance of a foot from its target
  double reachErrorMost = 0;
  // Only herds whose controller keeps the rig's limits count, adaptive and loop; none where there is none.
  std::optional<double> limitViolation;   // largest violation of a joint limit, radians, at most pi
  std::optional<double> limitViolations;  // share of leg-ticks with more than 1e-4 rad of it
  double footJerk = 0;                    // normalised jerk over windows of 0.4 s in which the foot moves
  double bodyJerk = 0;
  double margin = 0;         // mean static stability margin
  double marginLeast = 0;    // negative: the centre was outside the support polygon
  double unstable = 0;       // share of ticks in which it was, or no foot was planted
  uint64_t lastResorts = 0;  // landings for which no foothold fitted; of all agents and ticks
  uint64_t notFinite = 0;    // targets that were not finite; the leg kept its pose; of all agents and ticks
};

// A foot that came down: planted at the end of this tick, in the air at the end of the one before.
struct Footfall {
  uint32_t agent = 0, leg = 0;  // of the herd, of the rig
  uint64_t tick = 0;
  double seconds = 0;  // tick * dt
  glm::vec3 place{0};  // position of the foot, world metres (float32: to 2.4e-4 m at 4 km)
  float speed = 0;     // of the foot over that tick, m/s
};

// Agents first, first + stride, first + 2 stride, ... of a herd.
struct AgentSample {
  uint32_t first = 0, stride = 1;
};

// Records of a herd as the host sees them, agent after agent and of an agent leg after leg (skitter/records.h
// has the layouts). Records that CrowdOptions left out or no stage of the herd has are empty. For tools,
// traces and validation.
struct HerdState : ForRecords<std::vector<float>> {
  uint64_t tick = 0;        // the last one made
  uint32_t agents = 0;      // that are here, and empty places: body [1].w tells
  AgentSample sample;       // which of the herd they are
  uint32_t watchEvery = 1;  // measure watches one agent of this many at a time
  // Equal herds take turns as one, the herd's agent g as number watchOffset + g; number n that is being
  // watched has its records at index n / watchEvery of `watch`, which is of all agents. Empty for a herd of
  // several sizes, for these do not take turns as one.
  uint32_t watchOffset = 0;
  std::vector<Footfall> footfalls;  // of the last tick and of all agents, by agent and leg
  bool footfallsKept = false;       // they are all here: CrowdOptions::footfalls left room for them
  bool watched = false;  // the last tick's gait looked at the ground, because the heights were edited lately
  bool sleep = false;    // CrowdOptions::sleep; who sleeps is told by its steer record
  std::vector<uint32_t> trail;  // of the colony, where the herd forages (shaders/shared/forage.h)
};

// The touchdowns of the last tick on the device, for shaders of the caller's: FOOTFALL_STRIDE vec4 each
// (include/skitter/records.h), min(count, room) of them in any order. Equal herds share buffers, and
// events number agents through all of them; the sizes of a herd (Herd::sizes) have buffers of their own.
// Owned by the crowd, rewritten by each recorded tick; both buffers can be read from as storage buffers.
struct FootfallBuffer {
  VkBuffer events = VK_NULL_HANDLE;
  VkBuffer counters = VK_NULL_HANDLE;  // holds count, a uint32
  uint32_t countOffset = 0;            // bytes
  uint32_t room = 0;
  uint32_t firstAgent = 0, agents = 0;  // the herd's, at one of its sizes, of those that events number
  uint32_t firstOfHerd = 0;             // the number in the herd of firstAgent
};

// How a crowd shares its ground: all agents and ticks since the crowd was made, or made of a state. Positions
// are those with which a tick begins. Two agents overlap by max(0, r_i + r_j - d) / (2 min(r_i, r_j)), where
// r are the radii of their footprints (docs/stages/avoid.md) and d is the horizontal distance of their
// bodies.
struct Crowding {
  // Agents in reach of one that avoids, beyond the 8 that it keeps clear of; none unless a herd avoids.
  std::optional<uint64_t> droppedNeighbours = {};
  // With CrowdOptions::crowding, else none.
  std::optional<double> overlapMost = {};
  std::optional<double> overlapMean = {};  // sum over all pairs, for each agent and tick
  std::optional<double> pairs = {};        // that overlap, for each agent and tick
};

// Device memory of one kind of records, of all of a herd's agents: its share, where equal herds have them in
// common. "walls", "ways" and "trails" are of the kind: obstacles of a herd that avoids, fields of one that
// finds its way, the trail of one that forages.
struct MemoryUse {
  std::string name;
  uint64_t bytes = 0;
};

struct StageTime {
  std::string stage;
  double milliseconds = 0;  // of the last tick that has finished on the device
};

// The herds on one terrain, living on one device. Herds that are equal but for agents, spawn, goal, sizes,
// phase and colours, all with a reserve or all without, share pipelines and dispatches, so that any number of
// them costs what one of as many agents does; each size among them has its own. Not thread-safe; one crowd
// may be recorded while another is.
class SKITTER_API Crowd {
 public:
  // Loads the scene's rigs, uploads the terrain and spawns every agent. Throws Error(input) for a scene that
  // cannot be (an unknown rig or controller, a count of rigs that is not that of herds, tuning, a spawn or
  // a goal out of its range, more than 100 herds that differ and sizes of these, legs of an adaptive herd
  // above 100 m, a terrain that cannot be or reaches beyond 4 km from the origin, an event that names nobody,
  // or a herd that cannot come or go) and, before any agent is made, Error(device) when memory does not
  // suffice (as DeviceLimits::availableBytes, but now). Likewise for what levels of rate are not made for.
  Crowd(Device& device, const Heightfield& terrain, const Scene& scene, const CrowdOptions& options = {});
  // As it was when it was saved; on another device and in other pages, too: every record has the bits that it
  // had. What the state's options ask for and the state lacks (poses, feet, footfalls) follows from it.
  // Throws Error as above, and Error(input) that names the state where it is damaged, or where a rig or its
  // clips are others than they were.
  Crowd(Device& device, const State& state);
  ~Crowd();
  Crowd(Crowd&&) noexcept;
  Crowd& operator=(Crowd&&) noexcept;

  // Records one tick of `dt` seconds into the caller's command buffer (outside a render pass). It begins with
  // a barrier against earlier reads of the crowd's buffers and ends with one that makes its results visible
  // to vertex, fragment, compute and transfer work recorded after it. Each recorded tick must be submitted
  // once, in order. What Scene::events has for that time happens first, as if the caller had called
  // editHeights, steer, setSpeed, teleport, add, remove, hurt, carry, push, addHerd, removeHerd or setThreat
  // just before; no file is read for that. A tick before which a herd comes or goes takes the queue's lock,
  // allocates, submits and waits for the device, and is recorded when all that was recorded before it is
  // submitted; one for which fields are computed anew, or foragers that carry loads are looked at, does so,
  // too, and allocates nothing. The buffers of a herd that goes are freed: what reads them (Readback,
  // Palettes, the caller's shaders) must be gone before. Throws Error(input) where dt is not what it was
  // before, for steps are timed in ticks, or, of an adaptive herd, below 22 microseconds; and where an event
  // cannot happen, because a herd or an agent is not there or no place is left: then none of the tick's
  // events has, and the tick can be recorded again. Throws Error(device) where memory does not suffice for a
  // herd that comes: then what comes before it has happened, and the tick, recorded again, goes on with it.
  void record(VkCommandBuffer commandBuffer, float dt);

  // Replaces a rectangle of the terrain's samples while the crowd walks: columns [x0, x0 + columns), rows
  // [z0, z0 + rows), row-major, metres relative to the terrain's mid height as made. Takes effect in the next
  // recorded tick, which carries the samples in its command buffer; `heights` may go at once. A foot in the
  // air whose landing or way is touched is aimed anew in the same swing, a foot whose ground moved steps
  // anew; for two seconds after an edit gait looks at the ground under every foot for that
  // (docs/stages/gait.md). The picture's ground follows, its baked shadows do not. Throws Error(input) as
  // Heightfield::edit does.
  void editHeights(uint32_t x0, uint32_t z0, uint32_t columns, uint32_t rows, std::span<const float> heights);
  const Heightfield& terrain() const;  // as edited

  // Where the camera is from the next recorded tick on, world metres: rates depend on it, where there are
  // levels of them (CrowdOptions::levels), and nothing else does. Before the first call everybody has full
  // rate. Throws Error(input) for a position that is not finite.
  void lookFrom(const glm::vec3& camera);
  // One of each level, full rate first; empty without levels. Waits for the device.
  std::vector<LevelFigures> levels() const;

  // Steering (docs/steering.md). What the host says takes effect in the next recorded tick, which carries it
  // in its command buffer: the data may go at once, nothing waits, and of several calls for one agent the
  // last counts. A number that is not finite or out of its range, a count that is not the herd's, a herd that
  // is not there and a handle of nobody throw Error(input), and nothing is changed then.
  //
  // Goals: of all agents of a herd, of each one (one goal per place), or of some. Kind cross: along the lane
  // that the herd's spawn has for the agent's place.
  void steer(uint32_t herd, const Goal& goal);
  void steer(uint32_t herd, std::span<const Goal> goals);
  void steer(std::span<const AgentGoal> goals);
  // The speed alone, 0 to Goal::maxSpeed, metres per second. Of kind velocity it is what the velocity is cut
  // to from then on, until the next goal.
  void setSpeed(uint32_t herd, float speed);
  void setSpeed(uint32_t herd, std::span<const float> speeds);
  void setSpeed(std::span<const AgentSpeed> speeds);
  // Puts agents elsewhere. They stand with their feet on the ground at their homes, and nothing of their
  // earlier motion is kept. The goal stays.
  void teleport(std::span<const AgentPlace> places);
  void teleport(AgentId agent, const Place& place);
  // The goals themselves, one buffer per page of the herd, for the caller's own shaders. record() begins with
  // a barrier against what compute shaders and transfers wrote before it; before the caller's shader writes
  // goals it needs one of its own against the tick before: from COMPUTE_SHADER, SHADER_STORAGE_WRITE to
  // COMPUTE_SHADER, SHADER_STORAGE_READ | SHADER_STORAGE_WRITE. What the host says counts, where both do.
  std::vector<GoalBuffer> goalBuffers(uint32_t herd) const;
  // How many agents of a herd with ways have a goal that no way leads to from where they are: they stop at
  // the nearest place that one leads to (docs/ways.md). Waits for the device.
  uint32_t cannotReach(uint32_t herd) const;
  // Threats, by numbers of the caller's, below Scene::maxThreats: one comes, moves or, with radius 0, goes.
  // Those of the scene have their index. Agents of herds with ways keep off, and get out, by fields that the
  // next recorded tick waits for (docs/ways.md). The latter: all numbers up to the last one in use.
  void setThreat(uint32_t number, const Threat& threat);
  const std::vector<Threat>& threats() const;
  // The deeds of a herd's foragers, with those of herds that share its colony, and the pheromone as the last
  // tick left it (docs/foraging.md). Zeros and empty where it does not forage. They wait for the
  // device.
  Foraging foraging(uint32_t herd) const;
  PheromoneGrid pheromone(uint32_t herd) const;
  // The handle of the agent in that place of the herd. Throws Error(input) where nobody is.
  AgentId agentId(uint32_t herd, uint32_t agent) const;

  // Agents that come and go, in herds with a reserve (Herd::reserve): a herd has `places` for its agents and
  // its reserve, and the lowest empty one is taken first. An agent has the size of its place (Herd::sizes).
  // The handle of an agent that is gone is of nobody.
  //
  // Throw Error(input) where no place is left, or where the herd has no reserve.
  AgentId add(uint32_t herd, const Place& place, const Goal& goal);
  AgentId add(uint32_t herd, const Place& place);  // with the herd's goal
  void remove(AgentId agent);
  bool has(AgentId agent) const;
  uint32_t places(uint32_t herd) const;
  uint32_t agentCount(uint32_t herd) const;

  // Legs that are hurt, in herds that can be (Herd::hurt, docs/damage.md). A leg that does not carry has no
  // foothold, no target and no solve; the others regroup in the next recorded tick. A hurt agent wakes.
  //
  // Throws Error(input) where a herd cannot be hurt, or for a leg or a bone that the rig lacks.
  void hurt(std::span<const AgentLeg> legs);
  void hurt(AgentId agent, uint32_t leg, LegState state = LegState::lost, std::optional<uint32_t> bone = {});
  void heal(AgentId agent);  // all its legs are whole
  // As the host has said. Throws Error(input) for a handle of nobody, and for a leg that the rig lacks.
  LegState legState(AgentId agent, uint32_t leg) const;

  // Loads, in herds that can be hurt (docs/loads.md): an agent has at most one, and a new one takes the place
  // of the one before. Who carries goes slower and lower from the next recorded tick on, with its feet below
  // the centre of body and load, and wakes.
  //
  // Throws Error(input) where a herd cannot be hurt, and for a load out of its range.
  void carry(std::span<const AgentLoad> loads);
  void carry(AgentId agent, const Load& load);
  // The load that the host gave the agent last, or saw a forager carry; it has mass 0 where the agent carries
  // nothing. Throws Error(input) for a handle of nobody.
  Load carried(AgentId agent) const;

  // Pushes, for herds with reactions (Herd::reactions, docs/reactions.md). Several of one agent before the
  // next recorded tick add up. A pushed agent wakes.
  //
  // Throws Error(input) where a herd has no reactions, and for a push that is not finite or too strong.
  void push(std::span<const AgentPush> pushes);
  void push(AgentId agent, const glm::vec2& velocity);
  // Who fell and who stands again: one of each place of the herd, as the last tick left it; steady in a herd
  // without reactions. Waits for the device.
  std::vector<Reaction> reactions(uint32_t herd) const;
  // How agents get on that try gaits: one of each place of the herd, as the last tick left it; at ease in a
  // herd that does not adapt. Waits for the device.
  std::vector<Search> searches(uint32_t herd) const;

  // Herds that come and go, between ticks. Both calls make or free device memory at once, submit and wait
  // under the queue's lock. Herd::rig is relative to the working directory.
  //
  // The herd is there in the next recorded tick, as one of the scene in a crowd that begins. It has pipelines
  // and pages of its own (about 0.3 s per size), and the lowest number that no herd has. A renderer of the
  // crowd follows at its next picture. Throws as the constructor does, and Error(input) beyond
  // Scene::maxHerds.
  HerdId addHerd(const Herd& herd);
  // Waits for the device and frees the herd's memory. Its number is of a herd without places then. Earlier
  // ticks have been submitted, and no command buffer that was recorded before is submitted afterwards. What
  // reads the herd (Readback, Palettes, the caller's shaders) must be gone before. A herd that shares its
  // kind with others leaves its places empty where the kind has a reserve, and is refused by an Error(input)
  // where it has none.
  void removeHerd(HerdId herd);
  bool has(HerdId herd) const;
  HerdId herdId(uint32_t herd) const;

  // Writes a state, with which a run can go on later (skitter/state.h). Waits for the device. The file takes
  // its name once it is whole and on the disk; until then an older one stays. `note` is JSON of the
  // caller's own, which comes back with the state. Throws Error(input) that names the file, or the value of
  // the scene or the note that cannot be written.
  void save(const std::filesystem::path& file, const std::string& note = {}) const;
  std::vector<std::byte> saveToMemory(const std::string& note = {}) const;
  uint64_t stateBytes() const;  // about what a state takes, without the note

  uint64_t tick() const;         // ticks recorded so far
  uint32_t herdCount() const;    // numbers of herds, those of herds that are gone among them
  uint32_t watchEvery() const;   // the fidelity figures are of one agent of this many at a time
  uint64_t agentCount() const;   // who is there, as the host has said
  uint64_t capacity() const;     // places for agents, empty ones among them
  uint64_t memoryBytes() const;  // device memory of all of memoryUse(), without the grid of avoid
  std::vector<MemoryUse> memoryUse(uint32_t herd) const;
  // At the first of the herd's sizes, and at that of an agent, which is `size` times the rig as loaded. Throw
  // Error(input) where the herd has no such place.
  const Rig& rig(uint32_t herd) const;
  const Rig& rig(uint32_t herd, uint32_t agent) const;
  float size(uint32_t herd, uint32_t agent) const;

  // The nearest agent under a ray; the one nearest to a point. Positions are relative to `origin`. Both wait
  // for the device and read every agent's body; Snapshot (skitter/readback.h) has the same without waiting.
  std::optional<Picked> pick(const Ray& ray, const glm::dvec3& origin = glm::dvec3(0)) const;
  std::optional<Picked> nearest(const glm::dvec3& point, const glm::dvec3& origin = glm::dvec3(0)) const;

  // Each of these waits for the device. A number that no herd has throws Error(input), here and above, and so
  // does a sample with stride 0.
  HerdState download(uint32_t herd, const AgentSample& sample = {}) const;
  Fidelity fidelity() const;  // of all herds
  Fidelity fidelity(uint32_t herd) const;
  // Agent by agent. reachErrorP99, lastResorts and notFinite are only counted by herd and 0 here.
  std::vector<Fidelity> agentFidelity(uint32_t herd) const;
  // The footfalls of the last tick recorded, by agent and leg. Empty without CrowdOptions::footfalls.
  std::vector<Footfall> footfalls(uint32_t herd) const;
  uint64_t droppedFootfalls(uint32_t herd) const;  // for want of room, since the start
  Crowding crowding() const;                       // waits for the device
  // Agents of all herds that slept in the last tick; 0 without CrowdOptions::sleep.
  uint64_t sleeping() const;
  uint64_t stateHash() const;                 // of every record that the next tick depends on
  std::vector<StageTime> stageTimes() const;  // empty without CrowdOptions::timestamps
  // Whether ticks recorded from now on are timed stage by stage, with CrowdOptions::timestamps: at first they
  // are. Not free: a timestamp costs lavapipe as much as a small dispatch.
  void timeStages(bool on);

  // One per page of the herd; does not wait. The last barrier of record() makes them visible.
  std::vector<FootfallBuffer> footfallBuffers(uint32_t herd) const;
  // Likewise, of any record but `watch`. Empty where the herd keeps none (CrowdOptions).
  std::vector<RecordBuffer> buffers(uint32_t herd, Record record) const;

  struct SKITTER_LOCAL Impl;

 private:
  // For the engine's own rooms and tools (crowd/herd.h).
  friend Impl& implOf(Crowd& crowd);
  friend const Impl& implOf(const Crowd& crowd);

  std::unique_ptr<Impl> impl_;
};

}  // namespace skitter
