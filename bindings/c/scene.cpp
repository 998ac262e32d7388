#include "bindings/c/handles.h"

using namespace skitter;
using c::given;
using c::guarded;
using c::herdOf;

skitter_result skitter_scene_builtin(skitter_scene** scene) {
  return guarded([&] {
    given(scene, "scene");
    *scene = new skitter_scene{builtinScene()};
  });
}

skitter_result skitter_scene_load(const char* file, skitter_scene** scene) {
  return guarded([&] {
    given(file, "file");
    given(scene, "scene");
    *scene = new skitter_scene{loadScene(file)};
  });
}

skitter_result skitter_scene_parse(const char* json, const char* folder, skitter_scene** scene) {
  return guarded([&] {
    given(json, "json");
    given(scene, "scene");
    *scene = new skitter_scene{parseScene(json, "the scene", folder != nullptr ? folder : "")};
  });
}

skitter_result skitter_scene_herds(const skitter_scene* scene, uint32_t* herds) {
  return guarded([&] {
    given(herds, "herds");
    *herds = static_cast<uint32_t>(given(scene, "scene").scene.herds.size());
  });
}

skitter_result skitter_scene_agents(const skitter_scene* scene, uint32_t herd, uint32_t* agents) {
  return guarded([&] {
    given(agents, "agents");
    *agents = herdOf(given(scene, "scene").scene, herd).agents;
  });
}

skitter_result skitter_scene_set_agents(skitter_scene* scene, uint32_t herd, uint32_t agents) {
  return guarded([&] { herdOf(given(scene, "scene").scene, herd).agents = agents; });
}

skitter_result skitter_scene_set_seed(skitter_scene* scene, uint64_t seed) {
  return guarded([&] { given(scene, "scene").scene.seed = seed; });
}

skitter_result skitter_scene_destroy(skitter_scene* scene) {
  return guarded([&] { delete scene; });
}
