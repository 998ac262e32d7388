// Prints the library's version, and the message of an error that came across its border.
#include <cstdio>
#include <cstring>

#include "skitter/clip.h"
#include "skitter/crowd.h"
#include "skitter/error.h"
#include "skitter/ik.h"
#include "skitter/image.h"
#include "skitter/renderer.h"
#include "skitter/rig_setup.h"
#include "skitter/scene.h"
#include "skitter/spline.h"
#include "skitter/version.h"
#include "skitter/video.h"

#ifdef VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#error "the library configures Vulkan-Hpp for its users"
#endif

int main() {
  if (std::strcmp(skitter::version(), SKITTER_VERSION) != 0) return 1;
  try {
    skitter::loadScene("no such scene.json");
  } catch (const skitter::Error& error) {
    std::printf("%s: %s\n", skitter::version(), error.what());
  }
  return 0;
}
