#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "bindings/c/handles.h"
#include "skitter/image.h"
#include "skitter/renderer.h"

using namespace skitter;
using c::crowdOf;
using c::given;
using c::guarded;

namespace {

View viewFrom(const skitter_view* given_view) {
  const skitter_view& asked = given(given_view, "view");
  View view{.eye = {asked.eye[0], asked.eye[1], asked.eye[2]},
            .target = {asked.target[0], asked.target[1], asked.target[2]}};
  bindings::expectFinite("view->eye", view.eye);
  bindings::expectFinite("view->target", view.target);
  if (view.eye == view.target) throw inputError("view->target is where view->eye is, expected elsewhere");
  if (asked.field_of_view != 0) view.fieldOfView = asked.field_of_view;
  if (!(view.fieldOfView > 0 && view.fieldOfView < std::numbers::pi_v<float>))
    throw inputError(
        fmt::format("view->field_of_view is {:g}, expected above 0 and below pi", view.fieldOfView));
  return view;
}

size_t bytesOfPixels(uint32_t width, uint32_t height) { return size_t{4} * width * height; }

}  // namespace

skitter_result skitter_scene_view(const skitter_scene* scene, const skitter_crowd* crowd, double seconds,
                                  skitter_view* view) {
  return guarded([&] {
    const Scene& from = given(scene, "scene").scene;
    const Crowd& asked = crowdOf(crowd);
    skitter_view& to = given(view, "view");
    const View seen = viewOf(from, asked, seconds);
    c::copyVector(seen.eye, to.eye);
    c::copyVector(seen.target, to.target);
    to.field_of_view = seen.fieldOfView;
  });
}

skitter_result skitter_renderer_create(skitter_crowd* crowd, uint32_t width, uint32_t height,
                                       const skitter_renderer_options* options, skitter_renderer** renderer) {
  return guarded([&] {
    const std::shared_ptr<c::LiveCrowd>& live = given(crowd, "crowd").live;
    given(renderer, "renderer");
    RendererOptions made;
    if (options != nullptr && options->detail != 0) made.detail = options->detail;
    if (options != nullptr && options->scale != 0) made.scale = options->scale;
    made.footprints = options != nullptr && options->footprints != 0;
    if (options != nullptr && options->occlusion != 0) made.occlusion = options->occlusion > 0;
    *renderer = new skitter_renderer{live, Renderer(*live->device, live->crowd, width, height, made)};
  });
}

skitter_result skitter_renderer_draw(skitter_renderer* renderer, const skitter_view* view) {
  return guarded([&] {
    skitter_renderer& drawer = given(renderer, "renderer");
    const View from = viewFrom(view);
    drawer.live->walk.run([&](VkCommandBuffer commands) { drawer.renderer.record(commands, from); });
    drawer.drawn = true;
  });
}

skitter_result skitter_renderer_record(skitter_renderer* renderer, VkCommandBuffer commands,
                                       const skitter_view* view,
                                       void (*over)(VkCommandBuffer commands, void* user), void* user) {
  return guarded([&] {
    skitter_renderer& drawer = given(renderer, "renderer");
    given(commands, "commands");
    std::function<void(VkCommandBuffer)> drawOver;
    if (over != nullptr) drawOver = [=](VkCommandBuffer into) { over(into, user); };
    drawer.renderer.record(commands, viewFrom(view), drawOver);
    drawer.drawn = true;
  });
}

skitter_result skitter_renderer_image(const skitter_renderer* renderer, VkImage* image) {
  return guarded([&] {
    const Renderer& drawer = given(renderer, "renderer").renderer;
    given(image, "image");
    *image = drawer.image();
  });
}

skitter_result skitter_renderer_pixels(const skitter_renderer* renderer, uint8_t* rgba, size_t room) {
  return guarded([&] {
    const skitter_renderer& drawer = given(renderer, "renderer");
    given(rgba, "rgba");
    c::checkRoom("rgba", room, bytesOfPixels(drawer.renderer.width(), drawer.renderer.height()));
    if (!drawer.drawn) throw inputError("renderer: no picture, expected skitter_renderer_draw() before");
    std::ranges::copy(drawer.renderer.download(), rgba);
  });
}

skitter_result skitter_renderer_note(const skitter_renderer* renderer, size_t index, const char** note) {
  return guarded([&] {
    given(note, "note");
    const std::vector<std::string>& notes = given(renderer, "renderer").renderer.notes();
    *note = index < notes.size() ? notes[index].c_str() : nullptr;
  });
}

skitter_result skitter_renderer_destroy(skitter_renderer* renderer) {
  return guarded([&] { delete renderer; });
}

skitter_result skitter_write_png(const char* file, uint32_t width, uint32_t height, const uint8_t* rgba) {
  return guarded([&] {
    given(file, "file");
    given(rgba, "rgba");
    if (width == 0 || height == 0)
      throw inputError(
          fmt::format("{}: a picture of {} x {} pixels, expected at least one", file, width, height));
    writePng(file, width, height, {rgba, bytesOfPixels(width, height)});
  });
}
