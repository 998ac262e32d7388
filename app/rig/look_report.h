#pragma once

#include <nlohmann/json.hpp>

#include "skitter/model.h"

namespace skitter::app {

// Lists a model's materials and the images that they look up, decoded: for people, and as the members
// "materials" and "images" of `to`. A model whose colours are all at its vertices has none.
void printLook(const Model& model);
void describeLook(const Model& model, nlohmann::ordered_json& to);

}  // namespace skitter::app
