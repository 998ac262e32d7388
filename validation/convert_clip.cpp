#include "validation/convert_clip.h"

#include "skitter/records.h"
#include "validation/vec4s.h"

namespace skitter::validation {
namespace {

reference::Affine affine(const std::vector<float>& records, size_t base) {
  const glm::dvec4 x = load(records, base), y = load(records, base + 1), z = load(records, base + 2);
  reference::Affine matrix;
  for (int c = 0; c < 4; ++c) matrix[c] = {x[c], y[c], z[c]};
  return matrix;
}

// A whole number below `count`; nonsense reads as 0.
size_t whole(double value, size_t count = size_t{1} << 31) {
  return value >= 0 && value < static_cast<double>(count) ? static_cast<size_t>(value) : 0;
}

}  // namespace

reference::ClipTable clipTableOf(const crowd::ClipRecords& records, int legs, int bones) {
  reference::ClipTable table;
  for (size_t c = 0; c < static_cast<size_t>(records.clips); ++c) {
    const glm::dvec4 head = load(records.heads, c);
    table.clips.push_back({whole(head.x), whole(head.y), head.z, head.w});
  }
  for (size_t f = 0; f < records.times.size() / 4; ++f) {
    const glm::dvec4 frame = load(records.times, f);
    table.frames.push_back({frame.x, static_cast<uint32_t>(frame.z)});
  }
  for (size_t m = 0; m < records.rows.size() / (4 * shared::MATRIX_STRIDE); ++m) {
    table.matrices.push_back(affine(records.rows, at(m, shared::MATRIX_STRIDE)));
  }
  for (int l = 0; l < legs; ++l) {
    auto& leg = table.legs.emplace_back();
    for (int i = 0; i <= bones; ++i) {
      const glm::dvec4 joint = load(records.legs, static_cast<size_t>(l * (bones + 1) + i));
      leg.push_back({glm::dvec3(joint), whole(joint.w)});
    }
  }
  for (size_t j = 0; j < static_cast<size_t>(records.joints); ++j) {
    const int bone = static_cast<int>(load(records.bones, j).x);
    table.bones.push_back({bone < 0 ? -1 : bone / bones, bone < 0 ? 0 : bone % bones});
  }
  return table;
}

reference::Play playOf(const HerdState& state, size_t agent, const reference::ClipTable& table) {
  const size_t base = at(agent, shared::PLAY_STRIDE);
  const glm::dvec4 times = load(state.play, base), how = load(state.play, base + 1);
  const glm::dvec4 frames = load(state.play, base + 2);
  const auto played = [&](double clip, double time, double rate, double frame, double fraction) {
    return reference::Play::Played{static_cast<int>(whole(clip, table.clips.size())), time, rate,
                                   whole(frame, table.frames.size()), fraction};
  };
  return {played(times.x, times.y, how.y, frames.x, frames.y),
          played(times.z, times.w, how.z, frames.z, frames.w), how.x};
}

reference::Plant plantOf(const HerdState& state, size_t leg) {
  const size_t base = at(leg, shared::STEP_STRIDE);
  const glm::dvec4 lock = load(state.step, base), offset = load(state.step, base + 1);
  const auto tile = static_cast<float>(lock.w);
  return {shared::tileX(tile), shared::tileZ(tile), glm::dvec3(lock), glm::dvec3(offset), offset.w == 1};
}

reference::PlantedStart startOf(const HerdState& state, size_t leg, int bones) {
  const size_t base = at(leg, shared::startStride(bones));
  reference::PlantedStart start;
  for (int b = 0; b < bones; ++b) {
    const glm::dvec4 pair = load(state.start, base + static_cast<size_t>(b) / 2);
    start.directions.push_back(b % 2 == 0 ? glm::dvec2(pair.x, pair.y) : glm::dvec2(pair.z, pair.w));
  }
  start.root = load(state.start, base + static_cast<size_t>(shared::chainStride(bones)));
  return start;
}

FixRecord fixOf(const HerdState& state, size_t leg, int bones, int bone) {
  const size_t base = at(leg * static_cast<size_t>(bones) + static_cast<size_t>(bone), shared::FIX_STRIDE);
  const glm::dvec4 q = load(state.fix, base);
  return {glm::dquat(q.w, q.x, q.y, q.z), load(state.fix, base + 1)};
}

reference::Affine matrixOf(const HerdState& state, size_t entry) {
  return affine(state.pose, at(entry, shared::MATRIX_STRIDE));
}

void putPlay(HerdState& state, size_t agent, const reference::Play& play) {
  const size_t base = at(agent, shared::PLAY_STRIDE);
  const reference::Play::Played &to = play.to, &from = play.from;
  store(state.play, base, {to.clip, to.time, from.clip, from.time});
  store(state.play, base + 1, {play.weight, to.rate, from.rate, 0});
  store(state.play, base + 2, {to.frame, to.fraction, from.frame, from.fraction});
}

void putPlant(HerdState& state, size_t leg, const reference::Plant& plant) {
  const size_t base = at(leg, shared::STEP_STRIDE);
  store(state.step, base, {plant.lock, shared::TILES * plant.tileX + plant.tileZ});
  store(state.step, base + 1, {plant.offset, plant.locked ? 1 : 0});
}

void putStart(HerdState& state, size_t leg, int bones, const reference::PlantedStart& start) {
  const size_t base = at(leg, shared::startStride(bones));
  storePairs(state.start, base, start.directions);
  store(state.start, base + static_cast<size_t>(shared::chainStride(bones)), {start.root, 0});
}

void putFix(HerdState& state, size_t leg, int bones, int bone, const reference::BoneFix& fix) {
  const size_t base = at(leg * static_cast<size_t>(bones) + static_cast<size_t>(bone), shared::FIX_STRIDE);
  const glm::dquat turn = glm::quat_cast(fix.turn);
  store(state.fix, base, {turn.x, turn.y, turn.z, turn.w});
  store(state.fix, base + 1, {fix.move, 0});
}

void putMatrix(HerdState& state, size_t entry, const reference::Affine& matrix) {
  const size_t base = at(entry, shared::MATRIX_STRIDE);
  for (int row = 0; row < 3; ++row)
    store(state.pose, base + static_cast<size_t>(row),
          {matrix[0][row], matrix[1][row], matrix[2][row], matrix[3][row]});
}

}  // namespace skitter::validation
