#pragma once

#include <optional>
#include <span>

#include "cpu_reference/types.h"

namespace skitter::reference {

// How one leg bears on the follow factor.
struct LegFollow {
  bool planted = false;
  double behind = 0;  // cosine between the desired velocity and (rho_l - f_l); the leg counts if positive
  double errorFactor = 1;  // clamp(1 - e_l / (errorStop reach_l), 0, 1), of every planted leg
  double factor = 1;       // clamp((stretchStop - stretch) / (stretchStop - stretchSlow), 0, 1)
};

// y = height + b x + c z relative to the previous body, with what its conditioning depends on.
struct SupportPlane {
  double b = 0, c = 0, height = 0;
  double leastEigenvalue = 0, largestEigenvalue = 0;  // of the regularised normal matrix
  glm::dvec3 mean{0};                                 // of the ground points, relative
  double spread = 0;        // root of the sum of squared horizontal distances from it
  double heightSpread = 0;  // of squared heights above it
  double unclampedSlope = 0;
};

// Heights of the ground below a body, and those of its origin at which its middle line clears the ground.
struct GroundBelow {
  double atOrigin = 0, highest = 0;  // below the origin, and of it and what is below the middle line's ends
  double ahead = 0, behind = 0;      // for the ends of the middle line
};

struct BodyResult {
  AgentBody body;
  std::vector<LegFollow> follow;
  double turnMargin = 0;  // |c| where its sign chose the way round (d <= 0), infinite elsewhere
  double goMargin = 0;    // of |v| from what counts as going anywhere, as a share of it
  SupportPlane plane;
  double wishedSpeed = 0;  // |v|
  double wantedSpeed = 0;  // without what is too steep
  GroundBelow ground;
  double rises = 0;            // of the ground ahead over the support plane,
  glm::dvec2 lookedAhead{0};   // and where that is
  double passes = 1;           // share of its speed that the ground ahead leaves
  double unhinderedSpeed = 0;  // that it would have without it
  double rise = 0;             // |y_want - y_pred|
  double heightMargin = 0;     // of the blended height from its bounds, negative where these hold the body
  glm::dvec2 ways{0};          // m left along the new heading to the terrain's edges in x and z
  bool isStill = false;
  double stillMargin = 0;  // nearest of the three thresholds of standing still, as a share of it
};

// Decisions that the caller takes instead of the rule, to recompute the other side of a tie.
struct BodyChoices {
  std::optional<double> follow;
  int turnSign = 0;  // +1, -1: forced
  int goes = -1;     // 0, 1: whether |v| counts as going anywhere
};

// Where a body is steered, and how fast it may go.
struct Wish {
  glm::dvec2 velocity;              // m/s
  std::optional<double> mostSpeed;  // m/s, along the heading, where the herd avoids

  Wish(const glm::dvec2& desired, std::optional<double> most = {}) : velocity(desired), mostSpeed(most) {}
};

// The largest speed from which a body still stops within `way`: it moves on by s dt in this tick, and brakes
// from the next one on.
double stoppingSpeed(const Tuning& tuning, double way);

// `misses`: Chain::miss of each leg after the last tick. `tick` is n, the tick being computed; `phase` the
// gait's after the last one.
BodyResult body(const Tuning& tuning, const Heights& heights, const Creature& creature,
                const AgentBody& previous, const Wish& wish, std::span<const Step> steps,
                std::span<const double> misses, double tick, double phase = 0,
                const BodyChoices& choices = {});

// A body that does not feel its feet: nothing holds it back, and the ground below the homes takes the place
// of the ground points. Of `choices` the turn's sign counts.
BodyResult blindBody(const Tuning& tuning, const Heights& heights, const Creature& creature,
                     const AgentBody& previous, const Wish& wish, const BodyChoices& choices = {});

}  // namespace skitter::reference
