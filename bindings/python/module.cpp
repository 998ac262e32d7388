#include "bindings/python/bind.h"

namespace {

constexpr const char* text =
    R"(Crowds of legged creatures on uneven ground, animated by Vulkan compute shaders.

    import skitter
    device = skitter.Device()
    scene = skitter.Scene.builtin()
    crowd = skitter.Crowd(device, scene)
    crowd.step(60)
    print(crowd.positions())

Lengths are metres, times seconds and angles radians, where nothing else is said. The world is right-handed
and +Y is up; an unturned creature faces +Z. Keys of scene files and files of figures keep their names, but
for those of events and cuts.
Calls that take long let other threads run; calls on one device take turns.
)";

}  // namespace

PYBIND11_MODULE(skitter, module) {
  using namespace skitter::python;
  module.doc() = text;
  module.attr("__version__") = SKITTER_VERSION;
  module.attr("no_agent") = skitter::AgentId().bits();
  bindErrors(module);
  bindDevice(module);
  bindTuning(module);
  bindScene(module);
  bindLevels(module);
  bindCrowd(module);
  bindIk(module);
  bindSplines(module);
  bindValidation(module);
}
