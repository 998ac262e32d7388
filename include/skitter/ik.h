#pragma once

#include <vulkan/vulkan.h>

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "skitter/device.h"
#include "skitter/export.h"
#include "skitter/solver.h"

// Inverse kinematics of many equal chains at once, on its own: N chains, N targets in, joints out. docs/ik.md
// states the equations and their sources; angles are radians, lengths are in the caller's units.
namespace skitter::ik {

using skitter::allSolvers;
using skitter::nameOf;
using skitter::Solver;
using skitter::solverNamed;

// How far a bone may turn from its rest direction, in the frame that the bones before it carry along.
struct Free {};
struct Cone {
  float halfAngle;  // > 0; above 3.1: 3.1
};
// A quarter of an ellipse a quadrant (Aristidou et al. 2016): half-angles toward the frame's +x, +y, -x, -y,
// each > 0 and at most 3.1.
struct Ellipse {
  float px, py, nx, ny;
};
// About an axis given in the chain's rest axes (any length but 0, not along the bone); from min to max, at
// most 3.1 either way.
struct Hinge {
  glm::vec3 axis;
  float min, max;
};
using Limit = std::variant<Free, Cone, Ellipse, Hinge>;

struct Bone {
  float length = 0;              // >= 0; one of 0 never turns
  glm::vec3 direction{0, 1, 0};  // at rest, any length but 0
  Limit limit = Free{};
  float twistMin = 0, twistMax = 0;  // about the bone, beyond the shortest arc; balls only, at most 3.1
  float stiffness = 1;               // of the rest pull
};

// The kind of chain that a batch solves: its base at 0, its axes the base's.
struct SKITTER_API Chain {
  static constexpr size_t maxBones = 15;

  std::vector<Bone> bones;        // 1 to maxBones; joints are one more
  std::optional<glm::vec3> pole;  // to which side it should fold, where it may fold two ways

  bool isFree() const;                  // no bone is limited, nor may any twist
  float reach() const;                  // the sum of the lengths
  std::vector<glm::vec3> rest() const;  // its joints at rest, base first
};

// Throws Error(input) naming the bone and the fault: a count, length, direction or limit that cannot be.
SKITTER_API void check(const Chain&);

enum class Start {
  rest,      // every solve starts at the rest pose
  previous,  // from the result of the solve before it; the first from rest
};

// Why a solve ended. `held`: it would have moved a joint by more than 8 times its target's way, and the chain
// is still on the way there. `jumped`: a limit kept the chain from its target, and it left its pose for
// another one (docs/ik.md, Pace).
enum class Stop : uint32_t { tolerance, cap, stall, unreachable, skipped, held, jumped };
inline constexpr std::array<const char*, 7> stopNames = {"tolerance", "cap",  "stall", "unreachable",
                                                         "skipped",   "held", "jumped"};

// Another shader for an entry point: SPIR-V of shaders/ik/<entry>.comp changed, in both load paths.
struct Shader {
  std::string entry;  // "solve_free", "solve_limited"
  std::span<const uint8_t> texel, storage;
};

struct Options {
  Solver solver = Solver::automatic;
  Start start = Start::rest;
  float tolerance = 9e-4f;  // share of the reach: what rounding leaves is then within 1e-3
  uint32_t iterations = 0;  // at most; 0: defaultIterations
  bool restarts = true;     // activeSet: from seed poses, when a limit holds an attempt up
  // activeSet: share of the angle from rest taken back an iteration near the target, 0 to 1; none:
  // restPullOf's
  std::optional<float> restPull = {};
  bool bases = false;                // each chain has a base of its own that may move; otherwise all are at 0
  bool rotations = false;            // write the bones' rotations too
  uint32_t pageChains = 0;           // most chains per page; 0: as many as the device's limits allow
  std::vector<Shader> shaders = {};  // in place of the built-in ones, for experiments
};
// The engine's own: 20 for free chains, 64 for limited ones, 4 where solves continue.
SKITTER_API uint32_t defaultIterations(const Chain&, const Options&);
// The rest pull asked for; else 0.02 where the active set continues solves of a chain with hinges, which it
// keeps out of dead ends (docs/ik.md, Tracking), and 0.
SKITTER_API float restPullOf(const Chain&, const Options&);
// The solver that `automatic` stands for.
SKITTER_API Solver solverFor(const Chain&, const Options&);

struct Base {
  glm::vec3 position{0};
  glm::quat rotation{1, 0, 0, 0};
};

struct Report {
  float error = 0;  // distance of the tip from its target, share of the reach; 0 where skipped
  uint32_t iterations = 0;
  Stop stop = Stop::tolerance;
};

// Device memory, in the caller's hands or the batch's: arrays of vec4 with usage STORAGE_BUFFER and
// UNIFORM_TEXEL_BUFFER.
struct Span {
  VkBuffer buffer = VK_NULL_HANDLE;
  uint64_t bytes = 0;
};

// N chains of one kind. Not thread-safe. Throws Error(input) for a chain or options that cannot be, for lists
// that are not one per chain and for a page that it does not have, Error(device) when memory does not
// suffice. Chains are split over pages, so that any count up to maxChains fits the device's bindings.
class SKITTER_API Batch {
 public:
  static constexpr uint32_t maxChains = 1 << 24;

