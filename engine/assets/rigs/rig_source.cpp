#include "assets/rigs/rig_source.h"

#include <fmt/format.h>

#include <new>
#include <system_error>

#include "assets/files/file.h"
#include "assets/models/model.h"
#include "assets/rigs/rig_setup.h"
#include "skitter/error.h"

namespace skitter {
namespace {

void readModel(const std::filesystem::path& file, RigSource& source) {
  const std::string name = file.string();
  try {
    // A file in the working directory has no folder in its path, and "" would refuse its buffers.
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    source.document = gltf::parse(readFile(file), name, folder);
    source.model = makeModel(source.document, name);
  } catch (const std::bad_alloc&) {
    throw inputError(fmt::format("{}: does not fit into memory", name));
  }
}

void useExtras(RigSource& source) {
  source.path = "skitter";
  source.setup = readRigSetup(source.document.extras, source.name, source.path, false);
  source.setup.origin = glm::dvec3(0);
}

RigSource fromSidecar(const std::filesystem::path& sidecar) {
  RigSource source;
  source.name = sidecar.string();
  source.setup = loadRigSetup(sidecar);
  const std::filesystem::path file = sidecar.parent_path() / source.setup.model;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    throw inputError(fmt::format("{}: model is \"{}\", but there is no file {}", source.name,
                                 source.setup.model, file.string()));
  }
  readModel(file, source);
  return source;
}

}  // namespace

RigSource loadBareModel(const std::filesystem::path& file) {
  RigSource source;
  source.name = file.string();
  readModel(file, source);
  return source;
}

RigSource loadRigSource(const std::filesystem::path& file, NoLegs noLegs) {
  if (file.extension() == ".json") return fromSidecar(file);
  RigSource source;
  std::error_code ignored;
  const std::filesystem::path sidecar = sidecarOf(file);
  if (std::filesystem::exists(sidecar, ignored) && std::filesystem::exists(file, ignored)) {
    source.name = sidecar.string();
    source.setup = loadRigSetup(sidecar);
    if (std::filesystem::path(source.setup.model).filename() != file.filename()) {
      throw inputError(fmt::format("{}: model is \"{}\", but the file beside it is {}", source.name,
                                   source.setup.model, file.filename().string()));
    }
    readModel(file, source);
    return source;
  }
  source = loadBareModel(file);
  if (!source.document.extras.is_null()) {
    useExtras(source);
    return source;
  }
  if (noLegs == NoLegs::refused) {
    throw inputError(fmt::format("{}: has no legs: run `skitter rig {}` to propose {} (docs/rig.md)",
                                 source.name, source.name, sidecar.filename().string()));
  }
  source.setup = proposeRig(source.model, &source.document, {}).setup;
  return source;
}

RigSource parseRigSource(std::span<const uint8_t> gltf, const std::string& name) {
  RigSource source;
  source.name = name;
  source.document = gltf::parse(gltf, name);
  if (source.document.extras.is_null()) {
    throw inputError(fmt::format(
        "{}: has no legs: a rig needs `skitter` in the extras of its scene or of a node (docs/rig.md)",
        name));
  }
  source.model = makeModel(source.document, name);
  useExtras(source);
  return source;
}

}  // namespace skitter
