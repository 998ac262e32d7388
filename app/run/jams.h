#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

// How a crowd gets on (docs/json.md). Places are world x, z in metres.
namespace skitter::app {

// How far an agent has been from where it is now, at most: of the places where it was.
double movedFrom(std::span<const glm::dvec2> places, const glm::dvec2& now);

// An agent over ten seconds.
struct Advance {
  glm::dvec2 now{0};
  double moved = 0;       // movedFrom of these, metres
  glm::dvec2 wanted{0};   // desired velocity at the end, m/s
  double radius = 0;      // of its footprint
  bool isThere = false;   // all the time
  bool hasPoint = false;  // its goal is a point
};

enum class Standing {
  moves,    // or wants nothing
  waits,    // behind somebody who moves, or waits
  arrived,  // or stands behind somebody who has
  stuck,
};
std::vector<Standing> standingsOf(std::span<const Advance> agents);

// Whether an agent that wants to go at `wanted` goes at less than half of it, m/s; NaN of one that is not
// there.
bool isInJam(double wanted, double speed);

// The traffic through a place.
struct Flow {
  double flow = 0;  // agents per second and metre
  // The longest time for which nobody came there or beside it, until nobody is there any more, seconds.
  double pause = 0;
};

// How much goes through places: squares, of which each counts the way that agents go in it. Beside a square
// are the two that lie with it across the way that most go.
class FlowMap {
 public:
  explicit FlowMap(double side) : side_(side) {}

  // An agent's move, in the time that ends at `seconds`.
  void add(const glm::dvec2& from, const glm::dvec2& to, double seconds);
  // The flow through the square with most, among those in which agents were for ten seconds or more between
  // the first one and the last; none without such a square.
  std::optional<Flow> most() const;

 private:
  struct Square {
    double way = 0, first = 0, last = 0;  // metres, seconds
    glm::dvec2 along{0};                  // of the way, how much lies along x and z
    // When somebody came last to the row of three along x, and to the one along z.
    std::array<double, 2> came{}, pause{};
  };
  double side_;
  std::map<std::pair<int64_t, int64_t>, Square> squares_;
};

// An agent's legs seen from above, each from root to foot.
using LegLines = std::vector<std::vector<glm::dvec2>>;
// Whether a leg of one crosses a leg of the other.
bool legsCross(const LegLines& a, const LegLines& b);
// Which agents cross somebody's legs, not their own. Legs reach `reach` from a place at most.
std::vector<bool> crossingAgents(std::span<const LegLines> agents, std::span<const glm::dvec2> places,
                                 double reach);

}  // namespace skitter::app
