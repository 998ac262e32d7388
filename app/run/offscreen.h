#pragma once

#include <functional>
#include <optional>

#include "app/common/signals.h"
#include "app/run/pictures.h"
#include "app/run/run_options.h"
#include "app/run/summary.h"
#include "gpu/submit.h"
#include "render/picture_ring.h"
#include "skitter/crowd.h"
#include "skitter/renderer.h"
#include "skitter/scene.h"

namespace skitter::app {

// Simulates, and draws where pictures are wanted, without a window.
class Offscreen {
 public:
  // Without `pictures`, which outlive this, nothing is drawn. `leave` is of what the device takes too long
  // for.
  Offscreen(const RunOptions& options, const OutTarget& target, const Scene& scene, Device& device,
            Crowd& crowd, Pictures* pictures, const StopDeadline::Leave& leave);
  // Waits until no picture is read any more.
  ~Offscreen();
  Offscreen(const Offscreen&) = delete;
  Offscreen& operator=(const Offscreen&) = delete;

  // Until so many ticks are done or a stop is requested. Adds times and frames to the summary.
  void run(uint64_t ticks, const std::function<void()>& afterTick, Summary& summary);

 private:
  void draw(Summary& summary);
  void drawTimed(uint32_t slot, const View& view, Summary& summary);

  const RunOptions& options_;
  const OutTarget& target_;
  const Scene& scene_;
  Crowd& crowd_;
  gpu::CommandRing ring_;
  std::optional<Renderer> renderer_;
  std::optional<render::PictureRing> read_;  // pictures that are being encoded, and the one that is drawn
  size_t ticksTold_ = 0;                     // of those in the summary, that frames were charged with
  Pictures* pictures_;
  const StopDeadline::Leave& leave_;
};

}  // namespace skitter::app
