#include <algorithm>

#include "bindings/c/handles.h"
#include "bindings/common/names.h"

using namespace skitter;
using c::given;
using c::guarded;
using c::listOf;

namespace {

static_assert(SKITTER_SPLINE_IDLE == static_cast<int>(SplineState::idle) &&
              SKITTER_SPLINE_MOVING == static_cast<int>(SplineState::moving) &&
              SKITTER_SPLINE_FINISHED == static_cast<int>(SplineState::finished) &&
              SKITTER_SPLINE_REFUSED == static_cast<int>(SplineState::refused));

SplineBatch::Options optionsOf(const skitter_spline_options& asked) {
  SplineBatch::Options options;
  options.points = asked.points;
  options.closed = asked.closed != 0;
  if (asked.rule != nullptr)
    options.tangents.rule = bindings::namedOf(allSplineRules, "options->rule", asked.rule);
  options.tangents.tension = asked.tension;
  options.tangents.continuity = asked.continuity;
  options.tangents.bias = asked.bias;
  options.constantSpeed = asked.constant_speed != 0;
  return options;
}

SplineBatch& batchOf(skitter_spline_batch* batch) { return given(batch, "batch").batch; }
const SplineBatch& batchOf(const skitter_spline_batch* batch) { return given(batch, "batch").batch; }

}  // namespace

skitter_result skitter_spline_batch_create(skitter_device* device, uint32_t splines,
                                           const skitter_spline_options* options,
                                           skitter_spline_batch** batch) {
  return guarded([&] {
    const std::shared_ptr<Device>& on = given(device, "device").device;
    const SplineBatch::Options made = optionsOf(given(options, "options"));
    given(batch, "batch");
    *batch = new skitter_spline_batch{on, SplineBatch(*on, splines, made)};
  });
}

skitter_result skitter_spline_batch_set_points(skitter_spline_batch* batch, const float* xyz, size_t points,
                                               const float* knots, size_t knot_count) {
  return guarded([&] {
    SplineBatch& made = batchOf(batch);
    made.setPoints(c::vectorsOf(xyz, points, "xyz"), listOf(knots, knot_count, "knots"));
  });
}

skitter_result skitter_spline_batch_set_tangents(skitter_spline_batch* batch, const float* arriving,
                                                 const float* leaving, size_t points) {
  return guarded([&] {
    SplineBatch& made = batchOf(batch);
    made.setTangents(c::vectorsOf(arriving, points, "arriving"),
                     c::vectorsOf(leaving, leaving != nullptr ? points : 0, "leaving"));
  });
}

skitter_result skitter_spline_batch_set_clocks(skitter_spline_batch* batch,
                                               const skitter_spline_clock* clocks, size_t splines) {
  return guarded([&] {
    SplineBatch& made = batchOf(batch);
    std::vector<SplineClock> all;
    for (const skitter_spline_clock& clock : listOf(clocks, splines, "clocks"))
      all.push_back({.start = clock.start, .duration = clock.duration, .active = clock.active != 0});
    made.setClocks(all);
  });
}

skitter_result skitter_spline_batch_travel(skitter_spline_batch* batch, double now) {
  return guarded([&] { batchOf(batch).travel(now); });
}

skitter_result skitter_spline_batch_record(skitter_spline_batch* batch, VkCommandBuffer commands,
                                           double now) {
  return guarded([&] {
    SplineBatch& made = batchOf(batch);
    given(commands, "commands");
    made.record(commands, now);
  });
}

skitter_result skitter_spline_batch_motions(const skitter_spline_batch* batch, skitter_spline_motion* motions,
                                            size_t room) {
  return guarded([&] {
    const SplineBatch& made = batchOf(batch);
    given(motions, "motions");
    c::checkRoom("motions", room, made.splines());
    for (const auto& [position, velocity, travelled, state] : made.downloadMotions())
      *motions++ = {{position.x, position.y, position.z},
                    {velocity.x, velocity.y, velocity.z},
                    travelled,
                    static_cast<skitter_spline_state>(state)};
  });
}

skitter_result skitter_spline_batch_lengths(const skitter_spline_batch* batch, float* lengths, size_t room) {
  return guarded([&] {
    const SplineBatch& made = batchOf(batch);
    given(lengths, "lengths");
    c::checkRoom("lengths", room, made.splines());
    std::ranges::copy(made.downloadLengths(), lengths);
  });
}

skitter_result skitter_spline_batch_destroy(skitter_spline_batch* batch) {
  return guarded([&] { delete batch; });
}
