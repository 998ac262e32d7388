#include "assets/rigs/rig_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "assets/files/file.h"
#include "assets/files/json.h"
#include "base/spelling.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr double maxNumber = 1e9;
constexpr const char* axisNames[] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};

glm::dvec3 axisOf(size_t index) {
  glm::dvec3 axis(0);
  axis[static_cast<int>(index / 2)] = index % 2 == 0 ? 1 : -1;
  return axis;
}

class SetupReader {
 public:
  explicit SetupReader(const std::string& name) : name_(name) {}

  RigSetup read(const nlohmann::json& json, const std::string& path, bool sidecar) const {
    RigSetup setup;
    if (sidecar) {
      checkKeys(json, path,
                {"model", "scale", "legLength", "forward", "up", "origin", "bodyHeight", "bodyRadius",
                 "colour", "groups", "legs", "follow"});
      setup.model = text(member(json, "model", path), join(path, "model"));
      if (json.contains("scale") && json.contains("legLength")) {
        throw inputError(fmt::format("{}: scale and legLength both size the creature, expected one", name_));
      }
      read(json, path, "scale", setup.scale);
      read(json, path, "legLength", setup.legLength);
      if (const auto* up = find(json, "up")) setup.up = direction(*up, join(path, "up"));
      if (const auto* forward = find(json, "forward")) {
        setup.forward = direction(*forward, join(path, "forward"));
      }
      if (glm::length(glm::cross(setup.up, setup.forward)) < 0.1) {
        throw inputError(fmt::format("{}: forward is along up, expected it across", name_));
      }
      if (const auto* origin = find(json, "origin")) setup.origin = vector(*origin, join(path, "origin"));
      if (const auto* colour = find(json, "colour")) {
        setup.colour = vector(*colour, join(path, "colour"));
        if (glm::any(glm::lessThan(setup.colour, glm::dvec3(0))))
          fail(join(path, "colour"), *colour, "no less than 0");
      }
    } else {
      checkKeys(json, path, {"groups", "legs", "bodyHeight", "bodyRadius", "follow"});
      for (const char* key : {"bodyHeight", "bodyRadius"}) member(json, key, path);
    }
    for (const auto& group : array(json, "groups", path, 1, Rig::maxLegs)) {
      setup.groups.push_back(text(group, fmt::format("{}[{}]", join(path, "groups"), setup.groups.size())));
      if (std::count(setup.groups.begin(), setup.groups.end(), setup.groups.back()) > 1) {
        throw inputError(
            fmt::format("{}: {} names \"{}\" twice", name_, join(path, "groups"), setup.groups.back()));
      }
    }
    read(json, path, "bodyHeight", setup.bodyHeight);
    read(json, path, "bodyRadius", setup.bodyRadius);
    for (const auto& leg : array(json, "legs", path, 1, Rig::maxLegs)) {
      readLeg(leg, fmt::format("{}[{}]", join(path, "legs"), setup.legs.size()), setup);
    }
    readFollowers(json, path, setup);
    for (const std::string& group : setup.groups) {
      const auto inGroup = [&](const RigSetup::Leg& leg) { return leg.group == group; };
      if (std::none_of(setup.legs.begin(), setup.legs.end(), inGroup)) {
        throw inputError(fmt::format("{}: no leg is in group \"{}\"", name_, group));
      }
    }
    return setup;
  }

 private:
  static std::string join(const std::string& path, const char* key) {
    return path.empty() ? key : path + "." + key;
  }

  [[noreturn]] void fail(const std::string& path, const nlohmann::json& found,
                         const std::string& expected) const {
    throw inputError(fmt::format("{}: {} is {}, expected {}", name_, path, describeJson(found), expected));
  }

