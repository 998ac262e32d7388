#include "skitter/rig_gaits.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "assets/files/file.h"
#include "assets/files/json.h"
#include "base/spelling.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr int gaitsVersion = 1;
// On fewer legs a creature lies on its belly, and has no gait.
constexpr int fewestWithGait = 3;
constexpr const char *waitAll = "all", *waitAdjacent = "adjacent";

std::vector<std::string> namesOfLegs(const Rig& rig) {
  std::vector<std::string> names;
  for (const Leg& leg : rig.legs) names.push_back(leg.name);
  return names;
}

class GaitReader {
 public:
  GaitReader(const std::string& name, const Rig& rig) : name_(name), rig_(rig), legs_(namesOfLegs(rig)) {}

  std::vector<RigGait> read(const nlohmann::json& json) const {
    checkKeys(json, "", {"version", "legs", "gaits", "found"});
    const nlohmann::json& version = member(json, "version", "");
    if (version != gaitsVersion) fail("version", version, fmt::format("{}", gaitsVersion));
    const nlohmann::json& legs = member(json, "legs", "");
    if (legs != nlohmann::json(legs_))
      fail("legs", legs, fmt::format("{}, the rig's", describeJson(nlohmann::json(legs_))));
    const nlohmann::json& gaits = member(json, "gaits", "");
    if (!gaits.is_array()) fail("gaits", gaits, "an array");
    std::vector<RigGait> made;
    std::set<uint32_t> known;
    for (size_t i = 0; i < gaits.size(); ++i) {
      const std::string path = fmt::format("gaits[{}]", i);
      made.push_back(gait(gaits[i], path));
      if (!known.insert(made.back().idle).second)
        fail(path + ".without", gaits[i]["without"], "legs that no gait before is without");
    }
    return made;
  }

 private:
  [[noreturn]] void fail(const std::string& path, const nlohmann::json& found,
                         const std::string& expected) const {
    throw inputError(fmt::format("{}: {} is {}, expected {}", name_, path, describeJson(found), expected));
  }

  void checkKeys(const nlohmann::json& json, const std::string& path,
                 const std::vector<std::string>& keys) const {
    if (!json.is_object()) fail(path.empty() ? "the file" : path, json, "an object");
    for (const auto& [key, value] : json.items())
      if (std::ranges::find(keys, key) == keys.end())
        throw inputError(fmt::format("{}: {}{}{} is no known key{}", name_, path, path.empty() ? "" : ".",
                                     key, base::expectedOneOf(key, keys)));
  }

  const nlohmann::json& member(const nlohmann::json& json, const char* key, const std::string& path) const {
    const auto found = json.find(key);
    if (found == json.end())
      throw inputError(fmt::format("{}: {}{}{} is missing", name_, path, path.empty() ? "" : ".", key));
    return *found;
  }

  float number(const nlohmann::json& json, const std::string& path, double least, double most) const {
    const double value = json.is_number() ? json.get<double>() : NAN;
    if (!(value >= least && value <= most)) fail(path, json, fmt::format("{:g} to {:g}", least, most));
    return static_cast<float>(value);
  }

  size_t legNamed(const nlohmann::json& json, const std::string& path) const {
    const auto leg = json.is_string() ? std::ranges::find(legs_, json.get<std::string>()) : legs_.end();
    if (leg == legs_.end())
      fail(path, json, fmt::format("a leg of the rig, as {}", describeJson(nlohmann::json(legs_))));
    return static_cast<size_t>(leg - legs_.begin());
  }

  uint32_t without(const nlohmann::json& json, const std::string& path) const {
    if (!json.is_array() || json.empty()) fail(path, json, "an array of one leg or more");
    uint32_t idle = 0;
    for (size_t i = 0; i < json.size(); ++i) {
      const std::string at = fmt::format("{}[{}]", path, i);
      const uint32_t bit = 1u << legNamed(json[i], at);
      if ((idle & bit) != 0) fail(at, json[i], "no leg twice");
      idle |= bit;
    }
    if (rig_.legCount() - std::popcount(idle) < fewestWithGait)
      fail(path, json, fmt::format("at least {} legs that carry", fewestWithGait));
    return idle;
  }

  std::vector<RigGait::Turn> turns(const nlohmann::json& json, const std::string& path, uint32_t idle) const {
    if (!json.is_object()) fail(path, json, "an object");
    std::vector<RigGait::Turn> turns(legs_.size());
    uint32_t carries = 0;
    for (const auto& [key, value] : json.items()) {
      const std::string at = fmt::format("{}.{}", path, key);
      const size_t leg = legNamed(nlohmann::json(key), at);
      if ((idle >> leg & 1u) != 0) fail(at, value, "no leg that the gait is without");
      if (!value.is_array() || value.size() != 2) fail(at, value, "[phase, slowness]");
      turns[leg] = {number(value[0], at + "[0]", 0, 1),
                    number(value[1], at + "[1]", double{RigGait::minSlowness}, double{RigGait::maxSlowness})};
      if (!(turns[leg].phase < 1)) fail(at + "[0]", value[0], "less than 1");
      carries |= 1u << leg;
    }
    for (size_t leg = 0; leg < legs_.size(); ++leg)
      if (((carries | idle) >> leg & 1u) == 0)
        throw inputError(fmt::format("{}: {}.{} is missing", name_, path, legs_[leg]));
    return turns;
  }

