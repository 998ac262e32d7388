#include "skitter/decode.h"

#include "bindings/c/handles.h"

using namespace skitter;
using c::given;
using c::guarded;

namespace {

// The sizes of the header's arrays.
static_assert(4 * shared::BODY_STRIDE == 16 && 4 * shared::STEP_STRIDE == 8 && 4 * shared::FOOT_STRIDE == 4 &&
              4 * shared::TIP_STRIDE == 4 && 4 * shared::FOOTFALL_STRIDE == 8);

// A record of `vectors` vec4.
std::span<const float> recordFrom(const float* record, int vectors, const char* name) {
  return {&given(record, name), 4 * static_cast<size_t>(vectors)};
}

BodyState bodyFrom(const skitter_body* body) {
  const double* place = given(body, "body").position;
  return {.position = {place[0], place[1], place[2]}};
}

// Throws Error(input) where the entries of a pose, of `vectors` vec4 each, end before that one.
std::span<const float> poseFrom(const float* pose, size_t floats, int vectors, uint32_t entry,
                                const char* name) {
  const size_t needed = (size_t{entry} + 1) * 4 * static_cast<size_t>(vectors);
  if (floats < needed)
    throw inputError(
        fmt::format("pose has {} floats, expected at least {} for {} {}", floats, needed, name, entry));
  return c::listOf(pose, floats, "pose");
}

void writeQuaternion(const glm::quat& q, float (&xyzw)[4]) {
  c::copyVector(glm::vec4(q.x, q.y, q.z, q.w), xyzw);
}

}  // namespace

skitter_result skitter_decode_body(const float record[16], const double* origin, skitter_body* body) {
  return guarded([&] {
    const BodyState state = bodyOf(recordFrom(record, shared::BODY_STRIDE, "record"), c::originOf(origin));
    skitter_body& to = given(body, "body");
    c::copyVector(state.position, to.position);
    writeQuaternion(state.rotation, to.rotation);
    c::copyVector(state.heading, to.heading);
    c::copyVector(state.velocity, to.velocity);
    to.turn_rate = state.turnRate;
    to.present = state.present ? 1 : 0;
  });
}

skitter_result skitter_decode_step(const float record[8], const float body[16], const double* origin,
                                   skitter_step* step) {
  return guarded([&] {
    const StepState state = stepOf(recordFrom(record, shared::STEP_STRIDE, "record"),
                                   recordFrom(body, shared::BODY_STRIDE, "body"), c::originOf(origin));
    skitter_step& to = given(step, "step");
    c::copyVector(state.liftOff, to.lift_off);
    c::copyVector(state.landing, to.landing);
    to.first_tick = state.firstTick;
    to.ticks = state.ticks;
    to.last_resort = state.lastResort ? 1 : 0;
  });
}

skitter_result skitter_decode_foot(const float record[4], const skitter_body* body, skitter_foot* foot) {
  return guarded([&] {
    const FootState state = footOf(recordFrom(record, shared::FOOT_STRIDE, "record"), bodyFrom(body));
    skitter_foot& to = given(foot, "foot");
    c::copyVector(state.place, to.place);
    to.progress = state.progress;
  });
}

skitter_result skitter_decode_tip(const float record[4], const skitter_body* body, skitter_tip* tip) {
  return guarded([&] {
    const TipState state = tipOf(recordFrom(record, shared::TIP_STRIDE, "record"), bodyFrom(body));
    skitter_tip& to = given(tip, "tip");
    c::copyVector(state.place, to.place);
    to.error = state.error;
  });
}

skitter_result skitter_decode_bone(const float* pose, size_t floats, uint32_t entry, skitter_bone* bone) {
  return guarded([&] {
    const BonePose state = bonePoseOf(poseFrom(pose, floats, shared::POSE_STRIDE, entry, "entry"), entry);
    skitter_bone& to = given(bone, "bone");
    writeQuaternion(state.rotation, to.rotation);
    c::copyVector(state.position, to.position);
  });
}

skitter_result skitter_decode_joint(const float* pose, size_t floats, uint32_t joint, float rows[12]) {
  return guarded([&] {
    const glm::mat3x4 state =
        jointRowsOf(poseFrom(pose, floats, shared::MATRIX_STRIDE, joint, "joint"), joint);
    given(rows, "rows");
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) rows[4 * row + column] = state[row][column];
  });
}

skitter_result skitter_decode_footfall(const float event[8], const skitter_footfall_buffer* buffer,
                                       skitter_footfall* footfall, int* of_herd) {
  return guarded([&] {
    const std::span<const float> from = recordFrom(event, shared::FOOTFALL_STRIDE, "event");
    const skitter_footfall_buffer& in = given(buffer, "buffer");
    given(footfall, "footfall");
    given(of_herd, "of_herd");
    Footfall state = footfallOf(from, in.first_agent, 0);
    *of_herd = state.agent < in.agents ? 1 : 0;
    if (*of_herd == 0) return;
    state.agent += in.first_of_herd;
    *footfall = c::toC(state);
  });
}
