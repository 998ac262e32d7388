#pragma once

#include <memory>
#include <optional>

#include "bindings/common/herd_reader.h"
#include "bindings/common/walk.h"
#include "bindings/python/bind.h"
#include "skitter/renderer.h"
#include "skitter/state.h"

namespace skitter::python {

constexpr float usualTick = 1.0f / 60;  // seconds

// A crowd with what it takes to make its ticks and pictures. Members are destroyed last first.
struct PythonCrowd {
  std::shared_ptr<SharedDevice> device;
  Scene scene;  // whose camera takes pictures
  Crowd crowd;
  bindings::Walk walk;
  std::optional<Renderer> renderer = {};  // of the last picture
  RendererOptions drawing;                // of the renderer
  size_t warned = 0;                      // how many of its notes have been warnings

  PythonCrowd(std::shared_ptr<SharedDevice> on, Scene from, const Heightfield& terrain,
              const CrowdOptions& options)
      : device(std::move(on)),
        scene(std::move(from)),
        crowd(device->device, terrain, scene, options),
        walk(device->device) {}
  PythonCrowd(std::shared_ptr<SharedDevice> on, const State& state)
      : device(std::move(on)), scene(state.scene), crowd(device->device, state), walk(device->device) {}

  float dt() const { return bindings::dtOf(crowd); }  // of the first tick; 0 before it
  // Asks the crowd in this call's turn.
  template <typename Ask>
  auto told(Ask ask) {
    const Turn turn(*device);
    return ask(crowd);
  }
};

using CrowdClass = py::class_<PythonCrowd, std::shared_ptr<PythonCrowd>>;

void bindSteering(CrowdClass& bound);
void bindPicking(py::module_& module, CrowdClass& bound);
void bindStates(py::module_& module, CrowdClass& bound);
void bindRates(CrowdClass& bound);

}  // namespace skitter::python
