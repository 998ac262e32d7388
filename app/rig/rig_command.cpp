#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/common/files.h"
#include "app/common/signals.h"
#include "app/common/values.h"
#include "app/common/warnings.h"
#include "assets/files/partial_file.h"
#include "assets/rigs/rig_setup.h"
#include "assets/rigs/rig_source.h"
#include "skitter/error.h"
#include "skitter/rig_setup.h"

namespace skitter::app {
namespace {

struct RigOptions {
  std::string file, out;
  double legLength = 1;
  std::optional<glm::dvec3> forward;
  bool force = false;
};

void print(const RigProposal& proposal, const Rig& rig, const std::filesystem::path& out) {
  fmt::print("{}: {} legs in {} groups, the longest {:.3g} m; body {:.3g} m above the ground\n", out.string(),
             rig.legCount(), rig.groupCount(), rig.legLength, rig.bodyHeight);
  for (size_t i = 0; i < rig.legs.size(); ++i) {
    const Leg& leg = rig.legs[i];
    fmt::print("  {} ({}): {} bones from {}, reach {:.3g} m, stands at {:.2f} of it\n", leg.name,
               rig.groups[static_cast<size_t>(leg.group)], leg.bones.size(), leg.bones.front().joint,
               leg.reach, glm::length(leg.home - leg.root()) / leg.reach);
  }
  for (const std::string& note : proposal.notes) fmt::print("  {}\n", note);
  fmt::print("try it: skitter run --rig {}\n", out.string());
}

// "-X", or three numbers: a direction in the model's axes.
glm::dvec3 parseDirection(const std::string& option, const std::string& text) {
  if (text.size() == 2 && (text[0] == '+' || text[0] == '-') && text[1] >= 'X' && text[1] <= 'Z') {
    glm::dvec3 axis(0);
    axis[text[1] - 'X'] = text[0] == '+' ? 1 : -1;
    return axis;
  }
  glm::dvec3 direction(0);
  size_t from = 0, k = 0;
  for (size_t comma = 0; comma != text.npos && k < 3; from = comma + 1, ++k) {
    comma = text.find(',', from);
    direction[static_cast<int>(k)] = parseNumber(option, text.substr(from, comma - from), -1e6, 1e6);
    if (k == 2 && comma != text.npos) ++k;
  }
  if (k != 3 || !(glm::length(direction) > 1e-9)) {
    throw inputError(fmt::format("{} is {}, expected +X, -X, +Y, -Y, +Z, -Z or X,Y,Z", option, text));
  }
  return direction;
}

int propose(const RigOptions& options) {
  namespace fs = std::filesystem;
  const fs::path out = options.out.empty() ? sidecarOf(options.file) : fs::path(options.out);
  if (out.extension() != ".json") {
    throw inputError(fmt::format("--out is {}, expected a name that ends in .rig.json", out.string()));
  }
  Files files;
  files.reads("FILE", options.file);
  files.writes("--out", out);
  files.check();
  if (fs::exists(out) && !options.force) {
    throw inputError(fmt::format("{} exists and may have been edited: --force overwrites it", out.string()));
  }
  const ModelWarnings warnings;
  std::optional<StopDeadline> deadline(std::in_place);
  const RigSource source = loadBareModel(options.file);
  const Model& model = source.model;
  RigProposal proposal = proposeRig(model, &source.document, options.forward);
  if (proposal.setup.legs.empty()) {
    throw inputError(fmt::format("{}: {} (skitter inspect shows what there is; docs/rig.md)", options.file,
                                 proposal.notes.empty() ? "has no legs" : proposal.notes.back()));
  }
  const fs::path folder = out.parent_path().empty() ? fs::path(".") : out.parent_path();
  proposal.setup.model = fs::proximate(options.file, folder).generic_string();
  proposal.setup.legLength = options.legLength;
  // What is written must load: a proposal that does not fit its own model is a fault to be told now.
  const std::string text = writeRigSetup(proposal.setup);
  const Rig rig = buildRig(model, parseRigSetup(text, out.string()), out.string());
  files.check();
  deadline.reset();
  if (stopRequested()) throw Interrupted(StopDeadline::nothingWritten());
  writeText(out, text);
  print(proposal, rig, out);
  return 0;
}

}  // namespace

void addRig(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<RigOptions>();
  CLI::App* command = app.add_subcommand(
      "rig", "Propose the sidecar that makes a glTF model walk: legs, groups, forward, scale, limits");
  command->add_option("file", options->file, "a .glb or .gltf")->type_name("FILE")->required();
  command->add_option("--out", options->out, "the sidecar to write [NAME.rig.json beside the model]")
      ->type_name("X.rig.json");
  command
      ->add_option_function<std::string>(
          "--leg-length",
          [options](const std::string& text) {
            options->legLength = parseNumber("--leg-length", text, 1e-3, 1e3);
          },
          "metres that the longest leg shall have [1]")
      ->type_name("M");
  command
      ->add_option_function<std::string>(
          "--forward",
          [options](const std::string& text) { options->forward = parseDirection("--forward", text); },
          "the way the creature faces in the model's axes, where the proposal is wrong: -Z, or X,Y,Z")
      ->type_name("AXIS");
  command->add_flag("--force", options->force, "overwrite a sidecar that is there");
  command->footer(
      "The sidecar is made to be edited by hand: docs/rig.md explains each key.\n"
      "\n"
      "Examples:\n"
      "  skitter rig crab.glb\n"
      "  skitter rig crab.glb --forward -Z --force\n"
      "  skitter rig crab.glb --leg-length 0.4 --out rigs/crab.rig.json");
  command->callback([options, &chosen] { chosen = [options] { return propose(*options); }; });
}

}  // namespace skitter::app
