#include "app/common/manifest.h"

#include <fmt/format.h>

#include <fstream>

#include "app/common/scene_hash.h"
#include "assets/files/partial_file.h"
#include "commit.h"
#include "skitter/version.h"

namespace skitter::app {
namespace {

nlohmann::ordered_json orNull(const std::string& text) {
  return text.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(text);
}

std::string forShell(const std::string& argument) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%";
  if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos) return argument;
  std::string text = "'";
  for (const char c : argument) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

std::string commandLine() {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::string line;
  for (std::string argument; std::getline(in, argument, '\0');)
    line += (line.empty() ? "" : " ") + forShell(argument);
  return line;
}

}  // namespace

const char* const version = SKITTER_VERSION;

void Manifest::add(const DeviceReport& report) {
  const auto append = [](std::string& list, const std::string& name) {
    list += (list.empty() ? "" : "; ") + name;
  };
  append(device, report.name);
  append(driver, report.driver);
}

nlohmann::ordered_json Manifest::json() const {
  nlohmann::ordered_json json = {
      {"version", version},       {"commit", SKITTER_COMMIT}, {"command", commandLine()}, {"scene", nullptr},
      {"sceneHash", nullptr},     {"terrain", nullptr},       {"seed", nullptr},          {"dt", nullptr},
      {"device", orNull(device)}, {"driver", orNull(driver)}, {"build", SKITTER_BUILD}};
  if (scene) {
    json["scene"] = scene->name;
    json["seed"] = scene->seed;
  }
  if (seed) json["seed"] = *seed;
  if (dt) json["dt"] = *dt;
  if (terrain) {
    json["terrain"] = describe(*terrain);
    json["sceneHash"] =
        sceneHashBefore.empty() ? fmt::format("{:016x}", sceneHash(*scene, *terrain)) : sceneHashBefore;
  }
  return json;
}

std::string Manifest::csvComment() const {
  return "# manifest: " + json().dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string describe(const Heightfield& terrain) {
  return fmt::format("{}, {} x {} samples, {:.6g} x {:.6g} m", terrain.name, terrain.columns, terrain.rows,
                     terrain.extentX(), terrain.extentZ());
}

void writeJson(const std::filesystem::path& file, nlohmann::ordered_json object, const Manifest& manifest) {
  object["manifest"] = manifest.json();
  // Names of files are bytes, and not all bytes are UTF-8.
  writeText(file, object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace skitter::app
