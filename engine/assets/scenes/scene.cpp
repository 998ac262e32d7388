#include "skitter/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include "assets/files/file.h"
#include "assets/files/json.h"
#include "assets/heights/heightfield_limits.h"
#include "base/spelling.h"
#include "embedded/crossing_json.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr double cameraLimit = 1e5;  // metres
constexpr size_t maxCuts = 64;
constexpr double maxVoidValue = std::numeric_limits<double>::max();

// Where a scene comes from: what messages call it, and what its file names are relative to.
struct Source {
  std::string file;
  std::filesystem::path folder;
};

[[noreturn]] void failIn(const std::string& file, const std::string& path, const nlohmann::json& found,
                         const std::string& expected) {
  throw inputError(fmt::format("{}: {} is {}, expected {}", file, path, describeJson(found), expected));
}

// The linear RGB of "#rrggbb", which is sRGB (IEC 61966-2-1); none where it is something else.
std::optional<glm::vec3> linearOf(const std::string& colour) {
  const auto isDigit = [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; };
  if (colour.size() != 7 || colour[0] != '#' || !std::all_of(colour.begin() + 1, colour.end(), isDigit))
    return {};
  glm::vec3 linear;
  for (int i = 0; i < 3; ++i) {
    const double s = std::stoi(colour.substr(1 + 2 * static_cast<size_t>(i), 2), nullptr, 16) / 255.0;
    linear[i] = static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
  }
  return linear;
}

// keysOf(fields, object) lists the keys of each object of a scene, once for both directions: a Reader sets
// the members, a Writer writes them. Bindings name all members, so that a new one does not compile until it
// is looked at here. checkKeys(object, where) refuses what no single key shows.

// One JSON object: reads its known keys, leaves defaults where a key is missing, and knows which key no one
// asked for.
class Reader {
 public:
  Reader(const nlohmann::json& json, const Source& source, std::string path)
      : json_(json), source_(source), path_(std::move(path)) {
    if (!json_.is_object()) {
      throw inputError(fmt::format("{}: {} is {}, expected an object", source_.file,
                                   path_.empty() ? "the scene" : path_, describeJson(json_)));
    }
  }

