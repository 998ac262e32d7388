#include <string>

#include "skitter/error.h"
#include "skitter/rig_setup.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    skitter::parseRigSetup(std::string(data, data + size), "fuzz");
  } catch (const skitter::Error&) {
  }
  return 0;
}
