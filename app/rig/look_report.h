#pragma once

#include <nlohmann/json.hpp>

#include "skitter/model.h"

namespace skitter::app {

// What a model's materials are and which images they look up, decoded, for people and as members of `to`:
// "materials" and "images". A model whose colours are all at its vertices has none.
void printLook(const Model& model);
void describeLook(const Model& model, nlohmann::ordered_json& to);

}  // namespace skitter::app
