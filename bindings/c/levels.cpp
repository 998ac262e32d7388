#include "skitter/levels.h"

#include <algorithm>
#include <limits>

#include "bindings/c/handles.h"

using namespace skitter;
using c::crowdOf;
using c::given;
using c::guarded;

namespace {

skitter_level_figures figuresOf(const LevelFigures& level) {
  return {.rate = level.rate,
          .agents = level.agents,
          .agent_ticks = level.agentTicks,
          .slip = level.slip.value_or(std::numeric_limits<double>::quiet_NaN())};
}

}  // namespace

skitter_result skitter_levels_load(const char* file_or_default, skitter_levels* levels) {
  return guarded([&] {
    given(file_or_default, "file_or_default");
    skitter_levels& to = given(levels, "levels");
    const Levels loaded = loadLevels(file_or_default);
    std::ranges::copy(loaded.distances, to.distances);
    std::ranges::copy(loaded.most, to.most);
  });
}

skitter_result skitter_crowd_look_from(skitter_crowd* crowd, const float camera[3]) {
  return guarded([&] {
    Crowd& looked = crowdOf(crowd);
    given(camera, "camera");
    looked.lookFrom({camera[0], camera[1], camera[2]});
  });
}

skitter_result skitter_crowd_levels(const skitter_crowd* crowd, skitter_level_figures* levels, size_t room,
                                    size_t* count) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    c::Told<skitter_level_figures>(levels, room, "levels", count).write(asked.levels(), figuresOf);
  });
}