  Batch(Device&, const Chain&, uint32_t chains, const Options& = {});
  ~Batch();
  Batch(Batch&&) noexcept;
  Batch& operator=(Batch&&) noexcept;

  uint32_t chains() const;
  uint32_t joints() const;  // a chain
  Solver solver() const;
  uint32_t iterations() const;
  uint64_t memoryBytes() const;

  // From the host: one per chain. These and the reads below wait for the device.
  void setTargets(std::span<const glm::vec3>);
  void setBases(std::span<const Base>);  // with Options::bases
  void reset();                          // every chain to its rest pose
  // Start poses from joints, J per chain, base first: bones are aimed at the next joint within their limits,
  // without twist. With bases, joints are in the world and the bases those set last. For Start::previous.
  void setJoints(std::span<const glm::vec3>);
  // For tools and validation, as shaders/shared/ik_batch.h lays them out: what solves continue from, with
  // Start::previous, and the poses from which the active set starts anew.
  std::vector<glm::vec4> downloadStates() const;
  void setStates(std::span<const glm::vec4>);
  std::vector<glm::vec4> downloadSeeds() const;
  // Records a solve, submits it and waits.
  void solve();
  std::vector<glm::vec3> downloadJoints() const;  // J per chain
  std::vector<glm::quat> downloadRotations()
      const;  // J - 1 per chain, world from rest; with Options::rotations
  std::vector<Report> downloadReports() const;

  // In the caller's command buffer, outside a render pass: one solve of every chain. It begins and ends with
  // barriers against compute and transfer work before and after it.
  void record(VkCommandBuffer) const;
  // The device's own view, page by page: chain c is entry c % pageChains() of page c / pageChains().
  uint32_t pageChains() const;
  uint32_t pages() const;
  Span targets(uint32_t page) const;    // a vec4 per chain: x, y, z, unused
  Span bases(uint32_t page) const;      // two: position; rotation xyzw
  Span joints(uint32_t page) const;     // J - 1 per chain: p_1 .. p_n, w unused; the base is the caller's
  Span rotations(uint32_t page) const;  // J - 1 per chain: xyzw
  Span reports(uint32_t page) const;    // one: error, iterations, stop + 8 * the solver's own, damping
  // The caller's buffers in place of the batch's, for a batch of one page: large enough, and bound until the
  // batch goes or others are given. Those left empty stay the batch's own. With
  // Start::previous and reports of the caller's, reset() before the first solve: reports carry a solver's
  // memory.
  struct Buffers {
    Span targets = {}, bases = {}, joints = {}, rotations = {}, reports = {};
  };
  void use(const Buffers&);

 private:
  struct SKITTER_LOCAL Impl;
  std::unique_ptr<Impl> impl_;
};

// A body with its legs as one solve: several ends on one tree (docs/ik.md). Free legs of equal bone counts.
struct Tree {
  struct Leg {
    glm::vec3 root{0};  // from the body's position
    std::vector<Bone> bones;
  };
  std::vector<Leg> legs;  // 1 to 8
  float anchor = 0;       // 0: the body goes where its legs pull it; 1: it stays where it was
};

// Throws Error(input) for a tree, a tolerance or a count that cannot be, and for lists of another length,
// Error(device) when memory does not suffice.
class SKITTER_API TreeBatch {
 public:
  TreeBatch(Device&, const Tree&, uint32_t trees, uint32_t iterations = 20, float tolerance = 9e-4f);
  ~TreeBatch();
  TreeBatch(TreeBatch&&) noexcept;
  TreeBatch& operator=(TreeBatch&&) noexcept;

  // `bodies`: a position per tree, `targets`: one per leg. Solves start at rest about these bodies.
  void solve(std::span<const glm::vec3> bodies, std::span<const glm::vec3> targets);
  std::vector<glm::vec3> downloadBodies() const;
  std::vector<glm::vec3> downloadJoints() const;  // per tree, leg and joint
  std::vector<Report> downloadReports() const;    // one a tree; the error is the largest of its legs'

 private:
  struct SKITTER_LOCAL Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skitter::ik
