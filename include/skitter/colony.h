#pragma once

#include <vulkan/vulkan.h>

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skitter/device.h"
#include "skitter/enum_names.h"
#include "skitter/export.h"
#include "skitter/ways.h"

// Scouts that find a path over a grid of costs by ant colony optimisation, on the device. docs/colony.md
// states the equations and their sources.
namespace skitter {

enum class ColonyRule : uint32_t {
  mmas,  // MAX-MIN Ant System (Stuetzle & Hoos 2000)
  acs,   // Ant Colony System (Dorigo & Gambardella 1997)
};
inline constexpr std::array allColonyRules = {ColonyRule::mmas, ColonyRule::acs};
constexpr const char* nameOf(ColonyRule rule) {
  constexpr std::array names = {"mmas", "acs"};
  static_assert(names.size() == allColonyRules.size());
  return names[static_cast<size_t>(rule)];
}
constexpr std::optional<ColonyRule> colonyRuleNamed(std::string_view name) {
  return enumNamed(allColonyRules, name);
}

// Where an ant went, from the nest to the goal.
struct ColonyPath {
  std::vector<glm::uvec2> cells = {};  // column, row
  std::vector<glm::vec2> points = {};  // their middles: x, z in metres
  uint32_t fixedLength = 0;            // 1/512 of a cell of flat ground
  double length = 0;                   // metres of flat ground that would take as long
  uint32_t iteration = 0;              // in which it was found, counted from 1
};

// One nest and one goal on one grid. Not thread-safe. Throws Error(input) for what cannot be, Error(device)
// when memory does not suffice. The same grid, options and count of iterations give the same bits on every
// device.
class SKITTER_API Colony {
 public:
  static constexpr uint32_t maxSide = 4096;  // cells
  static constexpr float maxCost = 1000;     // beside infinity
  static constexpr uint32_t maxAnts = 4096;
  static constexpr uint32_t maxSteps = 20000;  // of an ant in an iteration

  // Another shader for an entry point: SPIR-V of shaders/ways/colony_<entry>.comp changed.
  struct Shader {
    std::string entry;  // "walk", "tighten", "judge", "update"
    std::span<const uint8_t> code;
  };
  // Shares are 0 to 1; docs/colony.md says to what they are rounded.
  struct Options {
    ColonyRule rule = ColonyRule::mmas;
    uint32_t ants = 64;  // 1 to maxAnts
    uint64_t seed = 1;
    uint32_t steps = 0;  // of an ant, at most; 0: eight times columns and rows, up to maxSteps
    uint32_t crew = 4;   // ants whose first is tightened, at least 1, at most all; more: less work, less sure
    uint32_t passes = 32;       // of tightening, at most, up to maxSteps; 0: none
    uint32_t beta = 1;          // power of the heuristic, 0 to 8; more: straighter, sooner stuck
    float margin = 1;           // straight moves of detour that halve the heuristic, 1/512 to 64
    float evaporation = 0.1f;   // rho, more than 0 and less than 1
    float least = 0.002f;       // tau_min of mmas, tau_0 of acs; share of the most, 2^-16 to less than 1
    uint32_t bestEvery = 5;     // mmas: iterations from one turn of the best path to the next; 0: none
    float greed = 0.9f;         // acs: q_0
    float wear = 0.1f;          // acs: xi
    float forget = 1;           // gamma, of the pheromone near changed cells
    uint32_t forgetRadius = 2;  // cells, 0 to maxSide
    std::vector<Shader> shaders = {};  // in place of the built-in ones, for experiments
  };

  // nest and goal: column and row, within the grid. Either may be impassable; then no ant leaves or arrives.
  // Where they are one cell the path is that cell.
  Colony(Device&, const CostGrid&, glm::uvec2 nest, glm::uvec2 goal, const Options&);
  ~Colony();
  Colony(Colony&&) noexcept;
  Colony& operator=(Colony&&) noexcept;

  const Options& options() const;  // steps as they are used
  uint32_t iteration() const;      // those that were recorded
  uint64_t memoryBytes() const;

  // Records, submits and waits, 16 iterations at a time.
  void search(uint32_t iterations);
  // Records iterations in the caller's command buffer, outside a render pass, with barriers against compute
  // and transfer work before and after. They count as done: submit them once and in order.
  void record(VkCommandBuffer, uint32_t iterations);

  // Cells (column, row) whose costs have changed, the last one of a cell counts. Near them pheromone is
  // forgotten; the best path stays with its new length, unless it has become impassable. Waits for the
  // device. Throws Error(input), and nothing changes, for a cell or a cost that cannot be.
  void setCosts(std::span<const glm::uvec2> cells, std::span<const float> costs);

  // These wait for the device.
  std::optional<ColonyPath> best() const;                        // none: no ant has arrived
  std::vector<std::optional<ColonyPath>> downloadTrips() const;  // of the last iteration, one an ant
  // Eight a cell, to the neighbours from +x on, turning by +z; in 2^-20 of the most there is.
  std::vector<uint32_t> downloadPheromone() const;

 private:
  struct SKITTER_LOCAL Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace skitter
