#include "crowd/spawn.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <thread>
#include <vector>

#include "base/split_mix.h"
#include "skitter/records.h"

namespace skitter::crowd {
namespace {

// One draw per agent and purpose, whatever the order.
float uniform(uint64_t seed, uint64_t agent, uint64_t purpose) {
  const uint64_t drawn = base::SplitMix64::draw(seed, agent * 4 + purpose + 1);
  return static_cast<float>(drawn >> 40) * 0x1p-24f;
}

// Purposes 0 and 1 are the place, 2 is the phase.
constexpr uint64_t kSizePurpose = 3;

// Below that many a thread costs more than it saves.
constexpr uint32_t kAgentsAThread = 4096;

// The frame that a clip shows at a time, and the fraction of the way to the next.
glm::vec2 frameAt(const ClipRecords& clips, int clip, float time) {
  const float* head = &clips.heads[static_cast<size_t>(clip) * 4];
  const auto first = static_cast<size_t>(head[0]), end = first + static_cast<size_t>(head[1]);
  size_t frame = first;
  while (frame + 1 < end && clips.times[(frame + 1) * 4] <= time) ++frame;
  return {static_cast<float>(frame), (time - clips.times[frame * 4]) * clips.times[frame * 4 + 1]};
}

}  // namespace

// Writes one vec4 after another, from a record's first one.
class Spawner::Writer {
 public:
  Writer(std::span<float> records, int stride) : records_(records.data()), stride_(4 * stride) {}
  void seek(int record) { at_ = records_ + std::ptrdiff_t{record} * stride_; }
  void push(float a, float b, float c, float d) {
    at_[0] = a, at_[1] = b, at_[2] = c, at_[3] = d;
    at_ += 4;
  }

