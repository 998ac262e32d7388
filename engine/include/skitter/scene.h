#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "skitter/clip.h"
#include "skitter/controller.h"
#include "skitter/export.h"
#include "skitter/heightfield.h"
#include "skitter/solver.h"
#include "skitter/tuning.h"

namespace skitter {

// A scene is data: terrain, herds, camera and seed. docs/scene.md documents the JSON form, key for key.

struct TerrainFile {
  std::filesystem::path file;
  HeightfieldUnits units;

  bool operator==(const TerrainFile&) const = default;
};

// Where agents start and where they go.
struct Spawn {
  // lanes: parallel lanes along +z across the terrain, agents evenly along each lane.
  // grid: a square grid of agents about `centre`.
  enum class Kind { lanes, grid } kind = Kind::lanes;
  float spacing = 2.5f;  // metres between lanes, or between agents of a grid
  glm::vec2 centre{0};   // x, z
  float heading = 0;     // radians about +Y, 0 faces +Z

  bool operator==(const Spawn&) const = default;
};
struct Goal {
  // cross: walk to the far side of the terrain, turn, and come back beside the own lane, for ever.
  // point: walk to `target` and stand there.   none: stand.   velocity: go by `velocity`.
  enum class Kind { cross, point, none, velocity } kind = Kind::cross;
  static constexpr float maxSpeed = 1000;  // metres a second

  glm::vec2 target{0};    // x, z
  float speed = 1;        // commanded horizontal speed, metres a second, 0 to maxSpeed; not of kind velocity
  glm::vec2 velocity{0};  // x, z, metres a second, at most maxSpeed long

  bool operator==(const Goal&) const = default;
};

struct Herd {
  static constexpr uint32_t minKeys = 2, maxKeys = 8;

  std::string rig =
      "spider";  // "spider", a model (.glb, .gltf) or a sidecar (.rig.json), relative to the scene
  Controller controller = Controller::adaptive;
  // That clip and planted play and pose samples (docs/clip.md); empty: the cuts or, without any, all that
  // suit.
  std::vector<std::string> clips;
  std::vector<ClipCut> cuts;          // clips cut out of those of the file
  uint32_t keys = 4;                  // key poses of controller key-poses, minKeys to maxKeys
  Solver solver = Solver::activeSet;  // one of herdSolvers
  Stepping stepping = Stepping::gait;
  Tuning tuning;  // docs/tuning.md
  uint32_t agents = 1000;
  uint32_t reserve = 0;  // places for more, who come and go while the crowd runs (Crowd::add)
  Spawn spawn;
  Goal goal;

  bool operator==(const Herd&) const = default;
};

struct Camera {
  // follow: behind and above the middle of the crowd.  fixed: from `position` at `target`.
  enum class Kind { follow, fixed } kind = Kind::follow;
  glm::vec3 position{0}, target{0};
  float distance = 9;        // metres from the crowd's middle, follow only
  float fieldOfView = 0.8f;  // radians, vertical

  bool operator==(const Camera&) const = default;
};

struct SKITTER_API Scene {
  static constexpr size_t maxHerds = 1024;
  static constexpr uint32_t maxAgents = 1 << 24;  // of all herds: records hold an agent's index as a float
  static constexpr float maxCoordinate = 4096;  // metres from the origin: feet beyond are placed too coarsely

  std::string name = "built-in";
  std::variant<TerrainNoise, TerrainFile> terrain;
  std::vector<Herd> herds{Herd{}};
  Camera camera;
  uint64_t seed = 1;

  Heightfield loadTerrain() const;  // throws Error(input)
  uint64_t agentCount() const;
  uint64_t capacity() const;  // with the herds' reserves, at most maxAgents
  bool operator==(const Scene&) const = default;
};

// The built-in scene: 1,000 spiders crossing generated ground in parallel lanes
// (assets/scenes/crossing.json).
SKITTER_API Scene builtinScene();
// Throws Error(input) that names the file and the field.
SKITTER_API Scene loadScene(const std::filesystem::path& file);
SKITTER_API Scene parseScene(const std::string& json, const std::string& name,
                             const std::filesystem::path& folder);
// The JSON form, with every key and with absolute file names: it is read back as an equal scene. Throws
// Error(input) that names the key of a value that no scene file may have.
SKITTER_API std::string sceneJson(const Scene& scene);

}  // namespace skitter
