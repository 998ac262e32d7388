#include <algorithm>
#include <limits>
#include <utility>

#include "bindings/c/handles.h"
#include "bindings/common/herd_reader.h"

using namespace skitter;
using c::crowdOf;
using c::given;
using c::guarded;

namespace {

CrowdOptions optionsOf(const skitter_crowd_options& asked) {
  CrowdOptions options;
  options.pose = asked.no_poses == 0;
  options.measure = asked.no_figures == 0;
  options.watchEvery = asked.watch_every;
  options.footfalls = asked.footfalls;
  options.sleep = asked.sleep != 0;
  if (asked.levels != nullptr) {
    Levels& levels = options.levels.emplace();
    std::ranges::copy(asked.levels->distances, levels.distances.begin());
    std::ranges::copy(asked.levels->most, levels.most.begin());
  }
  return options;
}

skitter_crowd* handleOf(const std::shared_ptr<Device>& device, Crowd crowd) {
  std::shared_ptr<c::LiveCrowd> live(new c::LiveCrowd{device, std::move(crowd), bindings::Walk(*device)});
  return new skitter_crowd{std::move(live)};
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
    *crowd = handleOf(on, Crowd(*on, from.loadTerrain(), from, made));
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
      if (asked.levels) from.options.levels = asked.levels;
    }
    *crowd = handleOf(on, Crowd(*on, from));
  });
}

skitter_result skitter_crowd_record(skitter_crowd* crowd, VkCommandBuffer commands, float dt) {
  return guarded([&] {
    given(commands, "commands");
    crowdOf(crowd).record(commands, dt);
  });
}

skitter_result skitter_crowd_step(skitter_crowd* crowd, uint64_t ticks, float dt) {
  return guarded([&] {
    c::LiveCrowd& walker = *given(crowd, "crowd").live;
    walker.walk.step(walker.crowd, ticks, dt);
  });
}

skitter_result skitter_crowd_tick(const skitter_crowd* crowd, uint64_t* tick) {
  return c::tell(crowd, tick, "tick", [](const Crowd& asked) { return asked.tick(); });
}

skitter_result skitter_crowd_herds(const skitter_crowd* crowd, uint32_t* herds) {
  return c::tell(crowd, herds, "herds", [](const Crowd& asked) { return asked.herdCount(); });
}

skitter_result skitter_crowd_agent_count(const skitter_crowd* crowd, uint64_t* agents) {
  return c::tell(crowd, agents, "agents", [](const Crowd& asked) { return asked.agentCount(); });
}

skitter_result skitter_crowd_herd_agents(const skitter_crowd* crowd, uint32_t herd, uint32_t* agents) {
  return c::tell(crowd, agents, "agents", [&](const Crowd& asked) { return asked.agentCount(herd); });
}

skitter_result skitter_crowd_herd_places(const skitter_crowd* crowd, uint32_t herd, uint32_t* places) {
  return c::tell(crowd, places, "places", [&](const Crowd& asked) { return asked.places(herd); });
}

skitter_result skitter_crowd_herd_legs(const skitter_crowd* crowd, uint32_t herd, uint32_t* legs) {
  return c::tell(crowd, legs, "legs", [&](const Crowd& asked) { return bindings::legsOf(asked, herd); });
}

skitter_result skitter_crowd_herd_bones(const skitter_crowd* crowd, uint32_t herd, uint32_t* bones) {
  return c::tell(crowd, bones, "bones", [&](const Crowd& asked) { return bindings::bonesOf(asked, herd); });
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
  return c::tell(crowd, hash, "hash", [](const Crowd& asked) { return asked.stateHash(); });
}

skitter_result skitter_crowd_fidelity(const skitter_crowd* crowd, uint32_t herd, skitter_fidelity* fidelity) {
  return c::tell(crowd, fidelity, "fidelity", [&](const Crowd& asked) {
    return convert(herd == SKITTER_ALL_HERDS ? asked.fidelity() : asked.fidelity(herd));
  });
}

skitter_result skitter_crowd_footfalls(const skitter_crowd* crowd, uint32_t herd, skitter_footfall* footfalls,
                                       size_t room, size_t* count) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    c::Told<skitter_footfall> told(footfalls, room, "footfalls", count);
    told.write(asked.footfalls(herd), c::toC);
  });
}

skitter_result skitter_crowd_pick(const skitter_crowd* crowd, const double start[3],
                                  const double direction[3], double length, skitter_picked* picked,
                                  int* found) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    const glm::dvec3 from = c::vectorOf(start, "start"), along = c::vectorOf(direction, "direction");
    c::tellPicked(picked, found, [&] { return bindings::pick(asked, from, along, length); });
  });
}

skitter_result skitter_crowd_nearest(const skitter_crowd* crowd, const double point[3],
                                     skitter_picked* picked, int* found) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    const glm::dvec3 to = c::vectorOf(point, "point");
    c::tellPicked(picked, found, [&] { return bindings::nearest(asked, to); });
  });
}

skitter_result skitter_crowd_destroy(skitter_crowd* crowd) {
  return guarded([&] { delete crowd; });
}
