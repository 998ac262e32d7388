#include "scratch_file.h"
#include "skitter/error.h"
#include "skitter/heightfield.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  // The first byte chooses the format; a height file says so by its name alone.
  if (size == 0) return 0;
  const char* extensions[] = {".png", ".npy", ".r16", ".r32f", "_N27E086.hgt"};
  const auto file = skitter::fuzz::scratchFile(data + 1, size - 1, extensions[data[0] % 5]);
  try {
    skitter::loadHeightfield(file);
  } catch (const skitter::Error&) {
  }
  std::filesystem::remove(file);
  return 0;
}
