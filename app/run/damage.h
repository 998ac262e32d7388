#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

// How agents get on whose legs are hurt (docs/json.md).
namespace skitter::app {

struct DamageFigures {
  // From there on a speed is no walk's, but that of feet that slide or do not arrive.
  static constexpr double mostSlip = 0.01, mostReachError = 0.01;

  uint64_t agents = 0;                       // that were looked at
  std::optional<double> speedKept = {};      // times what the same agents have in the same run without damage
  std::optional<double> unstable = {};       // share of agent-ticks
  std::optional<double> slip = {};           // leg lengths per stance, of the agent that slips most
  std::optional<double> reachErrorP99 = {};  // leg lengths

  // Whether the speed counts; none without a speed.
  std::optional<bool> counts() const;
};
nlohmann::ordered_json jsonOf(const DamageFigures& figures);

// An agent with a leg that is hurt, at the end of a tick. Places are world x, z in metres.
struct HurtAgent {
  struct Leg {
    glm::dvec2 tip{0};
    bool carries = true, isPlanted = false;
    double error = 0;  // metres from the tip to where it should be
  };
  double legLength = 1;  // metres
  glm::dvec2 centre{0};  // of the body
  std::vector<Leg> legs = {};
};

class DamageTally {
 public:
  // Of an agent, by any number that it always has.
  void add(uint64_t agent, uint64_t tick, const HurtAgent& now);
  // Metres per second, hurt and as if it never had been.
  void addSpeed(double hurt, double whole);
  DamageFigures figures() const;

 private:
  struct Foot {
    glm::dvec2 tip{0};
    bool isPlanted = false;
    std::optional<double> slip = {};  // of a stance whose beginning was seen
  };
  struct Seen {
    uint64_t tick = 0;
    std::vector<Foot> feet = {};
    double slip = 0;  // leg lengths, of the stances that have ended
    uint64_t stances = 0;
  };
  void follow(const HurtAgent::Leg& leg, double legLength, Foot& foot, Seen& seen) const;
  void addError(double error);
  std::optional<double> errorP99() const;

  // Of reach errors, 32 to an octave: what is more than 2^-30 leg lengths is told to 2 %.
  static constexpr int octave = 32, octaves = 32, leastExponent = -30;
  std::array<uint64_t, size_t{octave} * octaves> errors_{};
  double errorMost_ = 0;
  std::map<uint64_t, Seen> agents_;
  uint64_t agentTicks_ = 0, unstable_ = 0;
  double hurtSpeeds_ = 0, wholeSpeeds_ = 0;
};

}  // namespace skitter::app
