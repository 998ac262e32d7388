#include "crowd/spawn.h"

#include <algorithm>
#include <cassert>
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

float kindOf(const Goal& goal) {
  switch (goal.kind) {
    case Goal::Kind::cross:
      return shared::GOAL_CROSS;
    case Goal::Kind::point:
      return shared::GOAL_POINT;
    case Goal::Kind::velocity:
      return shared::GOAL_VELOCITY;
    case Goal::Kind::route:
    case Goal::Kind::roam:
    case Goal::Kind::follow:
    case Goal::Kind::flee:
      return shared::GOAL_SERIES;
    case Goal::Kind::none:
      break;
  }
  return shared::GOAL_NONE;
}

}  // namespace

std::vector<float> sizesOf(const skitter::Herd& herd) {
  std::vector<float> sizes;
  for (const float size : herd.sizes)
    if (std::ranges::find(sizes, size) == sizes.end()) sizes.push_back(size);
  if (sizes.empty()) sizes.push_back(1);
  return sizes;
}

Numbering numberingOf(const skitter::Herd& herd, uint64_t seed) {
  const uint32_t places = herd.agents + herd.reserve;
  const std::vector<float> sizes = sizesOf(herd);
  if (sizes.size() == 1) return {.counts = {places}};
  std::vector<std::vector<uint32_t>> placesOf(sizes.size());
  for (uint32_t place = 0; place < places; ++place) {
    const float drawn = uniform(seed, place, kSizePurpose) * static_cast<float>(herd.sizes.size());
    const auto size = std::ranges::find(sizes, herd.sizes[static_cast<size_t>(drawn)]);
    placesOf[static_cast<size_t>(size - sizes.begin())].push_back(place);
  }
  Numbering made;
  made.starts.reserve(places);
  for (const std::vector<uint32_t>& each : placesOf) {
    made.counts.push_back(static_cast<uint32_t>(each.size()));
    made.starts.insert(made.starts.end(), each.begin(), each.end());
  }
  return made;
}

Spawner spawnerOf(const Crowd::Impl& crowd, const Herd& herd, const SizeRun& run) {
  std::span<const uint32_t> starts = herd.starts;
  if (!starts.empty()) starts = starts.subspan(run.firstOfHerd, run.agents);
  return {herd.from, crowd.kinds[run.kind], crowd.terrain, herd.seed, starts};
}

BodyRecord absentBody() {
  return {0, shared::ABSENT_HEIGHT, 0, shared::packedTile(0, 0), 0, 1, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0};
}

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

