#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/common/manifest.h"
#include "laws/tally.h"
#include "skitter/scene.h"
#include "validation/judge.h"

namespace skitter::app {

// A share of a leg length. Nobody sees a difference of so little in where an agent stands.
inline constexpr double freeRunTolerance = 0.01;

// The result of a validation on one device.
struct Outcome {
  std::string device = {};
  std::vector<validation::StageResult> stages = {};
  std::vector<laws::Figure> laws = {};   // of the visible world, herd by herd
  uint64_t ticks = 0, wanted = 0;        // done, and asked for
  std::optional<uint64_t> edits = {};    // of the ground, rectangles
  std::optional<double> freeShare = {};  // of a free run: agents that stay within freeRunTolerance
  double seconds = 0;                    // wall

  bool isWhole() const { return ticks >= wanted; }
  std::string failed() const;      // the names of stages that differ from the reference; empty: none
  std::string brokenLaws() const;  // each once; empty: all are kept
  // Its laws are told beside that.
  bool passes() const { return isWhole() && failed().empty(); }
};

void print(const Outcome& outcome, const Scene& scene);

// What --json writes: the result of one device, or a list where several were asked for.
nlohmann::ordered_json jsonOf(std::span<const Outcome> outcomes, bool several);

// Writes --junit, for servers of continuous integration: a suite a device, a case a stage. Throws
// Error(input).
void writeJunit(const std::string& file, std::span<const Outcome> outcomes, const Manifest& manifest);

}  // namespace skitter::app
