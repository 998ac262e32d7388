#include <algorithm>
#include <cmath>
#include <limits>

#include "bindings/c/handles.h"
#include "bindings/common/herd_reader.h"

using namespace skitter;
using c::crowdOf;
using c::given;
using c::guarded;

namespace {

// Writes what `ask` says of the crowd.
template <typename Value, typename Ask>
skitter_result tell(const skitter_crowd* crowd, Value* value, const char* name, Ask ask) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(value, name);
    *value = ask(asked);
  });
}

CrowdOptions optionsOf(const skitter_crowd_options& asked) {
  CrowdOptions options;
  options.pose = asked.no_poses == 0;
  options.measure = asked.no_figures == 0;
  options.watchEvery = asked.watch_every;
  options.footfalls = asked.footfalls;
  options.sleep = asked.sleep != 0;
  return options;
}

glm::dvec3 vectorOf(const double* xyz, const char* name) {
  given(xyz, name);
  return {xyz[0], xyz[1], xyz[2]};
}

// Writes the agent that `ask` finds, if any.
template <typename Ask>
void tellOf(skitter_picked* picked, int* found, Ask ask) {
  given(picked, "picked");
  given(found, "found");
  const std::optional<Picked> agent = ask();
  *found = agent ? 1 : 0;
  if (agent)
    *picked = {agent->herd, agent->agent, agent->distance, {agent->place.x, agent->place.y, agent->place.z}};
}

skitter_fidelity convert(const Fidelity& f) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  return {.agent_ticks = f.agentTicks,
          .stances = f.stances,
          .slip = f.slip,
          .skating = f.skating,
          .penetration = f.penetration,
          .penetration_beyond = f.penetrationBeyond,
          .floating = f.floating,
          .floating_beyond = f.floatingBeyond,
          .segment_penetration = f.segmentPenetration,
          .segment_penetration_most = f.segmentPenetrationMost,
          .crossing = f.crossing,
          .reach_error_p99 = f.reachErrorP99,
          .reach_error_most = f.reachErrorMost,
          .limit_violation = f.limitViolation.value_or(none),
          .limit_violations = f.limitViolations.value_or(none),
          .foot_jerk = f.footJerk,
          .body_jerk = f.bodyJerk,
          .margin = f.margin,
          .margin_least = f.marginLeast,
          .unstable = f.unstable,
          .last_resorts = f.lastResorts,
          .not_finite = f.notFinite};
}

}  // namespace

skitter_result skitter_crowd_create(skitter_device* device, const skitter_scene* scene,
                                    const skitter_crowd_options* options, skitter_crowd** crowd) {
  return guarded([&] {
    const std::shared_ptr<Device>& on = given(device, "device").device;
    const Scene& from = given(scene, "scene").scene;
    given(crowd, "crowd");
    const CrowdOptions made = options != nullptr ? optionsOf(*options) : CrowdOptions{};
    *crowd = new skitter_crowd{on, Crowd(*on, from.loadTerrain(), from, made), bindings::Walk(*on)};
  });
}

skitter_result skitter_crowd_resume(skitter_device* device, const skitter_state* state,
                                    const skitter_crowd_options* options, skitter_crowd** crowd) {
  return guarded([&] {
    const std::shared_ptr<Device>& on = given(device, "device").device;
    State from = given(state, "state").state;
    given(crowd, "crowd");
    if (options != nullptr) {
      const CrowdOptions asked = optionsOf(*options);
      from.options.pose = asked.pose;
      from.options.footfalls = asked.footfalls;
      from.options.sleep = asked.sleep;
    }
    *crowd = new skitter_crowd{on, Crowd(*on, from), bindings::Walk(*on)};
  });
}

skitter_result skitter_crowd_record(skitter_crowd* crowd, VkCommandBuffer commands, float dt) {
  return guarded([&] {
    given(commands, "commands");
    given(crowd, "crowd").crowd.record(commands, dt);
  });
}

skitter_result skitter_crowd_step(skitter_crowd* crowd, uint64_t ticks, float dt) {
  return guarded([&] {
    skitter_crowd& walker = given(crowd, "crowd");
    walker.walk.step(walker.crowd, ticks, dt);
  });
}

skitter_result skitter_crowd_edit_heights(skitter_crowd* crowd, uint32_t x, uint32_t z, uint32_t columns,
                                          uint32_t rows, const float* heights) {
  return guarded([&] {
    Crowd& edited = given(crowd, "crowd").crowd;
    edited.editHeights(x, z, columns, rows, c::listOf(heights, size_t{columns} * rows, "heights"));
  });
}

skitter_result skitter_crowd_tick(const skitter_crowd* crowd, uint64_t* tick) {
  return tell(crowd, tick, "tick", [](const Crowd& c) { return c.tick(); });
}

