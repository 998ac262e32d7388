#include "app/run/offscreen.h"

#include <chrono>

#include "app/common/progress.h"
#include "app/common/simulate.h"
#include "app/common/warnings.h"

namespace skitter::app {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

}  // namespace

Offscreen::Offscreen(const RunOptions& options, const OutTarget& target, const Scene& scene, Device& device,
                     Crowd& crowd, Pictures* pictures, const StopDeadline::Leave& leave)
    : options_(options),
      target_(target),
      scene_(scene),
      crowd_(crowd),
      ring_(device.context()),
      pictures_(pictures),
      leave_(leave) {
  const StopDeadline deadline(std::ref(leave_));
  if (!pictures) return;
  renderer_.emplace(device, crowd, options.size.width, options.size.height);
  warnOfImages(*renderer_);
  renderer_->timeStages(options.timings);
}

void Offscreen::run(uint64_t ticks, const std::function<void()>& afterTick, Summary& summary) {
  Progress progress("ticks", ticks, options_.quiet);
  while (crowd_.tick() < ticks && !stopRequested()) {
    {
      const StopDeadline deadline(std::ref(leave_));
      runTick(ring_, crowd_, static_cast<float>(options_.scene.dt), summary.times);
    }
    afterTick();
    if (target_.isEveryFrame() && crowd_.tick() % options_.ticksPerFrame == 0) draw(summary);
    progress.update(crowd_.tick());
  }
  if (target_.kind == OutTarget::Kind::picture && !stopRequested()) draw(summary);
}

void Offscreen::draw(Summary& summary) {
  const double seconds = static_cast<double>(crowd_.tick()) * options_.scene.dt;
  std::vector<uint8_t> pixels;
  Clock::time_point drawn, read;
  {
    const StopDeadline deadline(std::ref(leave_));
    renderer_->record(ring_.begin(), viewOf(scene_, crowd_, seconds));
    ring_.wait(ring_.submit());
    drawn = Clock::now();
    pixels = renderer_->download();
    read = Clock::now();
  }
  pictures_->add(pixels);
  ++summary.frames;
  if (!options_.timings) return;
  std::vector<StageTime> times = renderer_->stageTimes();
  times.push_back({"readback", milliseconds(read - drawn)});
  times.push_back({"write", milliseconds(Clock::now() - read)});
  addStages(summary.drawing, times);
}

}  // namespace skitter::app
