#include "skitter/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "assets/files/file.h"
#include "assets/files/json.h"
#include "assets/heights/heightfield_limits.h"
#include "embedded/crossing_json.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr double cameraLimit = 1e5;  // metres
constexpr size_t maxCuts = 64;
constexpr double maxVoidValue = std::numeric_limits<double>::max();

// One JSON object: reads its known keys, leaves defaults where a key is missing, and knows which key no one
// asked for.
class Fields {
 public:
  Fields(const nlohmann::json& json, std::string file, std::string path)
      : json_(json), file_(std::move(file)), path_(std::move(path)) {
    if (!json_.is_object()) {
      throw inputError(fmt::format("{}: {} is {}, expected an object", file_,
                                   path_.empty() ? "the scene" : path_, describeJson(json_)));
    }
  }

  void read(const char* key, float& value, double least, double most) {
    if (const auto* json = find(key)) value = static_cast<float>(number(*json, pathOf(key), least, most));
  }
  void read(const char* key, double& value, double least, double most) {
    if (const auto* json = find(key)) value = number(*json, pathOf(key), least, most);
  }
  template <typename Number>
  void read(const char* key, std::optional<Number>& value, double least, double most) {
    if (const auto* json = find(key)) value = static_cast<Number>(number(*json, pathOf(key), least, most));
  }
  template <typename Integer>
  void readInteger(const char* key, Integer& value, uint64_t least, uint64_t most) {
    const auto* json = find(key);
    if (!json) return;
    const bool whole = json->is_number_unsigned();
    if (!whole || json->get<uint64_t>() < least || json->get<uint64_t>() > most) {
      fail(pathOf(key), *json, fmt::format("a whole number from {} to {}", least, most));
    }
    value = static_cast<Integer>(json->get<uint64_t>());
  }
  void read(const char* key, std::string& value) {
    const auto* json = find(key);
    if (!json) return;
    if (!json->is_string() || json->get_ref<const std::string&>().empty()) {
      fail(pathOf(key), *json, "a string that is not empty");
    }
    value = json->get<std::string>();
  }
  void read(const char* key, std::vector<std::string>& values) {
    const auto* json = find(key);
    if (!json) return;
    const bool strings = json->is_array() && std::all_of(json->begin(), json->end(),
                                                         [](const auto& item) { return item.is_string(); });
    if (!strings || json->size() > 64) fail(pathOf(key), *json, "an array of at most 64 strings");
    values = json->get<std::vector<std::string>>();
  }
  template <int Size>
  void read(const char* key, glm::vec<Size, float>& value, double limit) {
    const auto* json = find(key);
    if (!json) return;
    if (!json->is_array() || json->size() != size_t{Size}) {
      fail(pathOf(key), *json, fmt::format("an array of {} numbers", Size));
    }
    for (int i = 0; i < Size; ++i) {
      value[i] = static_cast<float>(
          number((*json)[static_cast<size_t>(i)], fmt::format("{}[{}]", pathOf(key), i), -limit, limit));
    }
  }
  // The index of the key's string among `names`.
  template <typename Kind>
  void readKind(const char* key, Kind& value, std::initializer_list<const char*> names) {
    const auto* json = find(key);
    if (!json) return;
    int index = 0;
    for (const char* name : names) {
      if (json->is_string() && json->get_ref<const std::string&>() == name) {
        value = static_cast<Kind>(index);
        return;
      }
      ++index;
    }
    fail(pathOf(key), *json, fmt::format("one of \"{}\"", fmt::join(names, "\", \"")));
  }
  template <typename Enum, size_t Count>
  void readNamed(const char* key, Enum& value, const std::array<Enum, Count>& all) {
    const auto* json = find(key);
    if (!json) return;
    const auto named = json->is_string() ? enumNamed(all, json->get_ref<const std::string&>()) : std::nullopt;
    if (!named) fail(pathOf(key), *json, fmt::format("one of \"{}\"", namesOf(all, "\", \"")));
    value = *named;
  }
  // checkTuning() checks the range.
  void read(const TuningInfo& info, Tuning& tuning) {
    const auto* json = find(info.name);
    if (!json) return;
    // A number that float cannot hold is outside every range.
    if (!json->is_number() || !isWithin(json->get<double>(), -1e30, 1e30))
      fail(pathOf(info.name), *json, rangeOf(info));
    tuning.*info.member = json->get<float>();
  }
  const nlohmann::json* find(const char* key) {
    known_.insert(key);
    const auto found = json_.find(key);
    return found == json_.end() ? nullptr : &*found;
  }
  std::string pathOf(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  [[noreturn]] void fail(const std::string& path, const nlohmann::json& found,
                         const std::string& expected) const {
    throw inputError(fmt::format("{}: {} is {}, expected {}", file_, path, describeJson(found), expected));
  }
  // Call last: every key must have been asked for.
  void finish() const {
    for (const auto& [key, value] : json_.items()) {
      if (known_.count(key) == 0) {
        throw inputError(fmt::format("{}: {} is no known key, expected one of {}", file_,
                                     pathOf(describeKey(key)), fmt::join(known_, ", ")));
      }
    }
  }

 private:
  static std::string describeKey(const std::string& key) {
    const std::string quoted = describeJson(key);
    return quoted.substr(1, quoted.size() - 2);
  }
  double number(const nlohmann::json& json, const std::string& path, double least, double most) const {
    if (!json.is_number() || !isWithin(json.get<double>(), least, most)) {
      fail(path, json, fmt::format("a number from {} to {}", least, most));
    }
    return json.get<double>();
  }

  const nlohmann::json& json_;
  std::string file_, path_;
  std::set<std::string> known_;
};

class SceneReader {
 public:
  SceneReader(std::string file, std::filesystem::path folder)
      : file_(std::move(file)), folder_(std::move(folder)) {}

