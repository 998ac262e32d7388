#pragma once

#include <span>
#include <string>

#include "assets/models/gltf.h"
#include "skitter/model.h"

namespace skitter {

// Brings every mesh of the scene into model space at rest.
Model makeModel(const gltf::Document& document, const std::string& name);

}  // namespace skitter
