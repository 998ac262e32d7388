#include "fuzz.h"
#include "skitter/scene.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  skitter::fuzz::refuseOrRead("fuzz",
                              [&] { skitter::parseScene(std::string(data, data + size), "fuzz", "."); });
  return 0;
}
