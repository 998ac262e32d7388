#include "app/run/trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/run/placed_bone.h"
#include "crowd/herd.h"
#include "crowd/load.h"
#include "crowd/radius.h"
#include "skitter/error.h"
#include "skitter/records.h"

namespace skitter::app {
namespace {

namespace fs = std::filesystem;
using namespace skitter::shared;

constexpr const char* perHerd[] = {"joints.npy", "rotations.npy", "stance.npy", "body.npy"};

struct EntrySizes {  // values an agent and tick
  uint64_t joints, rotations, stance, body;

  explicit EntrySizes(const Rig& rig) {
    const auto legs = static_cast<uint64_t>(rig.legCount()), bones = static_cast<uint64_t>(rig.maxBones());
    joints = legs * (bones + 1) * 3;
    rotations = legs * bones * 4;
    stance = legs;
    body = 7;
  }
  uint64_t bytes() const { return 4 * (joints + rotations + body) + stance; }
};

// The record at vec4 index `at`.
const float* vec4(const std::vector<float>& records, size_t at) { return records.data() + 4 * at; }

// What the files hold of one agent and tick, appended.
struct Values {
  std::vector<float> joints, rotations, body;
  std::vector<uint8_t> stance;
};

void appendAgent(const HerdState& state, const crowd::Kind& kind, size_t agent, Values& values) {
  const Rig& rig = kind.rig;
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const auto legs = static_cast<size_t>(rig.legCount()), bones = static_cast<size_t>(rig.maxBones());

  const float* body = vec4(state.body, agent * BODY_STRIDE);
  if (body[7] != 0) {  // nobody is there
    values.body.insert(values.body.end(), 7, nan);
    values.joints.insert(values.joints.end(), 3 * legs * (bones + 1), nan);
    values.rotations.insert(values.rotations.end(), 4 * legs * bones, nan);
    values.stance.insert(values.stance.end(), legs, 0);
    return;
  }
  const double position[3] = {double{tileX(body[3])} * TILE_SIZE + body[0], body[1],
                              double{tileZ(body[3])} * TILE_SIZE + body[2]};
  for (double coordinate : position) values.body.push_back(static_cast<float>(coordinate));
  values.body.insert(values.body.end(), body + 8, body + 12);

  const auto pushJoint = [&](const float* relative) {
    for (size_t k = 0; k < 3; ++k)
      values.joints.push_back(static_cast<float>(position[k] + double{relative[k]}));
  };
  for (size_t l = 0; l < legs; ++l) {
    const size_t leg = agent * legs + l, own = rig.legs[l].bones.size();
    for (size_t b = 0; b < own; ++b) {
      const PlacedBone placed = placedBone(state, kind, agent, l, b);
      values.rotations.insert(values.rotations.end(), placed.rotation, placed.rotation + 4);
      pushJoint(placed.start);
    }
    pushJoint(vec4(state.tip, leg * TIP_STRIDE));
    values.rotations.insert(values.rotations.end(), 4 * (bones - own), nan);
    values.joints.insert(values.joints.end(), 3 * (bones - own), nan);
    values.stance.push_back(vec4(state.foot, leg * FOOT_STRIDE)[3] >= 1 ? 1 : 0);
  }
}

nlohmann::ordered_json describe(const Rig& rig, uint32_t agents) {
  nlohmann::ordered_json legNames = nlohmann::ordered_json::array(), groups = legNames,
                         boneLengths = legNames, restDirections = legNames, limits = legNames;
  for (const Leg& leg : rig.legs) {
    legNames.push_back(leg.name);
    groups.push_back(leg.group);
    nlohmann::ordered_json lengths = nlohmann::ordered_json::array(), directions = lengths, angles = lengths;
    for (const Bone& bone : leg.bones) {
      lengths.push_back(bone.length);
      directions.push_back({bone.direction.x, bone.direction.y, bone.direction.z});
      angles.push_back(bone.coneHalfAngle);
    }
    boneLengths.push_back(lengths);
    restDirections.push_back(directions);
    limits.push_back(angles);
  }
  return {{"rig", rig.name},
          {"agents", agents},
          {"legLength", rig.legLength},
          {"footprintRadius", crowd::footprintRadius(rig)},
          {"legNames", legNames},
          {"groupNames", rig.groups},
          {"groups", groups},
          {"boneLengths", boneLengths},
          {"restDirections", restDirections},
          {"limits", limits}};
}

// Which agents of a herd of several sizes are how large. The herd is described at the first size.
void addSizes(const Crowd::Impl& crowd, uint32_t herd, nlohmann::ordered_json& described) {
  const std::vector<crowd::SizeRun>& runs = crowd.herdAt(herd).runs;
  if (runs.size() == 1) return;
  for (const crowd::SizeRun& run : runs)
    described["sizes"].push_back({{"firstAgent", run.firstOfHerd},
                                  {"agents", run.agents},
                                  {"size", crowd.kinds[run.kind].size},
                                  {"legLength", crowd.kinds[run.kind].rig.legLength},
                                  {"footprintRadius", crowd::footprintRadius(crowd.kinds[run.kind].rig)}});
}

nlohmann::ordered_json legState(const Rig& rig, uint64_t tick, uint32_t agent, uint32_t leg, LegState state,
                                uint32_t bone) {
  nlohmann::ordered_json entry = {
      {"tick", tick}, {"agent", agent}, {"leg", rig.legs[leg].name}, {"state", nameOf(state)}};
  if (state == LegState::lost) entry["bone"] = bone;
  return entry;
}

nlohmann::ordered_json loadState(uint64_t tick, uint32_t agent, const Load& load) {
  return {{"tick", tick},
          {"agent", agent},
          {"mass", load.mass},
          {"offset", {load.offset.x, load.offset.y, load.offset.z}}};
}

// Without legs where the herd is gone.
const Rig& tracedRig(const Crowd& crowd, uint32_t herd) {
  static const Rig none;
  return implOf(crowd).herds[herd].isGone() ? none : crowd.rig(herd);
}

}  // namespace

Trace::Trace(const fs::path& folder, const Crowd& crowd, double dt)
    : folder_(folder), dt_(dt), firstTick_(crowd.tick() + 1) {
  for (uint32_t h = 0; h < crowd.herdCount(); ++h) {
    const auto file = [&](const char* name) { return folder_.add(fmt::format("herd{}/{}", h, name)); };
    const Rig& rig = tracedRig(crowd, h);
    const uint32_t agents = crowd.places(h);
    const uint64_t legs = static_cast<uint64_t>(rig.legCount()),
                   bones = static_cast<uint64_t>(rig.maxBones());
    herds_.push_back({agents, NpyWriter(file("joints.npy"), "<f4", {agents, legs, bones + 1, 3}),
                      NpyWriter(file("rotations.npy"), "<f4", {agents, legs, bones, 4}),
                      NpyWriter(file("stance.npy"), "|u1", {agents, legs}),
                      NpyWriter(file("body.npy"), "<f4", {agents, 7})});
  }
}

double Trace::bytes(const Crowd& crowd, const Heightfield& terrain, uint64_t ticks) {
  uint64_t aTick = 0;
  for (uint32_t h = 0; h < crowd.herdCount(); ++h)
    aTick += crowd.places(h) * EntrySizes(tracedRig(crowd, h)).bytes();
  return static_cast<double>(aTick) * static_cast<double>(ticks) +
         static_cast<double>(terrain.heights.size() * sizeof(float));
}

bool Trace::claims(const fs::path& name) {
  if (name == "trace.json" || name == "heights.npy") return true;
  const std::string herd = name.begin()->string(), file = name.filename().string();
  if (!herd.starts_with("herd") || herd.find_first_not_of("0123456789", 4) != std::string::npos) return false;
  return name == herd || std::find(std::begin(perHerd), std::end(perHerd), file) != std::end(perHerd);
}

void Trace::append(const Crowd& crowd) {
  for (uint32_t h = 0; h < crowd.herdCount(); ++h) {
    const HerdState state = crowd.download(h);
    Values values;
    for (uint32_t agent = 0; agent < state.agents; ++agent)
      appendAgent(state, implOf(crowd).kindOf(h, agent), agent, values);
    herds_[h].joints.append(std::span<const float>(values.joints));
    herds_[h].rotations.append(std::span<const float>(values.rotations));
    herds_[h].stance.append(std::span<const uint8_t>(values.stance));
    herds_[h].body.append(std::span<const float>(values.body));
    if (state.hurt.empty()) continue;
    noteLegs(state, static_cast<uint32_t>(tracedRig(crowd, h).legCount()), herds_[h]);
    noteLoads(state, herds_[h]);
  }
  ++entries_;
}

void Trace::noteLegs(const HerdState& state, uint32_t legs, HerdFiles& herd) const {
  const auto floats = 4 * static_cast<size_t>(hurtStride(static_cast<int>(legs)));
  herd.damages.resize(state.agents);
  for (uint32_t agent = 0; agent < state.agents; ++agent) {
    const crowd::Damage now =
        crowd::Damage::ofValues(std::span(state.hurt).subspan(agent * floats, crowd::Damage::floats));
    crowd::Damage& before = herd.damages[agent];
    for (uint32_t leg = 0; leg < legs; ++leg)
      if (now.of(leg) != before.of(leg) || now.bones[leg] != before.bones[leg])
        herd.legs.push_back({firstTick_ + entries_, agent, leg, now.bones[leg], now.of(leg)});
    before = now;
  }
}

void Trace::noteLoads(const HerdState& state, HerdFiles& herd) const {
  constexpr size_t floats = std::tuple_size_v<crowd::CarriedRecord>;
  herd.carried.resize(state.agents);
  for (uint32_t agent = 0; agent < state.agents; ++agent) {
    const Load now = crowd::loadOf(std::span(state.carried).subspan(agent * floats, floats));
    if (now != herd.carried[agent]) herd.loads.push_back({firstTick_ + entries_, agent, now});
    herd.carried[agent] = now;
  }
}

size_t Trace::finish(const Crowd& crowd, const Heightfield& terrain, const Manifest& manifest) {
  NpyWriter heights(folder_.add("heights.npy"), "<f4", {terrain.columns});
  heights.append(std::span<const float>(terrain.heights));
  heights.finish(terrain.rows);
  nlohmann::ordered_json herds = nlohmann::ordered_json::array();
  for (uint32_t h = 0; h < crowd.herdCount(); ++h) {
    herds_[h].joints.finish(entries_);
    herds_[h].rotations.finish(entries_);
    herds_[h].stance.finish(entries_);
    herds_[h].body.finish(entries_);
    herds.push_back(describe(tracedRig(crowd, h), herds_[h].agents));
    addSizes(implOf(crowd), h, herds.back());
    for (const auto& [tick, agent, leg, bone, state] : herds_[h].legs)
      herds.back()["hurt"].push_back(legState(tracedRig(crowd, h), tick, agent, leg, state, bone));
    for (const auto& [tick, agent, load] : herds_[h].loads)
      herds.back()["loads"].push_back(loadState(tick, agent, load));
  }
  const nlohmann::ordered_json json = {{"dt", dt_},
                                       {"firstTick", firstTick_},
                                       {"ticks", entries_},
                                       {"herds", herds},
                                       {"terrain",
                                        {{"originX", terrain.originX()},
                                         {"originZ", terrain.originZ()},
                                         {"spacingX", terrain.spacingX},
                                         {"spacingZ", terrain.spacingZ}}}};
  writeJson(folder_.add("trace.json"), json, manifest);
  return folder_.commit();
}

}  // namespace skitter::app