 private:
  float* records_;
  std::ptrdiff_t stride_;  // floats a record
  float* at_ = records_;
};

SpawnPlaces::SpawnPlaces(const Scene& scene) {
  for (const skitter::Herd& herd : scene.herds) {
    Places& places = herds_.emplace_back(herd.agents);
    const size_t sizes = herd.sizes.size();
    if (sizes < 2) continue;
    places.ofSizes.resize(sizes);
    const uint64_t seed = seedOf(scene, herds_.size() - 1);
    for (uint32_t place = 0; place < herd.agents; ++place)
      places.ofSizes[static_cast<size_t>(uniform(seed, place, kSizePurpose) * static_cast<float>(sizes))]
          .push_back(place);
  }
}

std::span<const uint32_t> SpawnPlaces::of(uint32_t herd, size_t size) const {
  const Places& places = herds_[herd];
  return places.ofSizes.empty() ? std::span<const uint32_t>() : places.ofSizes[size];
}

uint32_t SpawnPlaces::count(uint32_t herd, size_t size) const {
  const Places& places = herds_[herd];
  return places.ofSizes.empty() ? places.agents : static_cast<uint32_t>(places.ofSizes[size].size());
}

Spawner::Spawner(const skitter::Herd& from, const Kind& kind, const Heightfield& terrain, uint64_t seed,
                 std::span<const uint32_t> places)
    : herd_(from),
      rig_(kind.rig),
      clips_(kind.clips),
      keyPoses_(kind.keyPoses),
      terrain_(terrain),
      tuning_(kind.parameters),
      seed_(seed),
      places_(places) {
  // A block about as deep as wide; closer together only where the terrain has no room.
  const float spacing = from.spawn.spacing;
  const float roomX = terrain.extentX() - 4 * tuning_.edgeMargin;
  const float roomZ = terrain.extentZ() - 4 * tuning_.edgeMargin;
  const auto agents = std::max(1u, from.agents);
  const auto side = static_cast<uint32_t>(std::ceil(std::sqrt(static_cast<double>(agents))));
  const auto widest = std::max(1u, static_cast<uint32_t>(roomX / spacing));
  lanes_ = std::min(side, std::max(widest, static_cast<uint32_t>(std::sqrt(agents * roomX / roomZ))));
  rows_ = (agents + lanes_ - 1) / lanes_;
  laneSpacing_ = std::min(spacing, roomX / static_cast<float>(std::max(1u, lanes_ - 1)));
  rowSpacing_ = std::min(1.2f * spacing, 0.9f * roomZ / static_cast<float>(std::max(1u, rows_ - 1)));
}

// The directions of a leg at rest, or as the standing pose has it.
void Spawner::pushDirections(size_t leg, Writer& chain) const {
  const int bones = rig_.maxBones();
  if (keyPoses_.keys == 0) {
    for (int i = 0; i < shared::chainStride(bones); ++i) chain.push(0, 0, 0, 0);
    return;
  }
  const auto stride = 4 * static_cast<size_t>(shared::keyStride(bones, keyPoses_.keys));
  const float* standing = &keyPoses_.records[leg * stride + 4];
  for (int i = 0; i < shared::chainStride(bones); ++i, standing += 4)
    chain.push(standing[0], standing[1], standing[2], standing[3]);
}

Spawner::Placement Spawner::place(uint32_t place) const {
  const uint32_t row = place / lanes_, lane = place % lanes_;
  const auto centred = [](uint32_t i, uint32_t n, float spacing) {
    return (static_cast<float>(i) - 0.5f * static_cast<float>(n - 1)) * spacing;
  };
  const Spawn& spawn = herd_.spawn;
  Placement p{};
  p.heading = spawn.heading;
  p.x = spawn.centre.x + centred(lane, lanes_, laneSpacing_);
  p.z = spawn.centre.y + centred(row, rows_, rowSpacing_);
  const float limitX = tuning_.halfExtentX - 1.5f * tuning_.edgeMargin;
  const float limitZ = tuning_.halfExtentZ - 1.5f * tuning_.edgeMargin;
  if (spawn.kind == Spawn::Kind::lanes) {
    // Nobody walks in step or in file: every agent is a little off its place.
    p.x += 0.4f * laneSpacing_ * (uniform(seed_, place, 0) - 0.5f);
    p.z = -limitZ + static_cast<float>(row) * rowSpacing_ + 0.5f * rowSpacing_ * uniform(seed_, place, 1);
    p.heading = 0;
  }
  p.x = std::clamp(p.x, -limitX, limitX);
  p.z = std::clamp(p.z, -limitZ, limitZ);
  if (herd_.goal.kind == Goal::Kind::point) {
    p.targetX = p.otherX = std::clamp(herd_.goal.target.x, -limitX, limitX);
    p.targetZ = p.otherZ = std::clamp(herd_.goal.target.y, -limitZ, limitZ);
  } else {
    p.targetX = p.x;
    p.targetZ = limitZ;
    p.otherX = std::min(p.x + 0.5f * laneSpacing_, limitX);
    p.otherZ = -limitZ;
  }
  return p;
}

void Spawner::write(uint32_t first, uint32_t count, uint32_t at, const SpawnRecords& records) const {
  if (count == 0) return;
  const uint32_t threads = std::clamp(std::thread::hardware_concurrency(), 1u, count / kAgentsAThread + 1);
  std::vector<std::jthread> runs;
  for (uint32_t i = 0; i < threads; ++i) {
    const auto from = static_cast<uint32_t>(uint64_t{count} * i / threads);
    const auto to = static_cast<uint32_t>(uint64_t{count} * (i + 1) / threads);
    const auto run = [=, this, &records] { writeRun(first + from, to - from, at + from, records); };
    if (i + 1 == threads)
      run();
    else
      runs.emplace_back(run);
  }
}

void Spawner::writeRun(uint32_t first, uint32_t count, uint32_t at, const SpawnRecords& records) const {
  using namespace shared;
  Writer goal(records.goal, GOAL_STRIDE), body(records.body, BODY_STRIDE), gait(records.gait, GAIT_STRIDE),
      step(records.step, STEP_STRIDE), foot(records.foot, FOOT_STRIDE),
      chain(records.chain, chainStride(rig_.maxBones())), tip(records.tip, TIP_STRIDE),
      play(records.play, PLAY_STRIDE);
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t record = at + i, spot = places_.empty() ? first + i : places_[first + i];
    for (Writer* each : {&goal, &body, &gait, &play}) each->seek(static_cast<int>(record));
    const Placement p = place(spot);
    const float phase = herd_.phase ? *herd_.phase - std::floor(*herd_.phase) : uniform(seed_, spot, 2);
    const float kind = herd_.goal.kind == Goal::Kind::cross   ? shared::GOAL_CROSS
                       : herd_.goal.kind == Goal::Kind::point ? shared::GOAL_POINT
                                                              : shared::GOAL_NONE;
    goal.push(p.targetX, p.targetZ, p.otherX, p.otherZ);
    goal.push(herd_.goal.speed, 0.5f * rig_.legLength, kind, 0);

    // Standing on the plane through the ground a leg length around.
    const float reach = rig_.legLength;
    const float left = terrain_.at(p.x - reach, p.z), right = terrain_.at(p.x + reach, p.z);
    const float back = terrain_.at(p.x, p.z - reach), ahead = terrain_.at(p.x, p.z + reach);
    const glm::vec3 normal =
        glm::normalize(glm::vec3((left - right) / (2 * reach), 1, (back - ahead) / (2 * reach)));
    const float height = (left + right + back + ahead) / 4;
    const glm::vec2 heading(std::sin(p.heading), std::cos(p.heading));
    const glm::vec3 forward = glm::normalize(
        glm::vec3(heading.x, -(normal.x * heading.x + normal.z * heading.y) / normal.y, heading.y));
    const glm::quat q = glm::quat_cast(glm::mat3(glm::cross(normal, forward), normal, forward));
    const float tileX = std::floor(p.x / shared::TILE_SIZE), tileZ = std::floor(p.z / shared::TILE_SIZE);
    const float localX = p.x - tileX * shared::TILE_SIZE, localZ = p.z - tileZ * shared::TILE_SIZE;
    body.push(localX, height, localZ, packedTile(tileX, tileZ));
    body.push(heading.x, heading.y, 0, 0);
    body.push(q.x, q.y, q.z, q.w);
    body.push(0, 0, 1, 0);
    gait.push(phase, 0, 0, 1);
    gait.push(0, 1, 0, 0);
    if (clips_.clips > 0) {
      const auto clip = static_cast<float>(clips_.standing);
      const float seconds = clips_.heads[static_cast<size_t>(clips_.standing) * 4 + 2];
      const float time = seconds * phase;
      play.push(clip, time, clip, time);
      play.push(1, 0, 0, 0);
      const glm::vec2 frame = frameAt(clips_, clips_.standing, time);
      play.push(frame.x, frame.y, frame.x, frame.y);
    }

    for (size_t l = 0; l < rig_.legs.size(); ++l) {
      for (Writer* each : {&step, &foot, &chain, &tip})
        each->seek(legRecord(static_cast<int>(record), static_cast<int>(l), rig_.legCount()));
      const Leg& leg = rig_.legs[l];
      const glm::vec3 home = q * leg.home;
      const glm::vec3 landing(localX + home.x, terrain_.at(p.x + home.x, p.z + home.z), localZ + home.z);
      if (clips_.clips > 0) {
        step.push(landing.x, landing.y, landing.z, packedTile(tileX, tileZ));
        step.push(0, 0, 0, 0);
      } else {
        step.push(landing.x, landing.y, landing.z, -1000);
        step.push(landing.x, landing.y, landing.z, packedTicks(1, stepTile(tileX, tileZ)));
      }
      if (!records.foot.empty()) foot.push(home.x, landing.y - height, home.z, 1);
      pushDirections(l, chain);
      if (!records.tip.empty()) tip.push(home.x, landing.y - height, home.z, 0);
    }
  }
}

}  // namespace skitter::crowd
