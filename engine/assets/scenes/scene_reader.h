#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "assets/files/json.h"
#include "assets/scenes/scene_source.h"
#include "base/spelling.h"
#include "skitter/error.h"
#include "skitter/scene.h"

namespace skitter::scenes {

// The linear RGB of "#rrggbb", which is sRGB (IEC 61966-2-1); none where it is something else.
inline std::optional<glm::vec3> linearOf(const std::string& colour) {
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

// Reads an object with its keys, and checks it; defined beside the lists of keys (scene.cpp).
template <typename Object>
void readObject(const nlohmann::json& json, const Source& source, const std::string& path, Object& value);

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
  void key(const char* key, bool& value) {
    const auto* json = find(key);
    if (!json) return;
    if (!json->is_boolean()) fail(pathOf(key), *json, "true or false");
    value = json->get<bool>();
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
  template <size_t Count>
  void key(const char* key, std::array<float, Count>& values, double least, double most) {
    const auto* json = find(key);
    if (!json) return;
    if (!json->is_array() || json->size() != Count)
      fail(pathOf(key), *json, fmt::format("an array of {} numbers", Count));
    for (size_t i = 0; i < Count; ++i)
      values[i] = static_cast<float>(number((*json)[i], fmt::format("{}[{}]", pathOf(key), i), least, most));
  }
  template <size_t Count>
  void integers(const char* key, std::array<uint32_t, Count>& values, uint32_t most) {
    const auto* json = find(key);
    if (!json) return;
    if (!json->is_array() || json->size() != Count)
      fail(pathOf(key), *json, fmt::format("an array of {} whole numbers", Count));
    for (size_t i = 0; i < Count; ++i)
      values[i] = static_cast<uint32_t>(whole((*json)[i], fmt::format("{}[{}]", pathOf(key), i), 0, most));
  }
  // x, z of each.
  void places(const char* key, std::vector<glm::vec2>& values, size_t mostValues, double limit) {
    const auto* json = find(key);
    if (!json) return;
    if (!json->is_array() || json->size() > mostValues)
      fail(pathOf(key), *json, fmt::format("an array of at most {} places", mostValues));
    values.clear();
    for (const nlohmann::json& item : *json) {
      const std::string path = fmt::format("{}[{}]", pathOf(key), values.size());
      if (!item.is_array() || item.size() != 2) fail(path, item, "an array of 2 numbers");
      const auto coordinate = [&](size_t i) {
        return static_cast<float>(number(item[i], fmt::format("{}[{}]", path, i), -limit, limit));
      };
      values.emplace_back(coordinate(0), coordinate(1));
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
  void flag(const char* key, bool& value) {
    const auto* json = find(key);
    if (!json) return;
    if (!json->is_boolean()) fail(pathOf(key), *json, "true or false");
    value = json->get<bool>();
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
    if (const auto* json = find(key)) readObject(*json, source_, pathOf(key), value);
  }
  template <typename Object>
  void object(const char* key, std::optional<Object>& value) {
    if (find(key)) object(key, value.emplace());
  }
  // An object, or the name of one that has but its `choice`.
  template <typename Object, typename Enum, size_t Count>
  void nameOrObject(const char* key, Object& value, Enum Object::*choice,
                    const std::array<Enum, Count>& all) {
    const auto* json = find(key);
    if (!json) return;
    if (!json->is_string()) return object(key, value);
    value = {};
    named(key, value.*choice, all);
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
      readObject(item, source_, path, values.emplace_back());
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

}  // namespace skitter::scenes
