#include "app/common/scene_hash.h"

#include <bit>
#include <filesystem>
#include <fstream>
#include <map>
#include <string_view>

#include "skitter/rig.h"
#include "skitter/rig_gaits.h"
#include "skitter/rig_setup.h"

namespace skitter::app {
namespace {

// FNV-1a (Fowler, Noll & Vo) of values in place of bytes, the upper half folded into the lower one.
class Hash {
 public:
  void add(uint64_t value) {
    value_ = (value_ ^ value) * 0x100000001b3ull;
    value_ ^= value_ >> 32;
  }
  void add(float value) { add(uint64_t{std::bit_cast<uint32_t>(value)}); }
  void add(double value) { add(std::bit_cast<uint64_t>(value)); }
  void add(const glm::vec2& value) {
    add(value.x);
    add(value.y);
  }
  void add(std::string_view text) {
    add(uint64_t{text.size()});
    for (const char c : text) add(uint64_t{static_cast<uint8_t>(c)});
  }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0xcbf29ce484222325ull;
};

// The hashes of files. Many herds may name one file, which is read once.
class FileHashes {
 public:
  // That of an empty file where there is none.
  uint64_t hashOf(const std::filesystem::path& file) {
    const auto [known, isNew] = hashes_.try_emplace(file);
    if (isNew) {
      std::ifstream in(file, std::ios::binary);
      const std::string bytes((std::istreambuf_iterator<char>(in)), {});
      Hash hash;
      hash.add(std::string_view(bytes));
      known->second = hash.value();
    }
    return known->second;
  }

