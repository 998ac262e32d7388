#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "laws/creature.h"
#include "laws/ground.h"
#include "laws/tally.h"

namespace skitter::laws {

// Where an agent's body is.
struct Body {
  bool present = true;
  glm::dvec3 position{0};  // world metres, of model space's origin
  glm::dmat3 rotation{1};  // world from model
  double asked = 0;        // speed that it is asked for, metres per second
  // Nothing but the ground keeps it from going as asked: it carries nothing, has all its legs, and nobody and
  // no obstacle is near.
  bool isFree = true;
  bool isSteady = true;  // it neither stumbles nor lies
};

// Judges the bodies of a herd: grounded, upright, facing and progress.
class BodyJudge {
 public:
  // `anatomies` of its sizes; they and the tally outlive this.
  BodyJudge(std::vector<const Anatomy*> anatomies, std::vector<const Creature*> creatures, Tally& tally);

  // Looks at one of them: `seconds` is the time of the tick, `size` counts through the anatomies.
  void look(uint64_t tick, double seconds, const Ground& ground, const Body& body, uint32_t agent,
            size_t size);
  // Agents are elsewhere: they were put there.
  void forget() { trails_.clear(); }

 private:
  struct Trail {
    double seconds = -1;
    Body body;
    double askedBefore = -1;  // at the look before that one
  };
  std::vector<const Anatomy*> anatomies_;
  std::vector<const Creature*> creatures_;
  Tally& tally_;
  std::vector<Trail> trails_;
};

// A body among those of all herds.
struct Solid {
  const Anatomy* anatomy;
  const Creature* creature;
  Tally* tally;
  uint32_t agent;
  Body body;
};
// Judges apart.
void judgeApart(uint64_t tick, const std::vector<Solid>& solids);

}  // namespace skitter::laws
