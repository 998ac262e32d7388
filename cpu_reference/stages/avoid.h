#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cpu_reference/types.h"

namespace skitter::reference {

// An agent as others see it: its place in whole quanta, and its velocity x, z.
struct Walker {
  int64_t number = 0;  // in the crowd
  int64_t x = 0, z = 0, radius = 0;
  glm::dvec2 velocity{0};
  bool yields = false;  // its herd avoids
};

// An obstacle: all within `radius` of the convex hull of its corners, in metres. One corner makes a disc, two
// a capsule; of more, which are in order, none lies on a line with its neighbours.
struct AvoidObstacle {
  std::vector<glm::dvec2> corners;
  double radius = 0;
};

struct AvoidTuning {
  double quanta = 1024;  // in a metre
  int64_t look = 0;      // quanta between footprints, up to which another agent, or an obstacle, is seen
  double legLength = 1;
  std::vector<AvoidObstacle> obstacles = {};
};

// An agent looks around in one tick, and what it decides holds until it looks again.
struct AvoidTick {
  int64_t number = 1;    // of the crowd, by which agents go first
  double dt = 1.0 / 60;  // seconds until it looks again
  int span = 1;          // so many ticks of the crowd
};
// Ticks of the crowd in a round, in which everybody looks around once.
int roundTicks(double dt);
// Whether an agent of its kind does so in that tick of the crowd.
bool looksAround(int64_t numberInKind, uint64_t tick, int roundTicks);

// One neighbour asks for n . v >= bound.
struct HalfPlane {
  int64_t neighbour = 0;  // its number
  glm::dvec2 n{0};
  double bound = 0;
  // How far the choice of the side is from the other one, m/s; infinite where there is none.
  double sideMargin = 0;
  int right = -1;  // 1 or 0: the side that was taken; -1 where there is none
};

// An obstacle asks for the same form.
struct ObstaclePlane {
  size_t obstacle = 0;  // its place in AvoidTuning
  glm::dvec2 n{0};
  double bound = 0;
};

// Decisions that the caller takes instead of the rule, to recompute the other side of a tie.
struct AvoidChoices {
  std::vector<int> right = {};  // 0 or 1: forced, of the half-plane in that place
  int stands = -1;
  bool otherObstacle = false;  // the nearest one that is left out takes the place of the farthest that is not
};

// Errors as float32 makes them, drawn uniformly: Monte Carlo arithmetic (Parker 1997).
struct AvoidErrors {
  double number = 0;  // share of a number
  uint64_t seed = 0;
};

struct AvoidResult {
  glm::dvec2 velocity{0};
  double mostSpeed = 0;  // m/s, along the heading
  bool asleep = false;
  int64_t seen = 0;                                // agents in reach, those that the cap drops among them
  std::vector<HalfPlane> planes;                   // of the nearest, the nearest first
  std::vector<ObstaclePlane> obstaclePlanes = {};  // of the nearest, in the order of AvoidTuning
  // By how much the farthest of these is nearer than the next one, a share of the lengths that this follows
  // from; infinite where there is none.
  double obstacleMargin = 0;
  double standMargin = 0;  // of |v| from what counts as standing, m/s; infinite where not asked
};

constexpr size_t mostNeighbours = 8, mostObstacles = 4;

// A walker of that body, with a footprint of that radius in quanta.
Walker walkerOf(const AgentBody& body, int64_t number, int64_t radius, bool yields, double quanta);

// Those of `all` whom the agent keeps clear of, the nearest first.
std::vector<Walker> neighboursOf(const AvoidTuning& tuning, const Walker& self, std::span<const Walker> all);

// `self` as others see it; `all` are the walkers of the crowd, itself among them. `desired` and `asleep` are
// navigate's.
AvoidResult avoid(const AvoidTuning& tuning, const AvoidTick& tick, const AgentBody& body, const Walker& self,
                  std::span<const Walker> all, const glm::dvec2& desired, bool asleep,
                  const AvoidChoices& choices = {}, const AvoidErrors& errors = {});

}  // namespace skitter::reference