 private:
  std::map<std::filesystem::path, uint64_t> hashes_;
};

// The gaits of the built-in spider for legs that do not carry; nothing where it has none.
void addSpiderTable(Hash& hash) {
  const Rig rig = spiderRig();
  if (!rig.gaits.empty()) hash.add(std::string_view(writeGaits(rig, rig.gaits)));
}

// Bindings to all members: a new one does not compile until it is looked at here.
void add(Hash& hash, const Goal& goal) {
  const auto& [kind, target, speed, velocity, places, loop, radius, leader, agent] = goal;
  hash.add(static_cast<uint64_t>(kind));
  hash.add(target);
  hash.add(speed);
  if (kind == Goal::Kind::velocity) hash.add(velocity);
  if (kind == Goal::Kind::route) {
    hash.add(uint64_t{loop});
    hash.add(uint64_t{places.size()});
    for (const glm::vec2& place : places) hash.add(place);
  }
  if (kind == Goal::Kind::roam) hash.add(radius);
  if (kind == Goal::Kind::follow) {
    hash.add(uint64_t{leader});
    hash.add(agent ? uint64_t{1} + *agent : uint64_t{0});
  }
}

void add(Hash& hash, const Load& load) {
  const auto& [mass, offset] = load;
  hash.add("load");
  hash.add(mass);
  hash.add(offset);
}

void add(Hash& hash, const Forage& forage) {
  const auto& [nest, food, branches, cell, threshold, power, layHome, layOut, life, patience, rest, load] =
      forage;
  const auto addDisc = [&](const glm::vec2& centre, float radius) {
    hash.add(centre);
    hash.add(radius);
  };
  hash.add("forage");
  addDisc(nest.centre, nest.radius);
  hash.add(uint64_t{food.size()});
  for (const auto& [centre, radius, amount] : food) {
    addDisc(centre, radius);
    hash.add(uint64_t{amount});
  }
  for (const auto& [centre, radius] : branches) addDisc(centre, radius);
  for (const float each : {cell, threshold, layHome, layOut, life, rest}) hash.add(each);
  hash.add(uint64_t{power});
  hash.add(uint64_t{patience});
  if (load.mass > 0) add(hash, load);
}

void add(Hash& hash, FileHashes& fileHashes, const Herd& herd) {
  const auto& [rig, controller, clips, cuts, keys, solver, stepping, tuning, agents, reserve, spawn, goal,
               sizes, avoid, ways, threat, forage, phase, colour, tint, hurt, reactions, adapts] = herd;
  for (const char* name : {nameOf(controller), nameOf(solver), nameOf(stepping)}) hash.add(name);
  hash.add(rig == "spider" ? std::string_view(rig) : "file");  // wherever it lies
  if (rig != "spider") {
    hash.add(fileHashes.hashOf(rig));
    hash.add(fileHashes.hashOf(sidecarOf(rig)));
  }
  hash.add(uint64_t{clips.size()});
  for (const std::string& clip : clips) hash.add(clip);
  hash.add(uint64_t{cuts.size()});
  for (const auto& [clip, name, from, to] : cuts) {
    hash.add(clip);
    hash.add(name);
    hash.add(from);
    hash.add(to);
  }
  hash.add(uint64_t{keys});
  // A newer key must not change the hash of a scene that does not set it.
  if (!sizes.empty()) {
    hash.add("sizes");
    hash.add(uint64_t{sizes.size()});
    for (const float size : sizes) hash.add(size);
  }
  if (avoid) hash.add("avoid");
  if (ways) {
    const auto& [climb, steepest, step] = *ways;
    hash.add("ways");
    for (const float each : {climb, steepest, step}) hash.add(each);
  }
  if (threat > 0) {
    hash.add("threat");
    hash.add(threat);
  }
  if (forage) add(hash, *forage);
  if (phase) {
    hash.add("phase");
    hash.add(*phase);
  }
  if (hurt) {
    hash.add("hurt");
    std::error_code ignored;
    if (rig == "spider")
      addSpiderTable(hash);
    else if (std::filesystem::exists(gaitsOf(rig), ignored))
      hash.add(fileHashes.hashOf(gaitsOf(rig)));
  }
  if (reactions) hash.add("reactions");
  if (adapts) hash.add("adapts");
  for (const TuningInfo& info : allTunings)
    if (tuning.*info.member != info.usual) {
      hash.add(info.name);
      hash.add(tuning.*info.member);
    }
  hash.add(uint64_t{agents});
  if (reserve > 0) hash.add(uint64_t{reserve});
  const auto& [spawnKind, spacing, centre, heading] = spawn;
  hash.add(static_cast<uint64_t>(spawnKind));
  hash.add(spacing);
  hash.add(centre);
  hash.add(heading);
  add(hash, goal);
}

void add(Hash& hash, const Disc& disc) {
  const auto& [centre, radius] = disc;
  hash.add("disc");
  hash.add(centre);
  hash.add(radius);
}

void add(Hash& hash, const Capsule& capsule) {
  const auto& [from, to, radius] = capsule;
  hash.add("capsule");
  hash.add(from);
  hash.add(to);
  hash.add(radius);
}

void add(Hash& hash, const ConvexPolygon& polygon) {
  const auto& [corners] = polygon;
  hash.add("polygon");
  hash.add(uint64_t{corners.size()});
  for (const glm::vec2& corner : corners) hash.add(corner);
}

void add(Hash& hash, const Mound& mound) {
  const auto& [centre, radius, height] = mound;
  hash.add("mound");
  hash.add(centre);
  hash.add(radius);
  hash.add(height);
}

void add(Hash& hash, const HeightSamples& samples) {
  const auto& [x, z, columns, rows, heights] = samples;
  hash.add("edit");
  for (const uint32_t each : {x, z, columns, rows}) hash.add(uint64_t{each});
  for (const float height : heights) hash.add(height);
}

void add(Hash& hash, const Place& place) {
  const auto& [position, heading] = place;
  hash.add(position);
  hash.add(heading);
}

// Adds what an event does, and to which agents of a herd.
void add(Hash& hash, std::string_view what, uint32_t herd, const std::vector<uint32_t>& agents) {
  hash.add(what);
  hash.add(uint64_t{herd});
  hash.add(uint64_t{agents.size()});
  for (const uint32_t agent : agents) hash.add(uint64_t{agent});
}

void add(Hash& hash, const GoalChange& change) {
  const auto& [herd, agents, goal] = change;
  add(hash, "goal", herd, agents);
  add(hash, goal);
}

void add(Hash& hash, const SpeedChange& change) {
  const auto& [herd, agents, speed] = change;
  add(hash, "speed", herd, agents);
  hash.add(speed);
}

void add(Hash& hash, const Teleport& teleport) {
  const auto& [herd, moves] = teleport;
  hash.add("teleport");
  hash.add(uint64_t{herd});
  hash.add(uint64_t{moves.size()});
  for (const auto& [agent, place] : moves) {
    hash.add(uint64_t{agent});
    add(hash, place);
  }
}

void add(Hash& hash, const Addition& addition) {
  const auto& [herd, arrivals] = addition;
  hash.add("add");
  hash.add(uint64_t{herd});
  hash.add(uint64_t{arrivals.size()});
  for (const auto& [place, goal] : arrivals) {
    add(hash, place);
    hash.add(uint64_t{goal.has_value()});
    if (goal) add(hash, *goal);
  }
}

void add(Hash& hash, const Removal& removal) {
  const auto& [herd, agents] = removal;
  add(hash, "remove", herd, agents);
}

void add(Hash& hash, FileHashes& fileHashes, const HerdAddition& addition) {
  const auto& [herd] = addition;
  hash.add("addHerd");
  add(hash, fileHashes, herd);
}

void add(Hash& hash, const HerdRemoval& removal) {
  const auto& [herd] = removal;
  hash.add("removeHerd");
  hash.add(uint64_t{herd});
}

void add(Hash& hash, const Threat& threat) {
  const auto& [centre, radius] = threat;
  hash.add("threat");
  hash.add(centre);
  hash.add(radius);
}

void add(Hash& hash, const ThreatChange& change) {
  const auto& [number, threat] = change;
  hash.add(uint64_t{number});
  add(hash, threat);
}

void add(Hash& hash, const LegChange& change) {
  const auto& [herd, agents, share, leg, state, bone] = change;
  add(hash, "leg", herd, agents);
  hash.add(share.value_or(-1));
  hash.add(leg);
  hash.add(nameOf(state));
  hash.add(uint64_t{bone.value_or(UINT32_MAX)});
}

void add(Hash& hash, const Push& push) {
  const auto& [herd, agents, share, velocity] = push;
  add(hash, "push", herd, agents);
  hash.add(share.value_or(-1));
  hash.add(velocity);
}

void add(Hash& hash, const LoadChange& change) {
  const auto& [herd, agents, share, load] = change;
  add(hash, "loads", herd, agents);
  hash.add(share.value_or(-1));
  add(hash, load);
}

// Most events name no file.
template <class What>
void add(Hash& hash, FileHashes&, const What& what) {
  add(hash, what);
}

void add(Hash& hash, FileHashes& fileHashes, const Event& event) {
  const auto& [at, what] = event;
  hash.add(at);
  std::visit([&](const auto& each) { add(hash, fileHashes, each); }, what);
}

}  // namespace

uint64_t sceneHash(const Scene& scene, const Heightfield& terrain) {
  Hash hash;
  FileHashes fileHashes;
  const auto& [name, source, herds, camera, events, obstacles, threats, levels, light, seed] = scene;
  hash.add(seed);
  hash.add(uint64_t{herds.size()});
  for (const Herd& herd : herds) add(hash, fileHashes, herd);
  for (const Event& event : events) add(hash, fileHashes, event);
  for (const auto& [shape] : obstacles) std::visit([&](const auto& each) { add(hash, each); }, shape);
  for (const Threat& threat : threats) add(hash, threat);
  if (levels) {
    const auto& [distances, most] = *levels;
    hash.add("levels");
    for (const float each : distances) hash.add(each);
    for (const uint32_t each : most) hash.add(uint64_t{each});
  }
  hash.add(uint64_t{terrain.columns});
  hash.add(terrain.spacingX);
  hash.add(terrain.spacingZ);
  for (const float height : terrain.heights) hash.add(height);
  return hash.value();
}

}  // namespace skitter::app
