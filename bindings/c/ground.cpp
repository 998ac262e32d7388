#include <algorithm>

#include "bindings/c/handles.h"

using namespace skitter;
using c::crowdOf;
using c::given;
using c::guarded;

skitter_result skitter_crowd_edit_heights(skitter_crowd* crowd, uint32_t x, uint32_t z, uint32_t columns,
                                          uint32_t rows, const float* heights) {
  return guarded([&] {
    crowdOf(crowd).editHeights(x, z, columns, rows, c::listOf(heights, size_t{columns} * rows, "heights"));
  });
}

skitter_result skitter_crowd_terrain(const skitter_crowd* crowd, skitter_terrain* terrain) {
  return c::tell(crowd, terrain, "terrain", [](const Crowd& asked) {
    const Heightfield& ground = asked.terrain();
    return skitter_terrain{.columns = ground.columns,
                           .rows = ground.rows,
                           .spacing_x = ground.spacingX,
                           .spacing_z = ground.spacingZ};
  });
}

skitter_result skitter_crowd_heights(const skitter_crowd* crowd, float* heights, size_t room) {
  return guarded([&] {
    const std::vector<float>& samples = crowdOf(crowd).terrain().heights;
    given(heights, "heights");
    c::checkRoom("heights", room, samples.size());
    std::ranges::copy(samples, heights);
  });
}

skitter_result skitter_crowd_ground(const skitter_crowd* crowd, float x, float z, float* height,
                                    float normal[3]) {
  return guarded([&] {
    const Heightfield& ground = crowdOf(crowd).terrain();
    bindings::expectFinite("the place", {x, 0, z});
    if (height != nullptr) *height = ground.at(x, z);
    if (normal != nullptr) c::copyVector(ground.normalAt(x, z), normal);
  });
}
