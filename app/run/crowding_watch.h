#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "app/run/jams.h"
#include "skitter/crowd.h"

namespace skitter::app {

// How a crowd gets on, beside Crowd::crowding (docs/json.md). Without --crowding there are none.
struct Jams {
  std::optional<uint64_t> stuck = {}, arrived = {};
  // Shares of the agents that were looked at.
  std::optional<double> legCrossings = {}, legCrossingsOutsideJams = {}, jammed = {};
  std::optional<Flow> flow = {};
};

// Looks at a crowd ten times a second, and closely once a second. Waits for the device then. The crowd has
// poses and feet.
class CrowdingWatch {
 public:
  // From the tick that the crowd is at.
  CrowdingWatch(const Crowd& crowd, double dt);

  // After each tick.
  void look(const Crowd& crowd);
  Jams jams() const;

 private:
  // All agents, herd after herd and place after place.
  struct Moment {
    std::vector<glm::dvec2> places, wanted;  // NaN where nobody is
    std::vector<double> speeds;              // likewise
    std::vector<bool> hasPoint;
  };
  Moment momentOf(const Crowd& crowd) const;
  void follow(const Crowd& crowd);
  void lookClosely(const Crowd& crowd, const Moment& now);
  void countCrossings(const Crowd& crowd, const Moment& now);

  uint64_t first_, often_, rarely_;  // ticks
  double dt_;
  double widest_ = 0, reach_ = 0;  // metres, a footprint's radius and how far legs get
  FlowMap flow_;
  std::optional<Moment> last_;
  std::deque<Moment> seconds_;  // of the last ten, the earliest first
  std::vector<bool> stuck_, arrived_;
  // Agents, each time that they were looked at closely.
  uint64_t looked_ = 0, crossed_ = 0, jammed_ = 0, jammedCrossed_ = 0;
};

}  // namespace skitter::app
