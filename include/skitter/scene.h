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
#include "skitter/forage.h"
#include "skitter/heightfield.h"
#include "skitter/leg_state.h"
#include "skitter/levels.h"
#include "skitter/light.h"
#include "skitter/load.h"
#include "skitter/solver.h"
#include "skitter/tuning.h"
#include "skitter/ways.h"

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
  // Only in herds with ways (docs/ways.md):
  // route: from one of `places` to the next, once or in a loop.   roam: from place to place within `radius`
  // of `target`, for ever.   follow: an agent, or the middle of a herd.   flee: out of threats and obstacles.
  enum class Kind { cross, point, none, velocity, route, roam, follow, flee } kind = Kind::cross;
  static constexpr float maxSpeed = 1000;  // metres per second
  static constexpr size_t maxPlaces = 16;

  glm::vec2 target{0};  // x, z
  float speed = 1;      // commanded horizontal speed, metres per second, 0 to maxSpeed; not of kind velocity
  glm::vec2 velocity{0};               // x, z, metres per second, at most maxSpeed long
  std::vector<glm::vec2> places = {};  // of kind route: x, z, 1 to maxPlaces
  bool loop = false;                   // of kind route: the first place follows the last one
  float radius = 5;                    // of kind roam, metres, Disc::minRadius to Scene::maxCoordinate
  uint32_t leader = 0;                 // of kind follow: the number of a herd
  std::optional<uint32_t> agent = {};  // of kind follow: a place in it; none: its middle

  bool operator==(const Goal&) const = default;
};

struct Herd {
  static constexpr uint32_t minKeys = 2, maxKeys = 8;
  static constexpr size_t maxSizes = 16;
  static constexpr double minSize = 0.05, maxSize = 20;

  // "spider", a model (.glb, .gltf) or a sidecar (.rig.json). A file name is relative to the working
  // directory; in a scene file it is relative to that file, and loadScene resolves it.
  std::string rig = "spider";
  Controller controller = Controller::adaptive;
  // The clips that controllers clip and planted play and key-poses samples (docs/clip.md); empty: the cuts
  // or, without any, all that suit.
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
  // How large its creatures are, times the rig, at most maxSizes from minSize to maxSize; empty: all as the
  // rig is. Each agent draws one by the seed; one that is there twice is drawn twice as often. Agents are
  // numbered size after size, in the order of the first ones here.
  std::vector<float> sizes = {};
  // Whether its agents keep clear of those near them, of all herds, and of obstacles (docs/stages/avoid.md).
  bool avoid = false;
  // Where its agents go to a goal of kind point around obstacles and impassable ground (docs/ways.md).
  std::optional<Ways> ways = {};
  // Metres around each of its agents that other herds with ways keep off, 0 to Scene::maxCoordinate.
  float threat = 0;
  // Where its agents forage, whatever their goals, of which only the speed counts (docs/foraging.md). The
  // herd is of one size. Ground is passable as `ways` says, or by its defaults.
  std::optional<Forage> forage = {};
  // Where in the cycle of its gait or clip each agent begins, 0 to 1; none: drawn by the seed.
  std::optional<float> phase = {};
  // The herd's colour: each of the model's becomes this one, lighter or darker as it was. Linear RGB, 0 to 1;
  // none: the model's stay.
  std::optional<glm::vec3> colour = {};
  // How much agents differ in colour, by the seed: 0 not at all, 1 by most; none: half, by their numbers.
  std::optional<float> tint = {};
  // Whether legs of its agents can be hurt (Crowd::hurt), and whether they can carry loads (Crowd::carry):
  // such a herd has two records more per agent, and pipelines of its own. Of controllers adaptive, loop and
  // planted, with the solver activeSet.
  bool hurt = false;
  // Whether its agents stumble, fall and get up (Crowd::push, docs/reactions.md). Their legs can be hurt
  // then, too. Of controller adaptive, with the solver activeSet.
  bool reactions = false;
  // Whether an agent that is hurt is not told which legs, and tries gaits until one is good (docs/evolve.md).
  // The controller is adaptive, legs can be hurt, and agents carry nothing.
  bool adapts = false;

