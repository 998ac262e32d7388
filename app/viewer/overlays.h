#pragma once

#include "app/viewer/followed.h"
#include "app/viewer/lens.h"
#include "skitter/heightfield.h"

struct ImDrawList;

namespace skitter::app {

// What is drawn over the agent that is followed.
struct Overlays {
  bool chains = false, footholds = false, splines = false, support = false;

  bool any() const { return chains || footholds || splines || support; }
  void draw(ImDrawList& list, const Lens& lens, const Followed& agent, const Heightfield& ground) const;
};

}  // namespace skitter::app
