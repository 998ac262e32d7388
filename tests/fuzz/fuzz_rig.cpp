#include "skitter/error.h"
#include "skitter/rig.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    skitter::parseRig({data, size}, "fuzz");
  } catch (const skitter::Error&) {
  }
  return 0;
}