  RigGait gait(const nlohmann::json& json, const std::string& path) const {
    checkKeys(json, path, {"without", "groups", "wait", "shift", "speed", "fitness", "turns"});
    const auto at = [&](const char* key) -> const nlohmann::json& { return member(json, key, path); };
    const auto named = [&](const char* key) { return fmt::format("{}.{}", path, key); };
    RigGait made;
    made.idle = without(at("without"), named("without"));
    const nlohmann::json& groups = at("groups");
    number(groups, named("groups"), 1, RigGait::maxGroups);
    if (!groups.is_number_integer()) fail(named("groups"), groups, "a whole number");
    made.groups = groups.get<uint32_t>();
    const nlohmann::json& wait = at("wait");
    if (wait != waitAll && wait != waitAdjacent)
      fail(named("wait"), wait, fmt::format("{} or {}", waitAll, waitAdjacent));
    made.adjacent = wait == waitAdjacent;
    const nlohmann::json& shift = at("shift");
    if (!shift.is_array() || shift.size() != 3) fail(named("shift"), shift, "[x, y, z]");
    for (int i = 0; i < 3; ++i)
      made.shift[i] = number(shift[static_cast<size_t>(i)], fmt::format("{}[{}]", named("shift"), i),
                             -double{RigGait::maxShift}, double{RigGait::maxShift});
    made.speed = number(at("speed"), named("speed"), 0.01, 1);
    if (json.contains("fitness")) made.fitness = number(json["fitness"], named("fitness"), 0, 1);
    made.turns = turns(at("turns"), named("turns"), made.idle);
    return made;
  }

  const std::string& name_;
  const Rig& rig_;
  std::vector<std::string> legs_;
};

// As few digits as are read back as the same float.
nlohmann::ordered_json jsonNumber(float value) { return std::stod(fmt::format("{}", value)); }

}  // namespace

std::vector<RigGait> parseGaits(const std::string& json, const std::string& name, const Rig& rig) {
  return GaitReader(name, rig).read(parseJson(json, name));
}

std::vector<RigGait> loadGaits(const std::filesystem::path& file, const Rig& rig) {
  const std::vector<uint8_t> bytes = readFile(file);
  return parseGaits(std::string(bytes.begin(), bytes.end()), file.string(), rig);
}

std::string writeGaits(const Rig& rig, std::span<const RigGait> gaits, const std::string& found) {
  const std::vector<std::string> legs = namesOfLegs(rig);
  // A gait a line, so that tables can be compared line by line.
  std::string text =
      fmt::format("{{\n\"version\": {},\n\"legs\": {},\n", gaitsVersion, nlohmann::ordered_json(legs).dump());
  if (!found.empty()) text += fmt::format("\"found\": {},\n", nlohmann::ordered_json::parse(found).dump());
  text += "\"gaits\": [";
  for (size_t i = 0; i < gaits.size(); ++i) {
    const RigGait& gait = gaits[i];
    if (gait.turns.size() != legs.size())
      throw inputError(fmt::format("gait {}: has {} turns, expected {}, one per leg of the rig", i,
                                   gait.turns.size(), legs.size()));
    nlohmann::ordered_json json;
    json["without"] = nlohmann::ordered_json::array();
    nlohmann::ordered_json turns = nlohmann::ordered_json::object();
    for (size_t leg = 0; leg < legs.size(); ++leg) {
      if ((gait.idle >> leg & 1u) != 0)
        json["without"].push_back(legs[leg]);
      else
        turns[legs[leg]] = {jsonNumber(gait.turns[leg].phase), jsonNumber(gait.turns[leg].slowness)};
    }
    json["groups"] = gait.groups;
    json["wait"] = gait.adjacent ? waitAdjacent : waitAll;
    json["shift"] = {jsonNumber(gait.shift.x), jsonNumber(gait.shift.y), jsonNumber(gait.shift.z)};
    json["speed"] = jsonNumber(gait.speed);
    json["fitness"] = jsonNumber(gait.fitness);
    json["turns"] = turns;
    text += fmt::format("{}\n{}", i > 0 ? "," : "", json.dump());
  }
  text += "\n]\n}\n";
  parseGaits(text, "gaits", rig);  // what is written can be read
  return text;
}

std::filesystem::path gaitsOf(const std::filesystem::path& rig) {
  constexpr std::string_view sidecar = ".rig.json";
  std::string name = rig.filename().string();
  if (name.ends_with(sidecar))
    name.resize(name.size() - sidecar.size());
  else
    name = rig.stem().string();
  return rig.parent_path() / (name + ".gaits.json");
}

}  // namespace skitter