  void checkKeys(const nlohmann::json& json, const std::string& path,
                 std::initializer_list<const char*> keys) const {
    const std::string what = path.empty() ? "the sidecar" : path;
    if (!json.is_object()) fail(what, json, "an object");
    for (const auto& [key, value] : json.items()) {
      const auto same = [&k = key](const char* known) { return k == known; };
      if (std::none_of(keys.begin(), keys.end(), same)) {
        throw inputError(
            fmt::format("{}: {} has the unknown key {}{}", name_, what, describeJson(key),
                        base::expectedOneOf(key, std::vector<std::string>(keys.begin(), keys.end()))));
      }
    }
  }

  static const nlohmann::json* find(const nlohmann::json& json, const char* key) {
    const auto found = json.find(key);
    return found == json.end() ? nullptr : &*found;
  }

  const nlohmann::json& member(const nlohmann::json& json, const char* key, const std::string& path) const {
    const auto* found = find(json, key);
    if (!found) throw inputError(fmt::format("{}: {} is missing", name_, join(path, key)));
    return *found;
  }

  const nlohmann::json& array(const nlohmann::json& json, const char* key, const std::string& path,
                              size_t least, size_t most) const {
    const nlohmann::json& list = member(json, key, path);
    if (!list.is_array() || list.size() < least || list.size() > most) {
      fail(join(path, key), list, fmt::format("an array of {} to {}", least, most));
    }
    return list;
  }

  void read(const nlohmann::json& json, const std::string& path, const char* key,
            std::optional<double>& value) const {
    const auto* found = find(json, key);
    if (!found) return;
    if (!found->is_number() || !(found->get<double>() > 0) || found->get<double>() > maxNumber) {
      fail(join(path, key), *found, fmt::format("a number over 0 and up to {}", maxNumber));
    }
    value = found->get<double>();
  }

  glm::dvec3 vector(const nlohmann::json& json, const std::string& path) const {
    if (!json.is_array() || json.size() != 3) fail(path, json, "an array of 3 numbers");
    glm::dvec3 value(0);
    for (int k = 0; k < 3; ++k) {
      const nlohmann::json& number = json[static_cast<size_t>(k)];
      if (!number.is_number() || !(std::fabs(number.get<double>()) <= maxNumber)) {
        fail(fmt::format("{}[{}]", path, k), number, fmt::format("a number within {}", maxNumber));
      }
      value[k] = number.get<double>();
    }
    return value;
  }

  glm::dvec3 direction(const nlohmann::json& json, const std::string& path) const {
    for (size_t i = 0; i < std::size(axisNames); ++i) {
      if (json.is_string() && json.get_ref<const std::string&>() == axisNames[i]) return axisOf(i);
    }
    if (!json.is_array())
      fail(path, json, fmt::format("one of {}, or [x, y, z]", fmt::join(axisNames, ", ")));
    const glm::dvec3 value = vector(json, path);
    if (!(glm::length(value) > 1e-9)) fail(path, json, "a direction, not [0, 0, 0]");
    return glm::normalize(value);
  }

  const std::string& text(const nlohmann::json& json, const std::string& path) const {
    if (!json.is_string() || json.get_ref<const std::string&>().empty())
      fail(path, json, "a string that is not empty");
    return json.get_ref<const std::string&>();
  }

  void readFollowers(const nlohmann::json& json, const std::string& path, RigSetup& setup) const {
    const auto* follow = find(json, "follow");
    if (!follow) return;
    if (!follow->is_object()) fail(join(path, "follow"), *follow, "an object of joints");
    for (const auto& [joint, bone] : follow->items()) {
      setup.followers.push_back({joint, text(bone, fmt::format("{}.{}", join(path, "follow"), joint))});
    }
  }