  Scene scene(const nlohmann::json& json) const {
    Scene scene;
    Fields fields(json, file_, "");
    scene.name = std::filesystem::path(file_).stem().string();
    fields.read("name", scene.name);
    fields.readInteger("seed", scene.seed, 0, UINT64_MAX);
    if (const auto* terrain = fields.find("terrain")) readTerrain(*terrain, scene);
    if (const auto* herds = fields.find("herds")) {
      if (!herds->is_array() || herds->size() > Scene::maxHerds)
        fields.fail("herds", *herds, fmt::format("an array of at most {} herds", Scene::maxHerds));
      scene.herds.clear();
      for (const auto& herd : *herds) {
        scene.herds.push_back(readHerd(herd, fmt::format("herds[{}]", scene.herds.size())));
      }
    }
    if (const auto* camera = fields.find("camera")) scene.camera = readCamera(*camera);
    fields.finish();
    if (scene.agentCount() > Scene::maxAgents) {
      throw inputError(fmt::format("{}: herds have {} agents in all, expected at most {}", file_,
                                   scene.agentCount(), Scene::maxAgents));
    }
    return scene;
  }

 private:
  void readTerrain(const nlohmann::json& json, Scene& scene) const {
    Fields fields(json, file_, "terrain");
    enum class Kind { noise, file } kind = Kind::noise;
    fields.readKind("kind", kind, {"noise", "file"});
    if (kind == Kind::noise) {
      TerrainNoise noise;
      fields.readInteger("columns", noise.columns, minSamples, maxSamples);
      fields.readInteger("rows", noise.rows, minSamples, maxSamples);
      fields.read("spacing", noise.spacing, minSpacing, maxSpacing);
      fields.read("amplitude", noise.amplitude, 0, Scene::maxCoordinate);
      fields.read("wavelength", noise.wavelength, minSpacing, maxHeightMagnitude);
      fields.readInteger("octaves", noise.octaves, 1, TerrainNoise::maxOctaves);
      fields.read("gain", noise.gain, 0, 1);
      fields.readInteger("seed", noise.seed, 0, UINT64_MAX);
      scene.terrain = noise;
    } else {
      TerrainFile terrain;
      std::string name;
      fields.read("file", name);
      if (name.empty())
        throw inputError(fmt::format("{}: terrain.file is missing, kind \"file\" needs it", file_));
      terrain.file = folder_ / name;
      fields.read("spacingX", terrain.units.spacingX, minSpacing, maxSpacing);
      fields.read("spacingZ", terrain.units.spacingZ, minSpacing, maxSpacing);
      fields.read("minHeight", terrain.units.minHeight, -maxHeightMagnitude, maxHeightMagnitude);
      fields.read("maxHeight", terrain.units.maxHeight, -maxHeightMagnitude, maxHeightMagnitude);
      fields.read("scale", terrain.units.scale, minScale, maxScale);
      fields.read("exaggeration", terrain.units.exaggeration, 0, maxExaggeration);
      fields.read("voidValue", terrain.units.voidValue, -maxVoidValue, maxVoidValue);
      readSide(fields, "columns", terrain.units.columns);
      readSide(fields, "rows", terrain.units.rows);
      scene.terrain = terrain;
    }
    fields.finish();
  }

  static void readSide(Fields& fields, const char* key, std::optional<uint32_t>& side) {
    if (!fields.find(key)) return;
    fields.readInteger(key, side.emplace(), minSamples, maxSamples);
  }

