#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "assets/models/gltf.h"
#include "skitter/rig_setup.h"

namespace skitter {

// A sidecar's object, or the `skitter` object of a model's extras, which is a sidecar's without what concerns
// the file (docs/rig.md). `path` is where the object lies in its file, "" for the file's own.
RigSetup readRigSetup(const nlohmann::json& json, const std::string& name, const std::string& path,
                      bool sidecar);

// As buildRig; paths in messages begin with `path`.
Rig buildRig(const Model& model, const RigSetup& setup, const std::string& name, const std::string& path);

// As the public one, with the model's clips as evidence of which way it walks.
RigProposal proposeRig(const Model& model, const gltf::Document* document,
                       const std::optional<glm::dvec3>& forward);

}  // namespace skitter
