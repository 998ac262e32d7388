#include "app/run/offscreen.h"

#include <chrono>
#include <exception>
#include <numeric>

#include "app/common/progress.h"
#include "app/common/simulate.h"
#include "app/common/warnings.h"

namespace skitter::app {
namespace {

using Clock = std::chrono::steady_clock;

// One picture is drawn while another is encoded and a third one waits: an encoder that is slow for a moment,
// as at the first frame of a video's group, holds nobody up.
constexpr uint32_t pictureSlots = 3;

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
  renderer_.emplace(device, crowd, options.size.width, options.size.height, options.drawing);
  read_.emplace(device.context(), options.size.width, options.size.height, pictureSlots);
  warnOfImages(*renderer_);
  renderer_->timeStages(options.timings);
}

void Offscreen::run(uint64_t ticks, const std::function<void()>& afterTick, Summary& summary) {
  Progress progress("ticks", ticks, options_.quiet);
  while (crowd_.tick() < ticks && !stopRequested()) {
    {
      const StopDeadline deadline(std::ref(leave_));
      lookAt(scene_, crowd_, options_.scene.dt);
      runTick(ring_, crowd_, static_cast<float>(options_.scene.dt), summary.times);
    }
    afterTick();
    if (target_.isEveryFrame() && crowd_.tick() % options_.ticksPerFrame == 0) draw(summary);
    progress.update(crowd_.tick());
  }
  if (target_.kind == OutTarget::Kind::picture && !stopRequested()) draw(summary);
}

Offscreen::~Offscreen() {
  try {
    if (pictures_) pictures_->settle(pictures_->count());
  } catch (const std::exception&) {  // Pictures::finish() tells of it
  }
}

void Offscreen::draw(Summary& summary) {
  const double seconds = static_cast<double>(crowd_.tick()) * options_.scene.dt;
  const uint64_t frame = pictures_->count();
  const auto slot = static_cast<uint32_t>(frame % pictureSlots);
  if (frame >= pictureSlots) pictures_->settle(frame - pictureSlots + 1);
  const View view = viewOf(scene_, crowd_, seconds);
  if (options_.timings) {
    drawTimed(slot, view, summary);
  } else {
    const StopDeadline deadline(std::ref(leave_));
    const vk::CommandBuffer cmd = ring_.begin();
    renderer_->record(cmd, view);
    read_->record(cmd, renderer_->image(), slot);
    ring_.wait(ring_.submit());
  }
  warnOfImages(*renderer_);  // of herds that have come
  ++summary.frames;
  if (!options_.timings) pictures_->add(read_->pixels(slot));
}

// Each part by itself, so that none is charged with another's time.
void Offscreen::drawTimed(uint32_t slot, const View& view, Summary& summary) {
  Clock::time_point drawn, read;
  {
    const StopDeadline deadline(std::ref(leave_));
    renderer_->record(ring_.begin(), view);
    ring_.wait(ring_.submit());
    drawn = Clock::now();
    read_->record(ring_.begin(), renderer_->image(), slot);
    ring_.wait(ring_.submit());
    read = Clock::now();
  }
  pictures_->add(read_->pixels(slot));
  pictures_->settle(pictures_->count());
  const std::vector<double>& ticks = summary.times.milliseconds;
  const double simulation =
      std::accumulate(ticks.begin() + static_cast<std::ptrdiff_t>(ticksTold_), ticks.end(), 0.0);
  ticksTold_ = ticks.size();
  addStages(summary.drawing, {{"simulation", simulation}});
  addStages(summary.drawing, renderer_->stageTimes());
  addStages(summary.drawing,
            {{"readback", milliseconds(read - drawn)}, {"encode", milliseconds(Clock::now() - read)}});
}

}  // namespace skitter::app