  bool operator==(const Herd&) const = default;
};

// Where a camera on a path is, and what it looks at, at a time.
struct CameraKey {
  float time = 0;  // seconds
  glm::vec3 position{0}, target{0};

  bool operator==(const CameraKey&) const = default;
};
struct Camera {
  static constexpr size_t minPathKeys = 2, maxPathKeys = 1024;
  static constexpr float maxPathTime = 86400;      // seconds
  static constexpr float minPathStep = 1.0f / 64;  // seconds from a key to the next

  // follow: behind and above the middle of the crowd.  fixed: from `position` at `target`.
  // orbit: around the middle of the crowd, or `about`.  path: through `keys`, along a Hermite spline.
  enum class Kind { follow, fixed, orbit, path } kind = Kind::follow;
  glm::vec3 position{0}, target{0};  // fixed only
  float distance = 9;                // metres from what it looks at, follow and orbit only
  float fieldOfView = 0.8f;          // radians, vertical
  // Orbit only.
  std::optional<glm::vec3> about = {};  // none: the middle of the crowd, as follow has it
  float elevation = 0.3f;               // radians above the horizon of what it looks at
  float azimuth = 0;                    // radians about +Y from +Z: on which side of it the eye begins
  float secondsATurn = 30;  // counter-clockwise as seen from above; below 0 clockwise, 0: it stays
  // Path only: minPathKeys to maxPathKeys, each at least minPathStep after the one before.
  std::vector<CameraKey> keys = {};

  bool operator==(const Camera&) const = default;
};

// Ground that rises or sinks: a sample at distance d from the centre by height (1 - d^2 / radius^2)^2.
struct Mound {
  glm::vec2 centre{0};  // x, z
  float radius = 1;     // metres, above 0
  float height = 0.5f;  // metres; below 0: a pit

  bool operator==(const Mound&) const = default;
};
// New heights of a rectangle of the terrain's samples, as Crowd::editHeights takes them.
struct HeightSamples {
  uint32_t x = 0, z = 0, columns = 0, rows = 0;
  std::vector<float> heights = {};

  bool operator==(const HeightSamples&) const = default;
};

// Where an agent is put, its feet on the ground around.
struct Place {
  glm::vec2 position{0};  // x, z, world metres, on the terrain
  float heading = 0;      // radians about +Y, 0 faces +Z, -1000 to 1000

  bool operator==(const Place&) const = default;
};
// Scenes speak to agents by these, as programs do by Crowd::steer, setSpeed, teleport, add and remove. A herd
// is named by its number, which is its index in the scene or the one that HerdAddition gives. An agent is
// named by its place in the herd, below the herd's agents and reserve: whoever is there then.
struct GoalChange {
  uint32_t herd = 0;
  std::vector<uint32_t> agents = {};  // empty: all who are there
  Goal goal = {};

  bool operator==(const GoalChange&) const = default;
};
struct SpeedChange {
  uint32_t herd = 0;
  std::vector<uint32_t> agents = {};  // empty: all who are there
  float speed = 0;                    // metres per second, 0 to Goal::maxSpeed

  bool operator==(const SpeedChange&) const = default;
};
struct Teleport {
  struct Move {
    uint32_t agent = UINT32_MAX;  // none
    Place place = {};

    bool operator==(const Move&) const = default;
  };
  uint32_t herd = 0;
  std::vector<Move> moves = {};  // at least one

  bool operator==(const Teleport&) const = default;
};
// Adds agents in the lowest empty places of a herd with a reserve. A place says how large its agent is.
struct Addition {
  struct Arrival {
    Place place = {};
    std::optional<Goal> goal = {};  // none: the herd's

    bool operator==(const Arrival&) const = default;
  };
  uint32_t herd = 0;
  std::vector<Arrival> arrivals = {};  // at least one

