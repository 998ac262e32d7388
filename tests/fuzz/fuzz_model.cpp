#include "scratch_file.h"
#include "skitter/error.h"
#include "skitter/model.h"
#include "skitter/rig_setup.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto file = skitter::fuzz::scratchFile(data, size, size > 0 && data[0] == 0x67 ? ".glb" : ".gltf");
  try {
    skitter::proposeRig(skitter::loadModel(file));
  } catch (const skitter::Error&) {
  }
  std::filesystem::remove(file);
  return 0;
}
