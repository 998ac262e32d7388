#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "assets/models/gltf.h"
#include "skitter/model.h"
#include "skitter/rig_setup.h"

namespace skitter {

// A model and what makes it a creature, wherever that was found.
struct RigSource {
  gltf::Document document;
  Model model;
  RigSetup setup;
  std::string name, path;  // how messages begin, and where the setup lies in its file
};

// What becomes of a model with neither sidecar nor legs in its extras.
enum class NoLegs { refused, proposed };

// A model alone, without a setup. Throws Error(input) that names the file and the fault.
RigSource loadBareModel(const std::filesystem::path& file);
// A sidecar, a model with its sidecar beside it, or a model with legs in its extras. Throws Error(input) that
// names the file and the fault. A proposed setup may have no legs.
RigSource loadRigSource(const std::filesystem::path& file, NoLegs noLegs);
// A model whose extras hold the legs, everything in one file.
RigSource parseRigSource(std::span<const uint8_t> gltf, const std::string& name);

}  // namespace skitter
