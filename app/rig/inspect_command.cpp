#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.h"
#include "app/common/files.h"
#include "app/common/manifest.h"
#include "app/common/signals.h"
#include "app/common/values.h"
#include "app/rig/look_report.h"
#include "app/rig/rig_picture.h"
#include "app/run/state_report.h"
#include "assets/rigs/rig_setup.h"
#include "assets/rigs/rig_source.h"
#include "skitter/clip.h"
#include "skitter/error.h"
#include "skitter/rig_setup.h"
#include "skitter/state.h"

namespace skitter::app {
namespace {

struct InspectOptions {
  std::string file, json, out;
  Size size{1200, 800};
};

// A model, what it would walk as, and whether it does already.
struct Inspection {
  Model model;
  RigProposal proposal;
  std::optional<Rig> rig;  // of its sidecar or its extras
  std::string rigFault;    // why there is none
  ClipSet clips;           // on that rig, else on the proposed one, else on none
  std::string clipFault;   // why they cannot be baked
};

// On whichever rig the file gives: a model without legs can be played too.
ClipSet bakeClips(const std::string& file, const Inspection& inspection) {
  if (inspection.rig) return loadClips(file, *inspection.rig);
  if (std::filesystem::exists(sidecarOf(file))) throw inputError(inspection.rigFault);
  return loadClips(file, inspection.proposal.setup.legs.empty() ? Rig() : proposedRig(file));
}

Inspection look(const std::string& file) {
  Inspection inspection;
  RigSource source = loadBareModel(file);
  inspection.proposal = proposeRig(source.model, &source.document, {});
  inspection.model = std::move(source.model);
  try {
    inspection.rig = loadRig(file);
  } catch (const Error& error) {
    inspection.rigFault = error.what();
  }
  if (inspection.model.clips.empty()) return inspection;
  try {
    inspection.clips = bakeClips(file, inspection);
  } catch (const Error& error) {
    inspection.clipFault = error.what();
  }
  return inspection;
}

// The joints of a chain in a few words: all of them would not fit a line.
std::string describeChain(const Model& model, const FoundLeg& leg) {
  std::string text = fmt::format("{} joints, {} to {}", leg.joints.size(),
                                 model.reference(leg.joints.front()), model.reference(leg.joints.back()));
  if (leg.root != leg.joints.front())
    text += fmt::format("; the leg begins at {}", model.reference(leg.root));
  if (!leg.footJoint) text += "; foot without a joint";
  return text;
}

double relativeError(const ClipSet& set, const Clip& clip) {
  return set.size > 0 ? clip.error / set.size : 0;
}

void printClips(const Inspection& inspection) {
  if (!inspection.clipFault.empty()) {
    for (const Model::Clip& clip : inspection.model.clips) {
      fmt::print("          \"{}\", {:.3g} s, {} channels\n", clip.name, clip.seconds, clip.channels);
    }
    fmt::print("          not played: {}\n", inspection.clipFault);
    return;
  }
  const ClipSet& set = inspection.clips;
  for (const Clip& clip : set.clips) {
    fmt::print("          \"{}\", {:.3g} s, {} channels: {} frames of {} joints, error {:.2g} of the size",
               clip.name, clip.seconds, clip.channels, clip.frames(), set.joints.size(),
               relativeError(set, clip));
    if (clip.speed != 0) fmt::print("; speed {:.3g} m/s", clip.speed);
    if (clip.rootVelocity != glm::vec3(0)) {
      fmt::print("; root motion {:.3g} m/s left, {:.3g} forward", clip.rootVelocity.x, clip.rootVelocity.z);
    }
    fmt::print("\n");
  }
  for (const std::string& note : set.notes) fmt::print("          {}\n", note);
}

void print(const std::string& file, const Inspection& inspection) {
  const Model& model = inspection.model;
  glm::dvec3 least(0), most(0);
  for (size_t v = 0; v < model.vertices.size(); ++v) {
    const glm::dvec3& p = model.vertices[v].position;
    least = v == 0 ? p : glm::min(least, p);
    most = v == 0 ? p : glm::max(most, p);
  }
  const glm::dvec3 size = most - least;
  fmt::print("{}\n", file);
  fmt::print(
      "  mesh    {} vertices, {} triangles, {} meshes, {} primitives; {:.3g} x {:.3g} x {:.3g} units\n",
      model.vertices.size(), model.indices.size() / 3, model.meshes, model.primitives, size.x, size.y,
      size.z);
  printLook(model);
  fmt::print("  skin    {} skins, {} joints, {} nodes\n", model.skins, model.jointCount(),
             model.nodes.size());
  fmt::print("  clips   {}\n", model.clips.size());
  printClips(inspection);
  fmt::print("  legs    {} found\n", inspection.proposal.found.size());
  for (const FoundLeg& leg : inspection.proposal.found) {
    fmt::print("          {}: {}\n", leg.name, describeChain(model, leg));
  }
  for (const std::string& note : model.notes) fmt::print("  odd     {}\n", note);
  for (const std::string& note : inspection.proposal.notes) fmt::print("  found   {}\n", note);
  if (inspection.rig) {
    fmt::print("  walks   as it is: {} legs in {} groups, leg length {:.3g} m: skitter run --rig {}\n",
               inspection.rig->legCount(), inspection.rig->groupCount(), inspection.rig->legLength, file);
  } else if (std::filesystem::exists(sidecarOf(file))) {
    fmt::print("  walks   not yet: {}\n", inspection.rigFault);
  } else if (inspection.proposal.setup.legs.empty()) {
    fmt::print("  walks   not as it is: a sidecar written by hand may name its legs (docs/rig.md)\n");
  } else {
    fmt::print("  walks   with a sidecar: skitter rig {}\n", file);
  }
}

nlohmann::ordered_json describe(const std::string& file, const Inspection& inspection) {
  const Model& model = inspection.model;
  nlohmann::ordered_json clips = nlohmann::ordered_json::array(), legs = nlohmann::ordered_json::array(),
                         baked = nlohmann::ordered_json::array();
  for (const Model::Clip& clip : model.clips) {
    clips.push_back({{"name", clip.name}, {"seconds", clip.seconds}, {"channels", clip.channels}});
  }
  for (const Clip& clip : inspection.clips.clips) {
    baked.push_back({{"name", clip.name},
                     {"seconds", clip.seconds},
                     {"channels", clip.channels},
                     {"frames", clip.frames()},
                     {"error", relativeError(inspection.clips, clip)},
                     {"speed", clip.speed},
                     {"ground", clip.ground},
                     {"rootVelocity", {clip.rootVelocity.x, clip.rootVelocity.z}}});
  }
  for (const FoundLeg& leg : inspection.proposal.found) {
    std::vector<std::string> joints;
    for (int joint : leg.joints) joints.push_back(model.reference(joint));
    legs.push_back({{"name", leg.name},
                    {"joints", joints},
                    {"root", model.reference(leg.root)},
                    {"footJoint", leg.footJoint}});
  }
  nlohmann::ordered_json all = {{"file", file},
                                {"skins", model.skins},
                                {"joints", model.jointCount()},
                                {"nodes", model.nodes.size()},
                                {"meshes", model.meshes},
                                {"primitives", model.primitives},
                                {"vertices", model.vertices.size()},
                                {"triangles", model.indices.size() / 3},
                                {"clips", clips},
                                {"bakedClips", baked},
                                {"clipsLeftOut", inspection.clips.notes},
                                {"clipFault", inspection.clipFault},
                                {"legs", legs},
                                {"odd", model.notes},
                                {"found", inspection.proposal.notes},
                                {"isRig", inspection.rig.has_value()},
                                {"rigFault", inspection.rigFault}};
  describeLook(model, all);
  return all;
}

int inspectState(const InspectOptions& options) {
  if (!options.out.empty())
    throw inputError(fmt::format("--out {}: {} is a state, expected a model", options.out, options.file));
  printState(options.file);
  if (!options.json.empty()) writeJson(options.json, describeState(options.file), {});
  return 0;
}

int inspect(const InspectOptions& options) {
  if (!options.out.empty() && std::filesystem::path(options.out).extension() != ".png")
    throw inputError(fmt::format("--out is {}, expected a name that ends in .png", options.out));
  Files files;
  files.reads("FILE", options.file);
  files.writes("--json", options.json);
  files.writes("--out", options.out);
  files.expect("--out", 3.0 * options.size.width * options.size.height);
  files.check();
  if (isState(options.file)) return inspectState(options);
  std::optional<StopDeadline> deadline(std::in_place);
  const Inspection inspection = look(options.file);
  files.check();
  deadline.reset();
  if (stopRequested()) throw Interrupted(StopDeadline::nothingWritten());
  print(options.file, inspection);
  if (!options.json.empty()) writeJson(options.json, describe(options.file, inspection), {});
  if (!options.out.empty()) {
    if (!inspection.rig && inspection.proposal.setup.legs.empty()) {
      throw inputError(fmt::format("--out {}: {} has no legs to draw", options.out, options.file));
    }
    const Rig rig = inspection.rig ? *inspection.rig
                                   : buildRig(inspection.model, inspection.proposal.setup, options.file);
    drawRig(rig, options.size, options.out);
    fmt::print("  picture {}\n", options.out);
  }
  return 0;
}

}  // namespace

void addInspect(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<InspectOptions>();
  CLI::App* command = app.add_subcommand(
      "inspect",
      "What a glTF model holds, what is odd about it, and what it would take to walk; or what a state holds");
  command->add_option("file", options->file, "a .glb or .gltf, or a state of skitter run --save")
      ->type_name("FILE")
      ->required();
  command->add_option("--json", options->json, "write all of it to a file")->type_name("FILE");
  command
      ->add_option("--out", options->out,
                   "draw the rig, or the proposed one, from four sides with its chains and limits")
      ->type_name("FILE.png");
  command
      ->add_option_function<std::string>(
          "--size", [options](const std::string& text) { options->size = parseSize("--size", text); },
          "of the picture, in pixels [1200x800]")
      ->type_name("WxH");
  command->footer(
      "Examples:\n  skitter inspect crab.glb\n  skitter inspect crab.glb --json crab.json --out crab.png");
  command->callback([options, &chosen] { chosen = [options] { return inspect(*options); }; });
}

}  // namespace skitter::app
