#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "assets/files/json.h"
#include "assets/scenes/scene_source.h"
#include "skitter/error.h"
#include "skitter/scene.h"

namespace skitter::scenes {

// The JSON of an object, checked; defined beside the lists of keys (scene.cpp).
template <typename Object>
nlohmann::ordered_json writtenObject(const std::string& file, const std::string& path, Object& value);

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
  void key(const char* key, const bool& value) { json_[key] = value; }
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
  template <size_t Count>
  void key(const char* key, const std::array<float, Count>& values, double least, double most) {
    nlohmann::ordered_json& array = json_[key] = nlohmann::ordered_json::array();
    for (const float value : values)
      array.push_back(number(value, fmt::format("{}[{}]", pathOf(key), array.size()), least, most));
  }
  template <size_t Count>
  void integers(const char* key, const std::array<uint32_t, Count>& values, uint32_t most) {
    nlohmann::ordered_json& array = json_[key] = nlohmann::ordered_json::array();
    for (const uint32_t value : values)
      array.push_back(whole(value, fmt::format("{}[{}]", pathOf(key), array.size()), 0, most));
  }
  void places(const char* key, const std::vector<glm::vec2>& values, size_t mostValues, double limit) {
    nlohmann::ordered_json& array = json_[key] = nlohmann::ordered_json::array();
    expectAtMost(mostValues, values.size(), key);
    for (const glm::vec2& value : values) {
      const std::string path = fmt::format("{}[{}]", pathOf(key), array.size());
      const auto coordinate = [&](int i) {
        return number(value[i], fmt::format("{}[{}]", path, i), -limit, limit);
      };
      array.push_back(nlohmann::ordered_json::array({coordinate(0), coordinate(1)}));
    }
  }
  void integers(const char* key, const std::vector<uint32_t>& values, size_t mostValues, uint32_t most) {
    if (values.empty()) return;
    nlohmann::ordered_json& array = json_[key] = nlohmann::ordered_json::array();
    expectAtMost(mostValues, values.size(), key);
    for (const uint32_t value : values)
      array.push_back(whole(value, fmt::format("{}[{}]", pathOf(key), array.size()), 0, most));
  }
  // A missing key means false, so a scene without it stays as it was.
  void flag(const char* key, const bool& value) {
    if (value) json_[key] = true;
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
    json_[key] = writtenObject(file_, pathOf(key), value);
  }
  template <typename Object>
  void object(const char* key, std::optional<Object>& value) {
    if (value) object(key, *value);
  }
  // A missing key means the default, so a scene without it stays as it was.
  template <typename Object, typename Enum, size_t Count>
  void nameOrObject(const char* key, Object& value, Enum Object::*, const std::array<Enum, Count>&) {
    if (!(value == Object{})) object(key, value);
  }
  template <typename Object>
  void objects(const char* key, std::vector<Object>& values, size_t most, const char*) {
    nlohmann::ordered_json& array = json_[key] = nlohmann::ordered_json::array();
    expectAtMost(most, values.size(), key);
    for (Object& value : values)
      array.push_back(writtenObject(file_, fmt::format("{}[{}]", pathOf(key), array.size()), value));
  }

  template <size_t Count, typename... Kinds>
  void oneOf(const char* const (&keys)[Count], std::variant<Kinds...>& value) {
    std::visit([&](auto& each) { keysOf(*this, keys[value.index()], each); }, value);
  }

  const nlohmann::ordered_json& json() const { return json_; }

 private:
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

}  // namespace skitter::scenes
