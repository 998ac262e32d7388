#include "app/run/run_note.h"

#include <fmt/format.h>

#include "app/run/summary.h"
#include "skitter/error.h"

namespace skitter::app {

std::string RunNote::text() const {
  nlohmann::ordered_json json = {
      {"manifest", manifest},
      {"run",
       {{"dt", dt}, {"ticksPerFrame", ticksPerFrame}, {"frames", orNull(frames)}, {"obstacle", obstacle}}}};
  if (scene) json["run"]["scene"] = nlohmann::ordered_json::parse(sceneJson(*scene));
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

RunNote RunNote::of(const State& state, const std::string& file) try {
  RunNote note;
  note.dt = state.dt;
  const auto json = nlohmann::ordered_json::parse(state.note.empty() ? "{}" : state.note);
  if (!json.contains("run")) return note;
  const auto& run = json.at("run");
  run.at("dt").get_to(note.dt);
  run.at("ticksPerFrame").get_to(note.ticksPerFrame);
  if (!run.at("frames").is_null()) note.frames = run.at("frames").get<uint64_t>();
  note.obstacle = run.at("obstacle");
  note.manifest = json.at("manifest");
  if (run.contains("scene")) note.scene = parseScene(run.at("scene").dump(), file, "/");
  return note;
} catch (const nlohmann::json::exception& fault) {
  throw inputError(fmt::format("{}: its note is none of skitter run: {}", file, fault.what()));
}

}  // namespace skitter::app