Spawner::Spawner(const skitter::Herd& from, const Kind& kind, const Heightfield& terrain, uint64_t seed,
                 std::span<const uint32_t> starts)
    : herd_(from),
      rig_(kind.rig),
      clips_(kind.clips),
      keyPoses_(kind.keyPoses),
      whole_(kind.wholeRecord),
      terrain_(terrain),
      tuning_(kind.parameters),
      series_(kind.series),
      seed_(seed),
      starts_(starts) {
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
  limitX_ = tuning_.halfExtentX - 1.5f * tuning_.edgeMargin;
  limitZ_ = tuning_.halfExtentZ - 1.5f * tuning_.edgeMargin;
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

Place Spawner::startOf(uint32_t agent) const {
  const uint32_t spot = spotOf(agent), row = spot / lanes_, lane = spot % lanes_;
  const auto centred = [](uint32_t i, uint32_t n, float spacing) {
    return (static_cast<float>(i) - 0.5f * static_cast<float>(n - 1)) * spacing;
  };
  const Spawn& spawn = herd_.spawn;
  float x = spawn.centre.x + centred(lane, lanes_, laneSpacing_);
  float z = spawn.centre.y + centred(row, rows_, rowSpacing_);
  if (spawn.kind == Spawn::Kind::lanes) {
    // Nobody walks in step or in file: every agent is a little off its place.
    x += 0.4f * laneSpacing_ * (uniform(seed_, spot, 0) - 0.5f);
    z = -limitZ_ + static_cast<float>(row) * rowSpacing_ + 0.5f * rowSpacing_ * uniform(seed_, spot, 1);
  }
  return {{std::clamp(x, -limitX_, limitX_), std::clamp(z, -limitZ_, limitZ_)},
          spawn.kind == Spawn::Kind::lanes ? 0 : spawn.heading};
}

glm::vec4 Spawner::endsOf(const Goal& goal, float lane) const {
  if (goal.kind == Goal::Kind::velocity) return {goal.velocity, 0, 0};
  if (goal.kind == Goal::Kind::point) {
    const glm::vec2 target = within(goal.target);
    return {target, target};
  }
  if (isSeries(goal))
    if (const Series* series = findSeries(series_, goal)) return {series->places[0], series->places[0]};
  return {lane, limitZ_, std::min(lane + 0.5f * laneSpacing_, limitX_), -limitZ_};
}

glm::vec2 Spawner::within(const glm::vec2& place) const {
  return {std::clamp(place.x, -limitX_, limitX_), std::clamp(place.y, -limitZ_, limitZ_)};
}

Spawner::Placement Spawner::place(uint32_t agent) const {
  const Place start = startOf(agent);
  const glm::vec4 ends = endsOf(herd_.goal, start.position.x);
  return {start.position.x, start.position.y, start.heading, ends.x, ends.y, ends.z, ends.w};
}

GoalRecord Spawner::goalRecord(uint32_t agent, const Goal& goal) const {
  const bool hasLane = goal.kind == Goal::Kind::cross || goal.kind == Goal::Kind::none;
  return goalRecord(agent, hasLane ? startOf(agent).position.x : 0.0f, goal);
}

GoalRecord Spawner::goalRecord(uint32_t agent, float x, const Goal& goal) const {
  glm::vec4 ends = endsOf(goal, x);
  if (isSeries(goal)) {
    const Series* series = findSeries(series_, goal);
    assert(series != nullptr);
    const auto draw = static_cast<uint32_t>(base::SplitMix64::draw(~seed_, spotOf(agent) + 1) >> 40);
    const uint32_t number = firstPlaceOf(*series, draw);
    ends = {series->places[number - series->first], number, draw};
  }
  const float speed = goal.kind == Goal::Kind::velocity ? Goal::maxSpeed : goal.speed;
  return {ends.x, ends.y, ends.z, ends.w, speed, 0.5f * rig_.legLength, kindOf(goal), 0};
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
  for (uint32_t i = 0; i < count; ++i) {
    const GoalRecord goal = goalRecord(first + i, herd_.goal);
    std::ranges::copy(goal, records.goal.begin() + static_cast<ptrdiff_t>(goal.size()) * (at + i));
    stand(first + i, startOf(first + i), at + i, records);
    if (spotOf(first + i) < herd_.agents) continue;
    const BodyRecord absent = absentBody();
    std::ranges::copy(absent, records.body.begin() + static_cast<ptrdiff_t>(absent.size()) * (at + i));
    if (!records.avoid.empty()) records.avoid[4 * shared::AVOID_STRIDE * (at + i) + 2] = 1;
  }
}

void Spawner::stand(uint32_t agent, const Place& place, uint32_t at, const SpawnRecords& records) const {
  using namespace shared;
  const auto record = static_cast<int>(at);
  Writer body(records.body, BODY_STRIDE), gait(records.gait, GAIT_STRIDE), step(records.step, STEP_STRIDE),
      foot(records.foot, FOOT_STRIDE), chain(records.chain, chainStride(rig_.maxBones())),
      tip(records.tip, TIP_STRIDE), play(records.play, PLAY_STRIDE);
  for (Writer* each : {&body, &gait, &play}) each->seek(record);
  // It stands, awake, until it looks around.
  if (!records.avoid.empty())
    std::ranges::fill(records.avoid.subspan(4 * AVOID_STRIDE * at, 4 * AVOID_STRIDE), 0.0f);
  if (!records.hurt.empty())
    std::ranges::copy(whole_, records.hurt.begin() + static_cast<ptrdiff_t>(whole_.size()) * record);
  const float phase =
      herd_.phase ? *herd_.phase - std::floor(*herd_.phase) : uniform(seed_, spotOf(agent), 2);

  // Standing on the plane through the ground a leg length around, as far as it can tilt.
  const glm::vec2 p = place.position;
  const float reach = rig_.legLength;
  const float left = terrain_.at(p.x - reach, p.y), right = terrain_.at(p.x + reach, p.y);
  const float back = terrain_.at(p.x, p.y - reach), ahead = terrain_.at(p.x, p.y + reach);
  glm::vec2 downhill(left - right, back - ahead);
  downhill /= std::max(2 * reach, glm::length(downhill) / tuning_.maxSlope);
  const glm::vec3 normal = glm::normalize(glm::vec3(downhill.x, 1, downhill.y));
  // On broken ground the mean of heights may be far from the ground in their middle.
  const float below = terrain_.at(p.x, p.y);
  const float height =
      std::clamp((left + right + back + ahead) / 4, below - tuning_.sinkMost, below + tuning_.riseMost);
  const glm::vec2 heading(std::sin(place.heading), std::cos(place.heading));
  const glm::vec3 forward = glm::normalize(
      glm::vec3(heading.x, -(normal.x * heading.x + normal.z * heading.y) / normal.y, heading.y));
  const glm::quat q = glm::quat_cast(glm::mat3(glm::cross(normal, forward), normal, forward));
  const float tileX = std::floor(p.x / TILE_SIZE), tileZ = std::floor(p.y / TILE_SIZE);
  const float localX = p.x - tileX * TILE_SIZE, localZ = p.y - tileZ * TILE_SIZE;
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
      each->seek(legRecord(record, static_cast<int>(l), rig_.legCount()));
    const Leg& leg = rig_.legs[l];
    const glm::vec3 home = q * leg.home;
    const glm::vec3 landing(localX + home.x, terrain_.at(p.x + home.x, p.y + home.z), localZ + home.z);
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

}  // namespace skitter::crowd
