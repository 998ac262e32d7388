#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "skitter/export.h"
#include "skitter/rig.h"

namespace skitter {

// The table of a rig's gaits for legs that do not carry, NAME.gaits.json (docs/evolve.md): Rig::gaits.
//
// Throw Error(input) that names the file and the key, also where the table is another rig's.
SKITTER_API std::vector<RigGait> loadGaits(const std::filesystem::path& file, const Rig& rig);
SKITTER_API std::vector<RigGait> parseGaits(const std::string& json, const std::string& name, const Rig& rig);
// The table's text, which is read back as equal gaits. `found` says how they were found: a JSON object;
// empty: nothing is said. Throws Error(input) for gaits that no table may have.
SKITTER_API std::string writeGaits(const Rig& rig, std::span<const RigGait> gaits,
                                   const std::string& found = {});

// Where the table of a model or a sidecar lies: NAME.gaits.json beside NAME.glb or NAME.rig.json.
SKITTER_API std::filesystem::path gaitsOf(const std::filesystem::path& rig);

}  // namespace skitter
