#include "check_clips.h"
#include "check_rig.h"
#include "skitter/model.h"
#include "skitter/rig_setup.h"

namespace {

using namespace skitter;

void checkModel(const Model& model) {
  const auto finite = [](const auto& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  fuzz::expect(model.parentsFirst.size() == model.nodes.size(), "an order that misses nodes");
  for (const Model::Node& node : model.nodes) {
    fuzz::expect(node.parent >= -1 && node.parent < static_cast<int>(model.nodes.size()), "a parent of none");
    fuzz::expect(finite(node.position()), "a node that is not finite");
  }
  for (const Model::Vertex& vertex : model.vertices) {
    fuzz::expect(finite(vertex.position) && finite(vertex.normal) && finite(vertex.colour),
                 "a vertex that is not finite");
    fuzz::expect(
        vertex.influences > 0 && vertex.firstInfluence <= model.influences.size() - vertex.influences,
        "a vertex without influence");
  }
  for (const Model::Influence& influence : model.influences) {
    fuzz::expect(influence.node < model.nodes.size(), "an influence of no node");
    fuzz::expect(influence.weight >= 0 && influence.weight <= 1.001, "a weight out of range");
  }
  for (const uint32_t index : model.indices)
    fuzz::expect(index < model.vertices.size(), "an index of no vertex");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const fuzz::ScratchFile file(data, size, size > 0 && data[0] == 'g' ? ".glb" : ".gltf");
  const std::string name = file.path();
  fuzz::refuseOrRead(name, [&] {
    const Model model = loadModel(name);
    checkModel(model);
    const RigProposal proposal = proposeRig(model);
    Rig rig;
    if (!proposal.setup.legs.empty()) {
      parseRigSetup(writeRigSetup(proposal.setup), "proposal");
      rig = buildRig(model, proposal.setup, name);
      fuzz::checkRig(rig);
    }
    if (model.clips.empty()) return;
    // Legs in the extras count before those that are found.
    try {
      rig = loadRig(name);
    } catch (const Error&) {
    }
    fuzz::checkClips(loadClips(name, rig));
  });
  return 0;
}