  void readLeg(const nlohmann::json& json, const std::string& path, RigSetup& setup) const {
    checkKeys(json, path,
              {"name", "group", "joints", "tipOffset", "home", "coneHalfAngleDegrees", "bend", "bendDegrees",
               "footBones"});
    RigSetup::Leg leg;
    leg.name = text(member(json, "name", path), path + ".name");
    for (const RigSetup::Leg& other : setup.legs) {
      if (other.name == leg.name)
        throw inputError(fmt::format("{}: {}: two legs are named \"{}\"", name_, path, leg.name));
    }
    const nlohmann::json& group = member(json, "group", path);
    leg.group = text(group, path + ".group");
    if (std::find(setup.groups.begin(), setup.groups.end(), leg.group) == setup.groups.end()) {
      fail(path + ".group", group, fmt::format("one of \"{}\"", fmt::join(setup.groups, "\", \"")));
    }
    if (const auto* offset = find(json, "tipOffset")) leg.tipOffset = vector(*offset, path + ".tipOffset");
    const size_t tip = leg.tipOffset ? 1 : 0;
    for (const auto& joint : array(json, "joints", path, 2 - tip, Leg::maxBones + 1 - tip)) {
      leg.joints.push_back(text(joint, fmt::format("{}.joints[{}]", path, leg.joints.size())));
    }
    if (const auto* home = find(json, "home")) leg.home = vector(*home, path + ".home");
    if (const auto* bend = find(json, "bend")) {
      leg.bend = vector(*bend, path + ".bend");
      if (!(glm::length(*leg.bend) > 1e-9)) fail(path + ".bend", *bend, "a direction, not [0, 0, 0]");
    }
    if (const auto* degrees = find(json, "bendDegrees")) {
      if (!degrees->is_number() || !(degrees->get<double>() > 0 && degrees->get<double>() <= 120)) {
        fail(path + ".bendDegrees", *degrees, "a number over 0 and up to 120");
      }
      leg.bendDegrees = degrees->get<double>();
    }
    const size_t bones = leg.joints.size() - 1 + tip;
    if (const auto* foot = find(json, "footBones")) {
      if (!foot->is_number_unsigned() || foot->get<size_t>() >= bones) {
        fail(path + ".footBones", *foot, fmt::format("a whole number less than the leg's {} bones", bones));
      }
      leg.footBones = foot->get<size_t>();
    }
    if (const auto* cones = find(json, "coneHalfAngleDegrees")) {
      readCones(*cones, path + ".coneHalfAngleDegrees", leg, bones);
    }
    setup.legs.push_back(std::move(leg));
  }

  void readCones(const nlohmann::json& cones, const std::string& path, RigSetup::Leg& leg,
                 size_t bones) const {
    if (!cones.is_array()) fail(path, cones, "an array of angles");
    if (cones.size() != bones) {
      throw inputError(
          fmt::format("{}: {} has {} angles, the leg {} bones", name_, path, cones.size(), bones));
    }
    for (size_t i = 0; i < cones.size(); ++i) {
      const double degrees = cones[i].is_number() ? cones[i].get<double>() : -1;
      if (!(degrees > 0 && degrees <= 180)) {
        fail(fmt::format("{}[{}]", path, i), cones[i], "a number over 0 and up to 180");
      }
      leg.coneHalfAngleDegrees.push_back(degrees);
    }
  }

  const std::string& name_;
};

// Six digits say more than a model's maker knows, and are what a person can edit.
nlohmann::ordered_json number(double value) {
  const std::string text = fmt::format("{:.6g}", value);
  // A number too small for a double leaves it 0.
  double rounded = 0;
  std::from_chars(text.data(), text.data() + text.size(), rounded);
  if (rounded == std::round(rounded) && std::fabs(rounded) < 1e9) return static_cast<int64_t>(rounded);
  return rounded;
}

nlohmann::ordered_json numbers(const glm::dvec3& v) { return {number(v.x), number(v.y), number(v.z)}; }

nlohmann::ordered_json direction(const glm::dvec3& v) {
  for (size_t i = 0; i < std::size(axisNames); ++i) {
    if (glm::length(v - axisOf(i)) < 1e-6) return axisNames[i];
  }
  return numbers(v);
}

