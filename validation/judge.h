#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>

namespace skitter::validation {

// What one stage came to over all its samples.
struct StageResult {
  std::string name;
  uint64_t samples = 0;
  uint64_t kept = 0;     // records that had to stay as they were, and did
  double maxError = 0;   // of the quantity that is worst relative to its own tolerance
  double tolerance = 0;  // of that quantity, in that sample
  // Samples in which a choice fell the other way within its margin, and the rest of which is right for that
  // choice.
  uint64_t ties = 0;
  bool pass = true;
  std::string worst;  // that quantity, agent, leg, expected, got
  std::string why;    // empty where it passed, else every reason why it did not

  double ratio() const;  // of error and tolerance
};

// The comparisons of one sample; the one worst relative to its tolerance is kept.
class Sample {
 public:
  void compare(const char* quantity, double error, double tolerance, const glm::dvec4& expected,
               const glm::dvec4& got);
  // A quantity that must be the same exactly.
  void same(const char* quantity, double expected, double got);
  // Every float of a record.
  void finite(const char* record, std::span<const float> values);

  bool passes() const { return !(ratio_ > 1); }

 private:
  friend class Judge;
  const char* quantity_ = "";
  double error_ = 0, tolerance_ = 0, ratio_ = -1;
  glm::dvec4 expected_{0}, got_{0};
};

// Gathers the samples of one stage.
class Judge {
 public:
  // Messages number agents from `firstAgent` on.
  explicit Judge(std::string name, uint64_t firstAgent = 0) : firstAgent_(firstAgent) {
    result_.name = std::move(name);
  }
  // leg < 0: the sample is a whole agent.
  void add(uint64_t tick, uint64_t agent, int leg, const Sample& sample, bool tie = false);
  // A record had to stay as it was, and did; where it did not, it is a sample that fails.
  void keep() { ++result_.kept; }
  bool hasRefused() const { return ratio_ > 1; }
  // Passes if there was something to compare and every sample passed.
  StageResult result() const;

 private:
  uint64_t firstAgent_;
  StageResult result_;
  double ratio_ = -1;
};

}  // namespace skitter::validation
