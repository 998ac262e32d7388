#include "skitter/readback.h"

#include "bindings/c/handles.h"

using namespace skitter;
using c::given;
using c::guarded;

namespace {

ReadbackOptions optionsOf(const skitter_readback_options& asked) {
  ReadbackOptions options;
  const auto herds = c::listOf(asked.herds, asked.herd_count, "options->herds");
  options.herds.assign(herds.begin(), herds.end());
  if (asked.slots != 0) options.slots = asked.slots;
  return options;
}

// The latest snapshot. Throws Error(input) where none was taken.
const Snapshot& takenFrom(const skitter_readback* readback) {
  const std::optional<Snapshot>& taken = given(readback, "readback").taken;
  if (!taken) throw inputError("readback: nothing is taken, expected skitter_readback_take() before");
  return *taken;
}

// The memory that was looked into may be written again.
void recordCopy(skitter_readback& readback, VkCommandBuffer commands) {
  readback.taken.reset();
  readback.readback.record(commands);
}

}  // namespace

skitter_result skitter_readback_create(skitter_crowd* crowd, const skitter_readback_options* options,
                                       skitter_readback** readback) {
  return guarded([&] {
    const std::shared_ptr<c::LiveCrowd>& live = given(crowd, "crowd").live;
    given(readback, "readback");
    const ReadbackOptions made = options != nullptr ? optionsOf(*options) : ReadbackOptions{};
    *readback = new skitter_readback{live, Readback(*live->device, live->crowd, made)};
  });
}

skitter_result skitter_readback_record(skitter_readback* readback, VkCommandBuffer commands) {
  return guarded([&] {
    skitter_readback& ring = given(readback, "readback");
    given(commands, "commands");
    recordCopy(ring, commands);
  });
}

skitter_result skitter_readback_step(skitter_readback* readback, uint64_t ticks, float dt) {
  return guarded([&] {
    skitter_readback& ring = given(readback, "readback");
    c::LiveCrowd& walker = *ring.live;
    for (uint64_t left = ticks; left > 0; --left)
      walker.walk.submit([&](VkCommandBuffer commands) {
        walker.crowd.record(commands, dt);
        if (left == 1) recordCopy(ring, commands);
      });
  });
}

skitter_result skitter_readback_skipped(const skitter_readback* readback, uint64_t* skipped) {
  return guarded([&] {
    const Readback& ring = given(readback, "readback").readback;
    given(skipped, "skipped");
    *skipped = ring.skipped();
  });
}

skitter_result skitter_readback_take(skitter_readback* readback, uint64_t* tick, int* found) {
  return guarded([&] {
    skitter_readback& ring = given(readback, "readback");
    given(tick, "tick");
    given(found, "found");
    ring.taken = ring.readback.latest();
    *found = ring.taken ? 1 : 0;
    if (ring.taken) *tick = ring.taken->tick();
  });
}

skitter_result skitter_readback_places(const skitter_readback* readback, uint32_t herd, uint32_t* places) {
  return guarded([&] {
    const Snapshot& taken = takenFrom(readback);
    given(places, "places");
    *places = taken.agents(herd);
  });
}

skitter_result skitter_readback_positions(const skitter_readback* readback, uint32_t herd,
                                          const double* origin, double* xyz, size_t room) {
  return guarded([&] {
    const Snapshot& taken = takenFrom(readback);
    const glm::dvec3 from = c::originOf(origin);
    given(xyz, "xyz");
    c::checkRoom("xyz", room, taken.agents(herd));
    for (uint32_t agent = 0; agent < taken.agents(herd); ++agent)
      c::copyVector(taken.body(herd, agent, from).position, xyz + 3 * size_t{agent});
  });
}

skitter_result skitter_readback_bodies(const skitter_readback* readback, uint32_t herd,
                                       const float** records) {
  return guarded([&] {
    const Snapshot& taken = takenFrom(readback);
    given(records, "records");
    *records = taken.bodies(herd).data();
  });
}

skitter_result skitter_readback_bounds(const skitter_readback* readback, uint32_t herd, const double* origin,
                                       double least[3], double most[3], int* found) {
  return guarded([&] {
    const Snapshot& taken = takenFrom(readback);
    given(least, "least");
    given(most, "most");
    given(found, "found");
    const std::optional<Box> box = taken.bounds(herd, c::originOf(origin));
    *found = box ? 1 : 0;
    if (!box) return;
    c::copyVector(box->least, least);
    c::copyVector(box->most, most);
  });
}

skitter_result skitter_readback_pick(const skitter_readback* readback, const double start[3],
                                     const double direction[3], double length, skitter_picked* picked,
                                     int* found) {
  return guarded([&] {
    const Snapshot& taken = takenFrom(readback);
    const Ray ray = bindings::rayOf(c::vectorOf(start, "start"), c::vectorOf(direction, "direction"), length);
    c::tellPicked(picked, found, [&] { return taken.pick(ray); });
  });
}

skitter_result skitter_readback_nearest(const skitter_readback* readback, const double point[3],
                                        skitter_picked* picked, int* found) {
  return guarded([&] {
    const Snapshot& taken = takenFrom(readback);
    const glm::dvec3 to = c::vectorOf(point, "point");
    bindings::expectFinite("point", to);
    c::tellPicked(picked, found, [&] { return taken.nearest(to); });
  });
}

skitter_result skitter_readback_destroy(skitter_readback* readback) {
  return guarded([&] {
    const std::unique_ptr<skitter_readback> gone(readback);
    if (gone) gone->live->walk.wait();
  });
}