// One line for an array that fits one, a line a member for the rest.
void print(const nlohmann::ordered_json& json, size_t indent, std::string& text) {
  constexpr size_t width = 110;
  const auto flat = [](const nlohmann::ordered_json& value) {
    return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  };
  if (!json.is_structured()) {
    text += flat(json);
    return;
  }
  const auto isPlain = [](const nlohmann::ordered_json& value) { return !value.is_structured(); };
  if (json.is_array() && std::all_of(json.begin(), json.end(), isPlain)) {
    std::vector<std::string> members;
    for (const auto& value : json) members.push_back(flat(value));
    const std::string line = fmt::format("[{}]", fmt::join(members, ", "));
    if (indent + line.size() <= width) {
      text += line;
      return;
    }
  }
  text += json.is_object() ? "{\n" : "[\n";
  size_t left = json.size();
  for (const auto& [key, value] : json.items()) {
    text += std::string(indent + 2, ' ');
    if (json.is_object()) text += nlohmann::json(key).dump() + ": ";
    print(value, indent + 2, text);
    text += --left > 0 ? ",\n" : "\n";
  }
  text += std::string(indent, ' ') + (json.is_object() ? "}" : "]");
}

}  // namespace

RigSetup readRigSetup(const nlohmann::json& json, const std::string& name, const std::string& path,
                      bool sidecar) {
  return SetupReader(name).read(json, path, sidecar);
}

RigSetup parseRigSetup(const std::string& json, const std::string& name) {
  return readRigSetup(parseJson(json, name), name, "", true);
}

RigSetup loadRigSetup(const std::filesystem::path& sidecar) {
  const std::vector<uint8_t> bytes = readFile(sidecar);
  return parseRigSetup(std::string(bytes.begin(), bytes.end()), sidecar.string());
}

std::filesystem::path sidecarOf(const std::filesystem::path& model) {
  std::filesystem::path sidecar = model;
  return sidecar.replace_extension(".rig.json");
}

std::string writeRigSetup(const RigSetup& setup) {
  nlohmann::ordered_json json;
  json["model"] = setup.model;
  if (setup.scale) json["scale"] = number(*setup.scale);
  if (setup.legLength) json["legLength"] = number(*setup.legLength);
  json["forward"] = direction(setup.forward);
  json["up"] = direction(setup.up);
  if (setup.origin) json["origin"] = numbers(*setup.origin);
  if (setup.bodyHeight) json["bodyHeight"] = number(*setup.bodyHeight);
  if (setup.bodyRadius) json["bodyRadius"] = number(*setup.bodyRadius);
  if (setup.colour != glm::dvec3(1)) json["colour"] = numbers(setup.colour);
  json["groups"] = setup.groups;
  json["legs"] = nlohmann::ordered_json::array();
  for (const RigSetup::Leg& from : setup.legs) {
    nlohmann::ordered_json leg;
    leg["name"] = from.name;
    leg["group"] = from.group;
    leg["joints"] = from.joints;
    if (from.tipOffset) leg["tipOffset"] = numbers(*from.tipOffset);
    if (from.home) leg["home"] = numbers(*from.home);
    if (from.bend) {
      leg["bend"] = numbers(*from.bend);
      if (!from.footBones) leg["bendDegrees"] = number(from.bendDegrees);
    }
    if (from.footBones) leg["footBones"] = *from.footBones;
    if (!from.coneHalfAngleDegrees.empty()) {
      auto& cones = leg["coneHalfAngleDegrees"] = nlohmann::ordered_json::array();
      for (double degrees : from.coneHalfAngleDegrees) cones.push_back(number(degrees));
    }
    json["legs"].push_back(std::move(leg));
  }
  for (const RigSetup::Follower& follower : setup.followers) json["follow"][follower.joint] = follower.bone;
  std::string text;
  print(json, 0, text);
  return text + "\n";
}

}  // namespace skitter
