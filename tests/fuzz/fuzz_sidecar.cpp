#include "check_rig.h"
#include "skitter/rig_setup.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace skitter;
  static const Model quadruped = loadModel(SKITTER_ROOT "/assets/quadruped.glb");
  fuzz::refuseOrRead("fuzz", [&] {
    const RigSetup setup = parseRigSetup(std::string(data, data + size), "fuzz");
    // What is written is read again.
    parseRigSetup(writeRigSetup(setup), "again");
    fuzz::checkRig(buildRig(quadruped, setup, "fuzz"));
  });
  return 0;
}
