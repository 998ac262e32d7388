#include <cmath>
#include <limits>

#include "bindings/c/handles.h"
#include "bindings/common/herd_reader.h"

using namespace skitter;
using c::given;
using c::guarded;

namespace {

const Crowd& crowdOf(const skitter_crowd* crowd) { return given(crowd, "crowd").crowd; }

// Writes what `ask` says of the crowd.
template <typename Value, typename Ask>
skitter_result tell(const skitter_crowd* crowd, Value* value, const char* name, Ask ask) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(value, name);
    *value = ask(asked);
  });
}

void copyPlaces(const std::vector<glm::dvec3>& places, double* xyz) {
  for (const glm::dvec3& place : places)
    for (int k = 0; k < 3; ++k) *xyz++ = place[k];
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
    const skitter_crowd_options asked = options != nullptr ? *options : skitter_crowd_options{};
    CrowdOptions made;
    made.pose = asked.no_poses == 0;
    made.measure = asked.no_figures == 0;
    made.watchEvery = asked.watch_every;
    made.footfalls = asked.footfalls;
    made.sleep = asked.sleep != 0;
    *crowd = new skitter_crowd{on, Crowd(*on, from.loadTerrain(), from, made), bindings::Walk(*on)};
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
  return tell(crowd, agents, "agents", [&](const Crowd& c) { return bindings::agentsOf(c, herd); });
}

skitter_result skitter_crowd_herd_legs(const skitter_crowd* crowd, uint32_t herd, uint32_t* legs) {
  return tell(crowd, legs, "legs", [&](const Crowd& c) { return bindings::legsOf(c, herd); });
}

skitter_result skitter_crowd_herd_bones(const skitter_crowd* crowd, uint32_t herd, uint32_t* bones) {
  return tell(crowd, bones, "bones", [&](const Crowd& c) { return bindings::bonesOf(c, herd); });
}

skitter_result skitter_crowd_positions(const skitter_crowd* crowd, uint32_t herd, double* xyz, size_t room) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(xyz, "xyz");
    c::checkRoom("xyz", room, bindings::agentsOf(asked, herd));
    copyPlaces(bindings::positionsOf(asked, herd), xyz);
  });
}

skitter_result skitter_crowd_headings(const skitter_crowd* crowd, uint32_t herd, float* radians,
                                      size_t room) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(radians, "radians");
    c::checkRoom("radians", room, bindings::agentsOf(asked, herd));
    for (const BodyState& body : bindings::bodiesOf(asked, herd)) *radians++ = bindings::headingOf(body);
  });
}

skitter_result skitter_crowd_joints(const skitter_crowd* crowd, uint32_t herd, double* xyz, size_t room) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(xyz, "xyz");
    c::checkRoom("xyz", room,
                 size_t{bindings::agentsOf(asked, herd)} * bindings::legsOf(asked, herd) *
                     (bindings::bonesOf(asked, herd) + 1));
    copyPlaces(bindings::jointsOf(asked, herd), xyz);
  });
}

skitter_result skitter_crowd_state_hash(const skitter_crowd* crowd, uint64_t* hash) {
  return tell(crowd, hash, "hash", [](const Crowd& c) { return c.stateHash(); });
}

skitter_result skitter_crowd_fidelity(const skitter_crowd* crowd, uint32_t herd, skitter_fidelity* fidelity) {
  return tell(crowd, fidelity, "fidelity", [&](const Crowd& c) {
    if (herd == SKITTER_ALL_HERDS) return convert(c.fidelity());
    bindings::checkHerd(c, herd);
    return convert(c.fidelity(herd));
  });
}

skitter_result skitter_crowd_footfalls(const skitter_crowd* crowd, uint32_t herd, skitter_footfall* footfalls,
                                       size_t room, size_t* count) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(count, "count");
    if (room > 0) given(footfalls, "footfalls");
    bindings::checkHerd(asked, herd);
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

skitter_result skitter_crowd_destroy(skitter_crowd* crowd) {
  return guarded([&] { delete crowd; });
}
