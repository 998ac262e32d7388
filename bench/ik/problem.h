#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/cpu_baseline/workload.h"
#include "skitter/ik.h"

// What is solved: one chain with its limits and targets, in the words of each of those who solve and judge.
namespace skitter::bench {

// "none", "cone90", "cone60", "cone30", "ellipse", "hinge", "hinge-free-base", "caliko".
const std::vector<std::string>& allLimits();
// The bent chain of docs/ik.md's measurements with one of these limits on each bone. hinge-free-base has a
// ball without a limit for its first bone; caliko is straight, with balls of 90 degrees on a free first bone.
baseline::Chain chainWith(const std::string& limits, int joints);

ik::Chain deviceChain(const baseline::Chain&);

// A solver as it is measured: the device's, and the CPU opponent's where it has that solver.
struct Entry {
  const char* name;
  ik::Solver device;
  std::optional<baseline::Solver> cpu = {};
  bool restarts = true;
};
const std::vector<Entry>& allEntries();
bool takes(const Entry&, const std::string& limits, int joints);
// What it claims of every result; the dissertation's claim less.
bool keepsLengths(const Entry&);
bool keepsLimits(const Entry&);

// Sets of targets, each as the CPU's rows and as the device's vectors.
struct Targets {
  std::vector<baseline::Rows> rows;
  std::vector<std::vector<glm::vec3>> vectors;

  explicit Targets(std::vector<baseline::Rows> rows, size_t chains);
};

}  // namespace skitter::bench