  std::vector<ClipCut> readCuts(const nlohmann::json& json, const std::string& path) const {
    if (!json.is_array() || json.size() > maxCuts)
      throw inputError(fmt::format("{}: {} is {}, expected an array of at most {} objects", file_, path,
                                   describeJson(json), maxCuts));
    std::vector<ClipCut> cuts;
    for (const nlohmann::json& item : json) {
      const std::string itemPath = fmt::format("{}[{}]", path, cuts.size());
      ClipCut cut;
      Fields fields(item, file_, itemPath);
      fields.read("clip", cut.clip);
      fields.read("name", cut.name);
      fields.read("from", cut.from, 0, Clip::maxSeconds);
      fields.read("to", cut.to, 0, Clip::maxSeconds);
      fields.finish();
      if (cut.name.empty()) throw inputError(fmt::format("{}: {}.name is missing", file_, itemPath));
      if (!(cut.from < cut.to))
        throw inputError(
            fmt::format("{}: {}.to is {}, expected more than from, {}", file_, itemPath, cut.to, cut.from));
      cuts.push_back(cut);
    }
    return cuts;
  }
  Herd readHerd(const nlohmann::json& json, const std::string& path) const {
    Herd herd;
    Fields fields(json, file_, path);
    fields.read("rig", herd.rig);
    if (herd.rig != "spider") herd.rig = (folder_ / herd.rig).string();
    fields.readNamed("controller", herd.controller, allControllers);
    fields.read("clips", herd.clips);
    if (const auto* cuts = fields.find("cuts")) herd.cuts = readCuts(*cuts, path + ".cuts");
    fields.readInteger("keys", herd.keys, Herd::minKeys, Herd::maxKeys);
    fields.readNamed("solver", herd.solver, herdSolvers);
    fields.readNamed("stepping", herd.stepping, allSteppings);
    if (const auto* tuning = fields.find("tuning")) herd.tuning = readTuning(*tuning, path + ".tuning");
    fields.readInteger("agents", herd.agents, 0, Scene::maxAgents);
    if (const auto* spawn = fields.find("spawn")) herd.spawn = readSpawn(*spawn, path + ".spawn");
    if (const auto* goal = fields.find("goal")) herd.goal = readGoal(*goal, path + ".goal");
    fields.finish();
    return herd;
  }

  Tuning readTuning(const nlohmann::json& json, const std::string& path) const {
    Tuning tuning;
    Fields fields(json, file_, path);
    for (const TuningInfo& info : allTunings) fields.read(info, tuning);
    fields.finish();
    checkTuning(tuning, fmt::format("{}: {}", file_, path));
    return tuning;
  }

  Spawn readSpawn(const nlohmann::json& json, const std::string& path) const {
    Spawn spawn;
    Fields fields(json, file_, path);
    fields.readKind("kind", spawn.kind, {"lanes", "grid"});
    fields.read("spacing", spawn.spacing, 0.01, Scene::maxCoordinate);
    fields.read("centre", spawn.centre, Scene::maxCoordinate);
    fields.read("heading", spawn.heading, -1000, 1000);
    fields.finish();
    return spawn;
  }

  Goal readGoal(const nlohmann::json& json, const std::string& path) const {
    Goal goal;
    Fields fields(json, file_, path);
    fields.readKind("kind", goal.kind, {"cross", "point", "none"});
    fields.read("target", goal.target, Scene::maxCoordinate);
    fields.read("speed", goal.speed, 0, 1000);
    fields.finish();
    return goal;
  }

  Camera readCamera(const nlohmann::json& json) const {
    Camera camera;
    Fields fields(json, file_, "camera");
    fields.readKind("kind", camera.kind, {"follow", "fixed"});
    fields.read("position", camera.position, cameraLimit);
    fields.read("target", camera.target, cameraLimit);
    fields.read("distance", camera.distance, 0.01, cameraLimit);
    fields.read("fieldOfView", camera.fieldOfView, 0.01, 3.1);
    fields.finish();
    if (camera.kind == Camera::Kind::fixed && camera.position == camera.target) {
      throw inputError(
          fmt::format("{}: camera.position equals camera.target, a fixed camera needs a direction", file_));
    }
    return camera;
  }

  std::string file_;
  std::filesystem::path folder_;
};

}  // namespace

Heightfield Scene::loadTerrain() const {
  if (const auto* noise = std::get_if<TerrainNoise>(&terrain)) return generateHeightfield(*noise);
  const auto& file = std::get<TerrainFile>(terrain);
  return loadHeightfield(file.file, file.units);
}

uint64_t Scene::agentCount() const {
  uint64_t count = 0;
  for (const Herd& herd : herds) count += herd.agents;
  return count;
}

Scene builtinScene() {
  const auto bytes = embedded::crossing_json();
  return parseScene({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "crossing.json", {});
}

Scene loadScene(const std::filesystem::path& file) {
  const std::vector<uint8_t> bytes = readFile(file);
  return parseScene({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.string(),
                    file.parent_path());
}

Scene parseScene(const std::string& json, const std::string& name, const std::filesystem::path& folder) {
  return SceneReader(name, folder).scene(parseJson(json, name, true));
}

}  // namespace skitter
