#include "crowd/controllers/controllers.h"

#include "crowd/scale.h"
#include "gpu/transfer.h"

namespace skitter::crowd {

const ControllerStages& controllerStages(Controller controller) {
  switch (controller) {
#define SKITTER_CONTROLLER(name) \
  case Controller::name:         \
    return name##Controller;
    SKITTER_CONTROLLERS(SKITTER_CONTROLLER)
#undef SKITTER_CONTROLLER
  }
  return adaptiveController;
}

ClipSet clipSetOf(const skitter::Herd& from, const Rig& loaded, float size) {
  return scaled(from.rig == "spider" ? spiderClips() : skitter::loadClips(from.rig, loaded, from.cuts), size);
}

std::vector<std::string> clipNames(const skitter::Herd& from) {
  std::vector<std::string> names = from.clips;
  if (names.empty())
    for (const ClipCut& cut : from.cuts) names.push_back(cut.name);
  return names;
}

gpu::Buffer constantBuffer(const gpu::Context& context, const std::vector<float>& records, const char* name) {
  gpu::Buffer buffer(context, records.size() * sizeof(float), name);
  gpu::upload(context, buffer, records);
  return buffer;
}

}  // namespace skitter::crowd
