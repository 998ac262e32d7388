#pragma once

#include <compare>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "app/viewer/lens.h"
#include "cpu_reference/types.h"
#include "skitter/crowd.h"

namespace skitter::app {

struct AgentId {
  uint32_t herd = 0, agent = 0;
  friend bool operator==(const AgentId&, const AgentId&) = default;
};

// The agent that is drawn nearest to a pixel, at most `most` pixels beside its legs; none that the ground
// hides. Waits for the device.
std::optional<AgentId> agentAt(const Crowd& crowd, const Lens& lens, const glm::vec2& pixel, float most);
// Whether the crowd has such a place.
bool hasPlace(const Crowd& crowd, AgentId id);
// The one after or before, through all herds.
AgentId neighbourOf(const Crowd& crowd, AgentId id, bool after);

// The ladder of candidates from which a step's landing was chosen. World metres.
struct Ladder {
  struct Candidate {
    glm::vec3 at;
    bool fits;
  };
  std::vector<Candidate> candidates;  // rungs of 3, 5, 7 and 9, in scan order
};

// How far a bone may turn from rest: its joint, the way it would go at rest, and the half-angle of the cone.
struct Cone {
  glm::vec3 apex, axis;
  float halfAngle, length;  // the latter of the bone
  float used;               // share of it that the bone has turned
};

// World metres.
struct LegView {
  std::vector<glm::vec3> joints;  // root to tip
  std::vector<Cone> cones;        // of bones that are limited
  bool planted = false;
  std::optional<glm::vec3> landing;  // of the present step, where steps are aimed
  std::optional<Ladder> ladder;      // of it, if it began while somebody looked
  std::vector<glm::vec3> spline;     // of a foot in the air, where it goes along one
  float flown = 1;                   // share of the spline
};

// What is known of the agent that the camera follows.
class Followed {
 public:
  Followed(const Crowd& crowd, AgentId id);

  AgentId id() const { return id_; }
  // Not once its herd is gone, whoever has its number then.
  bool isThere(const Crowd& crowd) const { return crowd.has(herd_); }
  // After each tick in which it is there. Waits for the device.
  void look(const Crowd& crowd);
  glm::vec3 middle() const;  // of its body, which the support polygon should hold
  float speed() const;       // m/s
  float legLength() const { return legLength_; }
  const std::vector<LegView>& legs() const { return legs_; }

 private:
  void lookAtLeg(const Crowd& crowd, size_t leg);

  AgentId id_;
  HerdId herd_;
  reference::Creature creature_;
  float legLength_ = 1, bodyHeight_ = 0;
  HerdState before_, now_;
  std::vector<LegView> legs_;
};

}  // namespace skitter::app