  bool operator==(const Addition&) const = default;
};
// Removes agents from a herd with a reserve.
struct Removal {
  uint32_t herd = 0;
  std::vector<uint32_t> agents = {};  // at least one, none twice

  bool operator==(const Removal&) const = default;
};

// A leg of some agents of a herd that can be hurt (Herd::hurt), as Crowd::hurt has it.
struct LegChange {
  uint32_t herd = 0;
  std::vector<uint32_t> agents = {};  // empty: all who are there, or a share of them
  std::optional<float> share = {};    // 0 to 1: each is drawn by the seed; without `agents`
  std::string leg;                    // by its name in the rig
  LegState state = LegState::lost;
  std::optional<uint32_t> bone = {};  // the first one that is lost, from the root on; none: as of AgentLeg

  bool operator==(const LegChange&) const = default;
};

// A load that some agents of a herd that can be hurt (Herd::hurt) take up or, of mass 0, lay down, as
// Crowd::carry has it.
struct LoadChange {
  uint32_t herd = 0;
  std::vector<uint32_t> agents = {};  // empty: all who are there, or a share of them
  std::optional<float> share = {};    // 0 to 1: each is drawn by the seed; without `agents`
  Load load = {};

  bool operator==(const LoadChange&) const = default;
};

// A push of some agents of a herd with reactions, as Crowd::push has it.
struct Push {
  static constexpr float most = 100;  // metres per second

  uint32_t herd = 0;
  std::vector<uint32_t> agents = {};  // empty: all who are there, or a share of them
  std::optional<float> share = {};    // 0 to 1: each is drawn by the seed; without `agents`
  glm::vec2 velocity{0};              // x, z, metres per second, added to the velocity; at most `most` long

  bool operator==(const Push&) const = default;
};

// A herd that comes, as Crowd::addHerd has it: it gets the lowest number that no herd has. Its rig and clips
// are read when the crowd is made.
struct HerdAddition {
  Herd herd;

  bool operator==(const HerdAddition&) const = default;
};
// A herd that goes, as Crowd::removeHerd has it.
struct HerdRemoval {
  uint32_t herd = 0;

  bool operator==(const HerdRemoval&) const = default;
};

// A threat that comes, moves or goes, as Crowd::setThreat has it.
struct ThreatChange {
  uint32_t number = 0;  // below Scene::maxThreats
  Threat threat = {};

  bool operator==(const ThreatChange&) const = default;
};

// Something that happens to a running crowd, just before the first tick that ends at `at` or later.
struct Event {
  static constexpr float maxTime = 86400;        // seconds
  static constexpr size_t maxSamples = 1 << 16;  // of HeightSamples
  static constexpr size_t maxAgents = 1 << 16;   // that one event names, moves or adds

  float at = 0;  // seconds
  std::variant<Mound, HeightSamples, GoalChange, SpeedChange, Teleport, Addition, Removal, HerdAddition,
               HerdRemoval, ThreatChange, LegChange, Push, LoadChange>
      what;

  bool operator==(const Event&) const = default;
};

struct SKITTER_API Scene {
  static constexpr size_t maxHerds = 1024, maxEvents = 4096, maxObstacles = 4096, maxThreats = 64;
  static constexpr uint32_t maxAgents = 1 << 24;  // of all herds: records hold an agent's index as a float
  static constexpr float maxCoordinate = 4096;  // metres from the origin: feet beyond are placed too coarsely

  std::string name = "built-in";
  std::variant<TerrainNoise, TerrainFile> terrain;
  std::vector<Herd> herds{Herd{}};
  Camera camera;
  std::vector<Event> events;          // by time; Crowd::record lets them happen
  std::vector<Obstacle> obstacles;    // herds with ways go around them, those that avoid keep clear of them
  std::vector<Threat> threats;        // and around these; Crowd::setThreat names them by their index
  std::optional<Levels> levels = {};  // of rate, where CrowdOptions::levels does not say others
  Light light;                        // of pictures
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
