#include "check_rig.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace skitter;
  fuzz::refuseOrRead("fuzz", [&] { fuzz::checkRig(parseRig({data, size}, "fuzz")); });
  return 0;
}
