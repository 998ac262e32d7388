#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "laws/creature.h"
#include "laws/ground.h"
#include "laws/tally.h"

namespace skitter::laws {

// An agent as it is drawn after a tick.
struct Moment {
  uint64_t tick = 0;
  glm::dvec3 position{0};                // world metres, of model space's origin
  std::vector<glm::dmat4x3> bones = {};  // each takes a vertex at rest to the world
  // A flag for each leg: its foot stands. Empty: unknown, and soles are not judged.
  std::vector<bool> stands = {};
  std::vector<bool> carries = {};  // of each leg, false: it is lost or stuck; empty: all carry
};

// Judges the skin of one agent over ticks that follow each other: soles, body-depth, knees, stretch, jerk and
// crossing.
class SkinJudge {
 public:
  // All of these outlive this. `dt`: seconds from one moment to the next.
  SkinJudge(const Creature& creature, const Anatomy& anatomy, Tally& tally, uint32_t agent, double dt);

  void look(const Moment& moment, const Ground& ground);
  // What is only known of a whole stretch of time. To be called once, at its end.
  void finish();

 private:
  // Differences of a point from tick to tick, and what came of stretches of its way.
  struct Trail {
    std::array<glm::dvec3, 3> differences{};
    glm::dvec3 last{0};
    uint32_t count = 0, ticks = 0;  // moments seen, and those of the open stretch
    double path = 0, square = 0;    // of the open stretch
    double sum = 0, weight = 0;     // over stretches
  };
  struct Stance {
    bool wasSeen = false;  // its begin
    bool stands = false;
    bool swings = false;  // since a moment that was seen
    double slid = 0;
    std::vector<glm::dvec3> begin;     // of the sole's vertices
    std::vector<double> heights = {};  // of the lowest vertex over the ground, metres
  };
  glm::dvec3 place(uint32_t vertex) const;
  glm::dvec3 place(const LegJoint& joint) const;
  void look(size_t leg, const Ground& ground);
  static void follow(Trail& trail, const glm::dvec3& place);
  void endStretch(Trail& trail) const;
  void endStance(Stance& stance, uint64_t tick, bool hasEnded);
  void judgeKnees(size_t leg);
  void judgeStretch();
  void judgeBody(const Ground& ground);
  void judgeCrossing();
  // Of the lowest one of these vertices, square to the ground.
  double heightOf(std::span<const uint32_t> vertices, const Ground& ground) const;
  bool carries(size_t leg) const { return moment_->carries.empty() || moment_->carries[leg]; }

  const Creature& creature_;
  const Anatomy& anatomy_;
  Tally& tally_;
  uint32_t agent_;
  double dt_;
  uint32_t window_;  // ticks
  const Moment* moment_ = nullptr;
  std::vector<std::vector<glm::dvec3>> joints_;  // of each leg, where they are in this moment
  std::vector<glm::dvec3> sole_;                 // the same of the vertices of one sole
  uint64_t first_ = 0, last_ = 0, moments_ = 0;
  std::vector<Stance> stances_;
  Trail body_;
  uint64_t going_ = 0;  // moments in a row in which the body went
  std::vector<Trail> soles_;
  std::vector<std::vector<bool>> turned_;  // of each leg's knees: whether it bends to the wrong side
  uint64_t flips_ = 0, firstFlip_ = 0;
  std::vector<uint64_t> crossed_;  // of each pair of bones: ticks in a row
  uint64_t crossedMost_ = 0, crossedAt_ = 0;
};

}  // namespace skitter::laws