skitter_result skitter_crowd_herds(const skitter_crowd* crowd, uint32_t* herds) {
  return tell(crowd, herds, "herds", [](const Crowd& c) { return c.herdCount(); });
}

skitter_result skitter_crowd_agent_count(const skitter_crowd* crowd, uint64_t* agents) {
  return tell(crowd, agents, "agents", [](const Crowd& c) { return c.agentCount(); });
}

skitter_result skitter_crowd_herd_agents(const skitter_crowd* crowd, uint32_t herd, uint32_t* agents) {
  return tell(crowd, agents, "agents", [&](const Crowd& c) { return c.agentCount(herd); });
}

skitter_result skitter_crowd_herd_places(const skitter_crowd* crowd, uint32_t herd, uint32_t* places) {
  return tell(crowd, places, "places", [&](const Crowd& c) { return c.places(herd); });
}

skitter_result skitter_crowd_herd_legs(const skitter_crowd* crowd, uint32_t herd, uint32_t* legs) {
  return tell(crowd, legs, "legs", [&](const Crowd& c) { return bindings::legsOf(c, herd); });
}

skitter_result skitter_crowd_herd_bones(const skitter_crowd* crowd, uint32_t herd, uint32_t* bones) {
  return tell(crowd, bones, "bones", [&](const Crowd& c) { return bindings::bonesOf(c, herd); });
}

skitter_result skitter_crowd_sizes(const skitter_crowd* crowd, uint32_t herd, float* sizes, size_t room) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(sizes, "sizes");
    c::checkRoom("sizes", room, asked.places(herd));
    std::ranges::copy(bindings::sizesOf(asked, herd), sizes);
  });
}

skitter_result skitter_crowd_positions(const skitter_crowd* crowd, uint32_t herd, double* xyz, size_t room) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(xyz, "xyz");
    c::checkRoom("xyz", room, asked.places(herd));
    c::copyVectors(bindings::positionsOf(asked, herd), xyz);
  });
}

skitter_result skitter_crowd_headings(const skitter_crowd* crowd, uint32_t herd, float* radians,
                                      size_t room) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(radians, "radians");
    c::checkRoom("radians", room, asked.places(herd));
    for (const BodyState& body : bindings::bodiesOf(asked, herd)) *radians++ = bindings::headingOf(body);
  });
}

skitter_result skitter_crowd_joints(const skitter_crowd* crowd, uint32_t herd, double* xyz, size_t room) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(xyz, "xyz");
    c::checkRoom(
        "xyz", room,
        size_t{asked.places(herd)} * bindings::legsOf(asked, herd) * (bindings::bonesOf(asked, herd) + 1));
    c::copyVectors(bindings::jointsOf(asked, herd), xyz);
  });
}

skitter_result skitter_crowd_state_hash(const skitter_crowd* crowd, uint64_t* hash) {
  return tell(crowd, hash, "hash", [](const Crowd& c) { return c.stateHash(); });
}

skitter_result skitter_crowd_fidelity(const skitter_crowd* crowd, uint32_t herd, skitter_fidelity* fidelity) {
  return tell(crowd, fidelity, "fidelity", [&](const Crowd& c) {
    return convert(herd == SKITTER_ALL_HERDS ? c.fidelity() : c.fidelity(herd));
  });
}

skitter_result skitter_crowd_footfalls(const skitter_crowd* crowd, uint32_t herd, skitter_footfall* footfalls,
                                       size_t room, size_t* count) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(count, "count");
    if (room > 0) given(footfalls, "footfalls");
    const std::vector<Footfall> all = asked.footfalls(herd);
    for (size_t i = 0; i < all.size() && i < room; ++i)
      footfalls[i] = {all[i].tick,
                      all[i].agent,
                      all[i].leg,
                      {all[i].place.x, all[i].place.y, all[i].place.z},
                      all[i].speed};
    *count = all.size();
  });
}

skitter_result skitter_crowd_pick(const skitter_crowd* crowd, const double start[3],
                                  const double direction[3], double length, skitter_picked* picked,
                                  int* found) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    const glm::dvec3 from = vectorOf(start, "start"), along = vectorOf(direction, "direction");
    tellOf(picked, found, [&] { return bindings::pick(asked, from, along, length); });
  });
}

skitter_result skitter_crowd_nearest(const skitter_crowd* crowd, const double point[3],
                                     skitter_picked* picked, int* found) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    const glm::dvec3 to = vectorOf(point, "point");
    tellOf(picked, found, [&] { return bindings::nearest(asked, to); });
  });
}

skitter_result skitter_crowd_destroy(skitter_crowd* crowd) {
  return guarded([&] { delete crowd; });
}