  void key(const char* key, float& value, double least, double most) {
    if (const auto* json = find(key)) value = static_cast<float>(number(*json, pathOf(key), least, most));
  }
  void key(const char* key, double& value, double least, double most) {
    if (const auto* json = find(key)) value = number(*json, pathOf(key), least, most);
  }
  template <typename Number>
  void key(const char* key, std::optional<Number>& value, double least, double most) {
    if (const auto* json = find(key)) value = static_cast<Number>(number(*json, pathOf(key), least, most));
  }
  template <typename Integer>
  void integer(const char* key, Integer& value, uint64_t least, uint64_t most) {
    if (const auto* json = find(key)) value = static_cast<Integer>(whole(*json, pathOf(key), least, most));
  }
  template <typename Integer>
  void integer(const char* key, std::optional<Integer>& value, uint64_t least, uint64_t most) {
    if (find(key)) integer(key, value.emplace(), least, most);
  }
  void key(const char* key, std::string& value) {
    const auto* json = find(key);
    if (!json) return;
    if (!json->is_string() || json->get_ref<const std::string&>().empty()) {
      fail(pathOf(key), *json, "a string that is not empty");
    }
    value = json->get<std::string>();
  }
  // A file's name, or `word`, which is none.
  void file(const char* key, std::string& value, std::string_view word) {
    this->key(key, value);
    if (value != word) value = (source_.folder / value).string();
  }
  void file(const char* key, std::filesystem::path& value) {
    std::string name;
    this->key(key, name);
    if (!name.empty()) value = source_.folder / name;
  }
  void key(const char* key, std::vector<std::string>& values) {
    const auto* json = find(key);
    if (!json) return;
    const bool strings = json->is_array() && std::all_of(json->begin(), json->end(),
                                                         [](const auto& item) { return item.is_string(); });
    if (!strings || json->size() > 64) fail(pathOf(key), *json, "an array of at most 64 strings");
    values = json->get<std::vector<std::string>>();
  }
  template <int Size>
  void key(const char* key, glm::vec<Size, float>& value, double limit) {
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
  template <int Size>
  void key(const char* key, std::optional<glm::vec<Size, float>>& value, double limit) {
    if (find(key)) this->key(key, value.emplace(), limit);
  }
  void key(const char* key, std::vector<float>& values, size_t mostValues, double least, double most) {
    const auto* json = find(key);
    if (!json) return;
    if (!json->is_array() || json->size() > mostValues)
      fail(pathOf(key), *json, fmt::format("an array of at most {} numbers", mostValues));
    values.clear();
    for (const nlohmann::json& item : *json) {
      const std::string path = fmt::format("{}[{}]", pathOf(key), values.size());
      values.push_back(static_cast<float>(number(item, path, least, most)));
    }
  }
  // Whole numbers from 0 on, at least one: a missing key means something else than none.
  void integers(const char* key, std::vector<uint32_t>& values, size_t mostValues, uint32_t most) {
    const auto* json = find(key);
    if (!json) return;
    if (!json->is_array() || json->empty() || json->size() > mostValues)
      fail(pathOf(key), *json, fmt::format("an array of 1 to {} whole numbers", mostValues));
    values.clear();
    for (const nlohmann::json& item : *json) {
      const std::string path = fmt::format("{}[{}]", pathOf(key), values.size());
      values.push_back(static_cast<uint32_t>(whole(item, path, 0, most)));
    }
  }
  // A number from 0 to 1, or "random", which is none, or "together", which is 0.
  void phase(const char* key, std::optional<float>& value) {
    const auto* json = find(key);
    if (!json || *json == "random") return;
    if (*json == "together")
      value = 0;
    else if (json->is_number())
      this->key(key, value, 0, 1);
    else
      failNamed(pathOf(key), *json, {"random", "together"});
  }
  // "#rrggbb" in sRGB, or linear RGB.
  void colour(const char* key, std::optional<glm::vec3>& value) {
    const auto* json = find(key);
    if (!json) return;
    if (json->is_string()) {
      value = linearOf(json->get<std::string>());
      if (!value) fail(pathOf(key), *json, "\"#rrggbb\"");
      return;
    }
    if (!json->is_array() || json->size() != 3)
      fail(pathOf(key), *json, "\"#rrggbb\" or an array of 3 numbers");
    value.emplace();
    for (int i = 0; i < 3; ++i)
      (*value)[i] = static_cast<float>(
          number((*json)[static_cast<size_t>(i)], fmt::format("{}[{}]", pathOf(key), i), 0, 1));
  }
  // The index of the key's string among `names`.
  template <typename Kind>
  void kind(const char* key, Kind& value, std::initializer_list<const char*> names) {
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
    failNamed(pathOf(key), *json, {names.begin(), names.end()});
  }
  template <typename Enum, size_t Count>
  void named(const char* key, Enum& value, const std::array<Enum, Count>& all) {
    const auto* json = find(key);
    if (!json) return;
    const auto named = json->is_string() ? enumNamed(all, json->get_ref<const std::string&>()) : std::nullopt;
    if (!named) {
      std::vector<std::string> names;
      for (const Enum each : all) names.emplace_back(nameOf(each));
      failNamed(pathOf(key), *json, names);
    }
    value = *named;
  }
  // checkTuning() checks the range.
  void key(const TuningInfo& info, Tuning& tuning) {
    const auto* json = find(info.name);
    if (!json) return;
    // A number that float cannot hold is outside every range.
    if (!json->is_number() || !isWithin(json->get<double>(), -1e30, 1e30))
      fail(pathOf(info.name), *json, rangeOf(info));
    tuning.*info.member = json->get<float>();
  }
  template <typename Object>
  void object(const char* key, Object& value) {
    if (const auto* json = find(key)) read(*json, pathOf(key), value);
  }
  template <typename Object>
  void object(const char* key, std::optional<Object>& value) {
    if (find(key)) object(key, value.emplace());
  }
  template <typename Object>
  void objects(const char* key, std::vector<Object>& values, size_t most, const char* what) {
    const auto* json = find(key);
    if (!json) return;
    if (!json->is_array() || json->size() > most)
      fail(pathOf(key), *json, fmt::format("an array of at most {} {}", most, what));
    values.clear();
    for (const nlohmann::json& item : *json) {
      const std::string path = fmt::format("{}[{}]", pathOf(key), values.size());
      read(item, path, values.emplace_back());
    }
  }

  // The alternative whose key is there: exactly one is. It may have more keys in this object.
  template <size_t Count, typename... Kinds>
  void oneOf(const char* const (&keys)[Count], std::variant<Kinds...>& value) {
    static_assert(Count == sizeof...(Kinds));
    size_t found = 0, index = 0;
    const auto readIf = [&]<typename Kind>(Kind made) {
      const char* key = keys[index++];
      if (!find(key)) return;
      ++found;
      keysOf(*this, key, made);
      value = std::move(made);
    };
    (readIf(Kinds{}), ...);
    if (found == 0) {
      // A misspelt key says more than a missing one. The keys of every alternative are known by then.
      index = 0;
      const auto know = [&]<typename Kind>(Kind none) { keysOf(*this, keys[index++], none); };
      (know(Kinds{}), ...);
      finish();
    }
    if (found != 1)
      throw inputError(fmt::format("{}: {} has {} of {}, expected one", source_.file, path_, found,
                                   fmt::join(keys, ", ")));
  }

  // Call last: every key must have been asked for.
  void finish() const {
    for (const auto& [key, value] : json_.items()) {
      if (known_.count(key) == 0) {
        const std::vector<std::string> known(known_.begin(), known_.end());
        throw inputError(fmt::format("{}: {} is no known key{}", source_.file, pathOf(describeKey(key)),
                                     base::expectedOneOf(key, known)));
      }
    }
  }

 private:
  template <typename Object>
  void read(const nlohmann::json& json, const std::string& path, Object& value) const;

  const nlohmann::json* find(const char* key) {
    known_.insert(key);
    const auto found = json_.find(key);
    return found == json_.end() ? nullptr : &*found;
  }
  std::string pathOf(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  [[noreturn]] void fail(const std::string& path, const nlohmann::json& found,
                         const std::string& expected) const {
    failIn(source_.file, path, found, expected);
  }
  // Where a string was expected that is one of `names`.
  [[noreturn]] void failNamed(const std::string& path, const nlohmann::json& found,
                              const std::vector<std::string>& names) const {
    const std::string word = found.is_string() ? found.get<std::string>() : "";
    throw inputError(fmt::format("{}: {} is {}{}", source_.file, path, describeJson(found),
                                 base::expectedOneOf(word, names, "\"")));
  }
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
  uint64_t whole(const nlohmann::json& json, const std::string& path, uint64_t least, uint64_t most) const {
    if (!json.is_number_unsigned() || json.get<uint64_t>() < least || json.get<uint64_t>() > most)
      fail(path, json, fmt::format("a whole number from {} to {}", least, most));
    return json.get<uint64_t>();
  }

  const nlohmann::json& json_;
  const Source& source_;
  std::string path_;
  std::set<std::string> known_;
};

// The other direction. What a Reader would not read is no less refused: a program may make any scene. Every
// key is written, so that a scene outlives a change of the defaults; but no empty string, which is what a
// missing key means.
class Writer {
 public:
  Writer(const std::string& file, std::string path) : file_(file), path_(std::move(path)) {}

  void key(const char* key, const float& value, double least, double most) {
    json_[key] = number(value, pathOf(key), least, most);
  }
  void key(const char* key, const double& value, double least, double most) {
    if (!isWithin(value, least, most)) failRange(pathOf(key), value, least, most);
    json_[key] = value;
  }
  template <typename Number>
  void key(const char* key, const std::optional<Number>& value, double least, double most) {
    if (value) this->key(key, *value, least, most);
  }
  template <typename Integer>
  void integer(const char* key, const Integer& value, uint64_t least, uint64_t most) {
    json_[key] = whole(static_cast<uint64_t>(value), pathOf(key), least, most);
  }
  template <typename Integer>
  void integer(const char* key, const std::optional<Integer>& value, uint64_t least, uint64_t most) {
    if (value) integer(key, *value, least, most);
  }
  void key(const char* key, const std::string& value) {
    if (!value.empty()) json_[key] = text(value, pathOf(key));
  }
  void file(const char* key, const std::string& value, std::string_view word) {
    this->key(key, value == word ? value : std::filesystem::absolute(value).lexically_normal().string());
  }
  void file(const char* key, const std::filesystem::path& value) { file(key, value.string(), ""); }
  void key(const char* key, const std::vector<std::string>& values) {
    nlohmann::ordered_json& array = json_[key] = nlohmann::ordered_json::array();
    for (const std::string& value : values)
      array.push_back(text(value, fmt::format("{}[{}]", pathOf(key), array.size())));
  }
  template <int Size>
  void key(const char* key, const glm::vec<Size, float>& value, double limit) {
    nlohmann::ordered_json& array = json_[key] = nlohmann::ordered_json::array();
    for (int i = 0; i < Size; ++i)
      array.push_back(number(value[i], fmt::format("{}[{}]", pathOf(key), i), -limit, limit));
  }
  template <int Size>
  void key(const char* key, const std::optional<glm::vec<Size, float>>& value, double limit) {
    if (value) this->key(key, *value, limit);
  }
  void key(const char* key, const std::vector<float>& values, size_t mostValues, double least, double most) {
    nlohmann::ordered_json& array = json_[key] = nlohmann::ordered_json::array();
    expectAtMost(mostValues, values.size(), key);
    for (const float value : values)
      array.push_back(number(value, fmt::format("{}[{}]", pathOf(key), array.size()), least, most));
  }
  void integers(const char* key, const std::vector<uint32_t>& values, size_t mostValues, uint32_t most) {
    if (values.empty()) return;
    nlohmann::ordered_json& array = json_[key] = nlohmann::ordered_json::array();
    expectAtMost(mostValues, values.size(), key);
    for (const uint32_t value : values)
      array.push_back(whole(value, fmt::format("{}[{}]", pathOf(key), array.size()), 0, most));
  }
  void phase(const char* key, const std::optional<float>& value) { this->key(key, value, 0, 1); }
  void colour(const char* key, const std::optional<glm::vec3>& value) {
    if (!value) return;
    nlohmann::ordered_json& array = json_[key] = nlohmann::ordered_json::array();
    for (int i = 0; i < 3; ++i)
      array.push_back(number((*value)[i], fmt::format("{}[{}]", pathOf(key), i), 0, 1));
  }
  template <typename Kind>
  void kind(const char* key, const Kind& value, std::initializer_list<const char*> names) {
    json_[key] = names.begin()[static_cast<size_t>(value)];
  }
  template <typename Enum, size_t Count>
  void named(const char* key, const Enum& value, const std::array<Enum, Count>&) {
    json_[key] = nameOf(value);
  }
  void key(const TuningInfo& info, const Tuning& tuning) {
    this->key(info.name, tuning.*info.member, info.least, info.most);
  }
  template <typename Object>
  void object(const char* key, Object& value) {
    json_[key] = written(pathOf(key), value);
  }
  template <typename Object>
  void object(const char* key, std::optional<Object>& value) {
    if (value) object(key, *value);
  }
  template <typename Object>
  void objects(const char* key, std::vector<Object>& values, size_t most, const char*) {
    nlohmann::ordered_json& array = json_[key] = nlohmann::ordered_json::array();
    expectAtMost(most, values.size(), key);
    for (Object& value : values)
      array.push_back(written(fmt::format("{}[{}]", pathOf(key), array.size()), value));
  }

  template <size_t Count, typename... Kinds>
  void oneOf(const char* const (&keys)[Count], std::variant<Kinds...>& value) {
    std::visit([&](auto& each) { keysOf(*this, keys[value.index()], each); }, value);
  }

  const nlohmann::ordered_json& json() const { return json_; }

 private:
  template <typename Object>
  nlohmann::ordered_json written(const std::string& path, Object& value) const;

  std::string pathOf(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  [[noreturn]] void failRange(const std::string& path, double found, double least, double most) const {
    throw inputError(
        fmt::format("{}: {} is {}, expected a number from {} to {}", file_, path, found, least, most));
  }
  void expectAtMost(size_t most, size_t found, const char* key) const {
    if (found > most)
      throw inputError(fmt::format("{}: {} are {}, expected at most {}", file_, pathOf(key), found, most));
  }
  uint64_t whole(uint64_t value, const std::string& path, uint64_t least, uint64_t most) const {
    if (value < least || value > most)
      failIn(file_, path, value, fmt::format("a whole number from {} to {}", least, most));
    return value;
  }
  // The shortest decimals that are read as this float.
  double number(float value, const std::string& path, double least, double most) const {
    if (!isWithin(value, least, most)) failRange(path, value, least, most);
    const double shortest = std::stod(fmt::format("{}", value));
    return static_cast<float>(shortest) == value ? shortest : value;
  }
  const std::string& text(const std::string& value, const std::string& path) const {
    try {
      nlohmann::json(value).dump();
    } catch (const nlohmann::json::exception&) {
      failIn(file_, path, value, "UTF-8, which is all that JSON can hold");
    }
    return value;
  }

  const std::string& file_;
  std::string path_;
  nlohmann::ordered_json json_ = nlohmann::ordered_json::object();
};

template <class Fields>
void keysOf(Fields& fields, TerrainNoise& noise) {
  auto& [columns, rows, spacing, amplitude, wavelength, octaves, gain, seed] = noise;
  fields.integer("columns", columns, minSamples, maxSamples);
  fields.integer("rows", rows, minSamples, maxSamples);
  fields.key("spacing", spacing, minSpacing, maxSpacing);
  fields.key("amplitude", amplitude, 0, Scene::maxCoordinate);
  fields.key("wavelength", wavelength, minSpacing, maxHeightMagnitude);
  fields.integer("octaves", octaves, 1, TerrainNoise::maxOctaves);
  fields.key("gain", gain, 0, 1);
  fields.integer("seed", seed, 0, UINT64_MAX);
}

template <class Fields>
void keysOf(Fields& fields, TerrainFile& terrain) {
  auto& [file, units] = terrain;
  auto& [spacingX, spacingZ, minHeight, maxHeight, scale, exaggeration, columns, rows, voidValue] = units;
  fields.file("file", file);
  fields.key("spacingX", spacingX, minSpacing, maxSpacing);
  fields.key("spacingZ", spacingZ, minSpacing, maxSpacing);
  fields.key("minHeight", minHeight, -maxHeightMagnitude, maxHeightMagnitude);
  fields.key("maxHeight", maxHeight, -maxHeightMagnitude, maxHeightMagnitude);
  fields.key("scale", scale, minScale, maxScale);
  fields.key("exaggeration", exaggeration, 0, maxExaggeration);
  fields.key("voidValue", voidValue, -maxVoidValue, maxVoidValue);
  fields.integer("columns", columns, minSamples, maxSamples);
  fields.integer("rows", rows, minSamples, maxSamples);
}

template <class Fields>
void keysOf(Fields& fields, decltype(Scene::terrain)& terrain) {
  size_t kind = terrain.index();
  fields.kind("kind", kind, {"noise", "file"});
  if (kind != terrain.index()) terrain = TerrainFile{};
  std::visit([&](auto& each) { keysOf(fields, each); }, terrain);
}
void checkKeys(const decltype(Scene::terrain)& terrain, const std::string& file, const std::string& path) {
  const auto* named = std::get_if<TerrainFile>(&terrain);
  if (named && named->file.empty())
    throw inputError(fmt::format("{}: {}.file is missing, kind \"file\" needs it", file, path));
}

template <class Fields>
void keysOf(Fields& fields, ClipCut& cut) {
  auto& [clip, name, from, to] = cut;
  fields.key("clip", clip);
  fields.key("name", name);
  fields.key("from", from, 0, Clip::maxSeconds);
  fields.key("to", to, 0, Clip::maxSeconds);
}
void checkKeys(const ClipCut& cut, const std::string& file, const std::string& path) {
  if (cut.name.empty()) throw inputError(fmt::format("{}: {}.name is missing", file, path));
  if (!(cut.from < cut.to))
    throw inputError(
        fmt::format("{}: {}.to is {}, expected more than from, {}", file, path, cut.to, cut.from));
}

template <class Fields>
void keysOf(Fields& fields, Tuning& tuning) {
  for (const TuningInfo& info : allTunings) fields.key(info, tuning);
}
void checkKeys(const Tuning& tuning, const std::string& file, const std::string& path) {
  checkTuning(tuning, fmt::format("{}: {}", file, path));
}

template <class Fields>
void keysOf(Fields& fields, Spawn& spawn) {
  auto& [kind, spacing, centre, heading] = spawn;
  fields.kind("kind", kind, {"lanes", "grid"});
  fields.key("spacing", spacing, 0.01, Scene::maxCoordinate);
  fields.key("centre", centre, Scene::maxCoordinate);
  fields.key("heading", heading, -1000, 1000);
}

template <class Fields>
void keysOf(Fields& fields, Goal& goal) {
  auto& [kind, target, speed, velocity] = goal;
  fields.kind("kind", kind, {"cross", "point", "none", "velocity"});
  fields.key("target", target, Scene::maxCoordinate);
  fields.key("speed", speed, 0, double{Goal::maxSpeed});
  fields.key("velocity", velocity, double{Goal::maxSpeed});
}
void checkKeys(const Goal& goal, const std::string& file, const std::string& path) {
  if (glm::length(goal.velocity) > Goal::maxSpeed)
    throw inputError(fmt::format("{}: {}.velocity is {:.6g} m/s long, expected at most {:.6g}", file, path,
                                 glm::length(goal.velocity), Goal::maxSpeed));
}

template <class Fields>
void keysOf(Fields& fields, Herd& herd) {
  auto& [rig, controller, clips, cuts, keys, solver, stepping, tuning, agents, reserve, spawn, goal, sizes,
         phase, colour, tint] = herd;
  fields.file("rig", rig, "spider");
  fields.named("controller", controller, allControllers);
  fields.key("clips", clips);
  fields.objects("cuts", cuts, maxCuts, "objects");
  fields.integer("keys", keys, Herd::minKeys, Herd::maxKeys);
  fields.named("solver", solver, herdSolvers);
  fields.named("stepping", stepping, allSteppings);
  fields.object("tuning", tuning);
  fields.integer("agents", agents, 0, Scene::maxAgents);
  fields.integer("reserve", reserve, 0, Scene::maxAgents);
  fields.object("spawn", spawn);
  fields.object("goal", goal);
  fields.key("sizes", sizes, Herd::maxSizes, Herd::minSize, Herd::maxSize);
  fields.phase("phase", phase);
  fields.colour("colour", colour);
  fields.key("tint", tint, 0, 1);
}

template <class Fields>
void keysOf(Fields& fields, CameraKey& key) {
  auto& [time, position, target] = key;
  fields.key("time", time, 0, Camera::maxPathTime);
  fields.key("position", position, cameraLimit);
  fields.key("target", target, cameraLimit);
}
void checkKeys(const CameraKey& key, const std::string& file, const std::string& path) {
  if (key.position == key.target)
    throw inputError(
        fmt::format("{}: {}.position equals {}.target, a camera needs a direction", file, path, path));
}

template <class Fields>
void keysOf(Fields& fields, Camera& camera) {
  auto& [kind, position, target, distance, fieldOfView, about, elevation, azimuth, secondsATurn, keys] =
      camera;
  fields.kind("kind", kind, {"follow", "fixed", "orbit", "path"});
  fields.key("position", position, cameraLimit);
  fields.key("target", target, cameraLimit);
  fields.key("distance", distance, 0.01, cameraLimit);
  fields.key("fieldOfView", fieldOfView, 0.01, 3.1);
  fields.key("about", about, cameraLimit);
  fields.key("elevation", elevation, -1.5, 1.5);
  fields.key("azimuth", azimuth, -1000, 1000);
  fields.key("secondsATurn", secondsATurn, -Camera::maxPathTime, Camera::maxPathTime);
  fields.objects("keys", keys, Camera::maxPathKeys, "objects");
}
void checkKeys(const Camera& camera, const std::string& file, const std::string& path) {
  if (camera.kind == Camera::Kind::fixed && camera.position == camera.target)
    throw inputError(
        fmt::format("{}: {}.position equals {}.target, a fixed camera needs a direction", file, path, path));
  if (camera.kind == Camera::Kind::path && camera.keys.size() < Camera::minPathKeys)
    throw inputError(fmt::format("{}: {}.keys has {}, expected at least {} for a path", file, path,
                                 camera.keys.size(), Camera::minPathKeys));
  for (size_t k = 1; k < camera.keys.size(); ++k) {
    const float least = camera.keys[k - 1].time + Camera::minPathStep;
    if (camera.keys[k].time < least)
      throw inputError(
          fmt::format("{}: {}.keys[{}].time is {}, expected at least {}, {} s after the key before", file,
                      path, k, camera.keys[k].time, least, Camera::minPathStep));
  }
}

template <class Fields>
void keysOf(Fields& fields, Mound& mound) {
  auto& [centre, radius, height] = mound;
  fields.key("centre", centre, Scene::maxCoordinate);
  fields.key("radius", radius, 0.01, Scene::maxCoordinate);
  fields.key("height", height, -maxHeightMagnitude, maxHeightMagnitude);
}

template <class Fields>
void keysOf(Fields& fields, HeightSamples& samples) {
  auto& [x, z, columns, rows, heights] = samples;
  fields.integer("x", x, 0, maxSamples - 1);
  fields.integer("z", z, 0, maxSamples - 1);
  fields.integer("columns", columns, 1, maxSamples);
  fields.integer("rows", rows, 1, maxSamples);
  fields.key("heights", heights, Event::maxSamples, -maxHeightMagnitude, maxHeightMagnitude);
}
void checkKeys(const HeightSamples& samples, const std::string& file, const std::string& path) {
  const uint64_t expected = uint64_t{samples.columns} * samples.rows;
  if (samples.heights.size() != expected)
    throw inputError(fmt::format("{}: {}.heights has {} numbers, expected {}, columns times rows", file, path,
                                 samples.heights.size(), expected));
}

template <class Fields>
void keysOf(Fields& fields, Place& place) {
  auto& [position, heading] = place;
  fields.key("position", position, Scene::maxCoordinate);
  fields.key("heading", heading, -1000, 1000);
}

template <class Fields>
void keysOf(Fields& fields, Teleport::Move& move) {
  auto& [agent, place] = move;
  fields.integer("agent", agent, 0, Scene::maxAgents - 1);
  keysOf(fields, place);
}
void checkKeys(const Teleport::Move& move, const std::string& file, const std::string& path) {
  if (move.agent == Teleport::Move{}.agent)
    throw inputError(fmt::format("{}: {}.agent is missing", file, path));
}

template <class Fields>
void keysOf(Fields& fields, Addition::Arrival& arrival) {
  auto& [place, goal] = arrival;
  keysOf(fields, place);
  fields.object("goal", goal);
}

// The keys of what an event does, of which `key` says that it does that.
template <class Fields>
void keysOf(Fields& fields, const char* key, Mound& mound) {
  fields.object(key, mound);
}
template <class Fields>
void keysOf(Fields& fields, const char* key, HeightSamples& samples) {
  fields.object(key, samples);
}
template <class Fields>
void keysOf(Fields& fields, const char* key, GoalChange& change) {
  auto& [herd, agents, goal] = change;
  fields.integer("herd", herd, 0, Scene::maxHerds - 1);
  fields.integers("agents", agents, Event::maxAgents, Scene::maxAgents - 1);
  fields.object(key, goal);
}
template <class Fields>
void keysOf(Fields& fields, const char* key, SpeedChange& change) {
  auto& [herd, agents, speed] = change;
  fields.integer("herd", herd, 0, Scene::maxHerds - 1);
  fields.integers("agents", agents, Event::maxAgents, Scene::maxAgents - 1);
  fields.key(key, speed, 0, double{Goal::maxSpeed});
}
template <class Fields>
void keysOf(Fields& fields, const char* key, Teleport& teleport) {
  auto& [herd, moves] = teleport;
  fields.integer("herd", herd, 0, Scene::maxHerds - 1);
  fields.objects(key, moves, Event::maxAgents, "agents");
}
template <class Fields>
void keysOf(Fields& fields, const char* key, Addition& addition) {
  auto& [herd, arrivals] = addition;
  fields.integer("herd", herd, 0, Scene::maxHerds - 1);
  fields.objects(key, arrivals, Event::maxAgents, "agents");
}
template <class Fields>
void keysOf(Fields& fields, const char* key, Removal& removal) {
  auto& [herd, agents] = removal;
  fields.integer("herd", herd, 0, Scene::maxHerds - 1);
  fields.integers(key, agents, Event::maxAgents, Scene::maxAgents - 1);
}

template <class Fields>
void keysOf(Fields& fields, Event& event) {
  auto& [at, what] = event;
  fields.key("at", at, 0, Event::maxTime);
  fields.oneOf({"mound", "edit", "goal", "speed", "teleport", "add", "remove"}, what);
}
void checkKeys(const Event& event, const std::string& file, const std::string& path) {
  const auto expectSome = [&](const char* key, const auto& list) {
    if (list.empty())
      throw inputError(fmt::format("{}: {}.{} is empty, expected at least one agent", file, path, key));
  };
  if (const auto* teleport = std::get_if<Teleport>(&event.what)) expectSome("teleport", teleport->moves);
  if (const auto* addition = std::get_if<Addition>(&event.what)) expectSome("add", addition->arrivals);
  if (const auto* removal = std::get_if<Removal>(&event.what)) expectSome("remove", removal->agents);
}

template <class Fields>
void keysOf(Fields& fields, Scene& scene) {
  auto& [name, terrain, herds, camera, events, seed] = scene;
  fields.key("name", name);
  fields.integer("seed", seed, 0, UINT64_MAX);
  fields.object("terrain", terrain);
  fields.objects("herds", herds, Scene::maxHerds, "herds");
  fields.object("camera", camera);
  fields.objects("events", events, Scene::maxEvents, "events");
}
void checkKeys(const Scene& scene, const std::string& file, const std::string&) {
  for (size_t e = 1; e < scene.events.size(); ++e)
    if (scene.events[e].at < scene.events[e - 1].at)
      throw inputError(fmt::format("{}: events[{}].at is {}, expected {} or later, as the event before it",
                                   file, e, scene.events[e].at, scene.events[e - 1].at));
  if (scene.capacity() > Scene::maxAgents)
    throw inputError(fmt::format("{}: herds have {} agents in all, expected at most {}", file,
                                 scene.capacity(), Scene::maxAgents));
}

template <class Object>
void checkKeys(const Object&, const std::string&, const std::string&) {}

template <typename Object>
void Reader::read(const nlohmann::json& json, const std::string& path, Object& value) const {
  Reader fields(json, source_, path);
  keysOf(fields, value);
  fields.finish();
  checkKeys(value, source_.file, path);
}

template <typename Object>
nlohmann::ordered_json Writer::written(const std::string& path, Object& value) const {
  Writer fields(file_, path);
  keysOf(fields, value);
  checkKeys(value, file_, path);
  return fields.json();
}

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

uint64_t Scene::capacity() const {
  uint64_t count = agentCount();
  for (const Herd& herd : herds) count += herd.reserve;
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
  const Source source{name, folder};
  const nlohmann::json object = parseJson(json, name, true);
  Scene scene;
  scene.name = std::filesystem::path(name).stem().string();
  Reader fields(object, source, "");
  keysOf(fields, scene);
  fields.finish();
  checkKeys(scene, name, "");
  return scene;
}

std::string sceneJson(const Scene& scene) {
  const std::string name = scene.name.empty() ? "the scene" : scene.name;
  Scene copy = scene;  // a list of keys is for both directions, so it cannot take what is const
  Writer fields(name, "");
  keysOf(fields, copy);
  checkKeys(scene, name, "");
  return fields.json().dump(2) + "\n";
}

}  // namespace skitter
