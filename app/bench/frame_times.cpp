#include "app/bench/frame_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "app/common/simulate.h"
#include "app/common/warnings.h"
#include "base/clock.h"
#include "bench/statistics.h"
#include "gpu/context.h"
#include "gpu/submit.h"
#include "render/picture_ring.h"

namespace skitter::app {
namespace {

constexpr uint32_t framesInFlight = 2;

// The crowd, and what draws it.
class Studio {
 public:
  Studio(Device& device, const Heightfield& terrain, const Scene& scene, const FrameOptions& options)
      : scene_(scene),
        dt_(options.dt),
        crowd_(device, terrain, scene, optionsOf(scene, options)),
        renderer_(device, crowd_, options.size.width, options.size.height, options.drawing),
        read_(device.context(), options.size.width, options.size.height, framesInFlight),
        ring_(device.context(), framesInFlight) {
    warnOfImages(renderer_);
  }

  // Waits for the frame before the last one only.
  void frame() {
    const vk::CommandBuffer cmd = ring_.begin();
    tick(cmd);
    renderer_.record(cmd, view());
    read_.record(cmd, renderer_.image(), ring_.slot());
    const uint64_t value = ring_.submit();
    ring_.wait(value - 1);
  }
  void finish() { ring_.waitAll(); }

  void timedFrame(std::vector<StageTime>& parts) {
    parts.push_back({"simulation", alone([&](vk::CommandBuffer cmd) { tick(cmd); })});
    renderer_.timeStages(true);
    alone([&](vk::CommandBuffer cmd) { renderer_.record(cmd, view()); });
    std::ranges::copy(renderer_.stageTimes(), std::back_inserter(parts));
    renderer_.timeStages(false);
    parts.push_back(
        {"readback", alone([&](vk::CommandBuffer cmd) { read_.record(cmd, renderer_.image(), 0); })});
  }

  uint64_t agents() const { return crowd_.agentCount(); }
  PictureCounts counts() const { return renderer_.counts(); }

 private:
  static CrowdOptions optionsOf(const Scene& scene, const FrameOptions& options) {
    CrowdOptions crowd;
    crowd.pose = Renderer::needsPoses(scene);
    crowd.measure = false;  // to judge is no part of animating
    crowd.levels = options.levels;
    return crowd;
  }
  void tick(vk::CommandBuffer cmd) {
    lookAt(scene_, crowd_, dt_);
    crowd_.record(cmd, static_cast<float>(dt_));
  }
  View view() const { return viewOf(scene_, crowd_, static_cast<double>(crowd_.tick()) * dt_); }
  template <class Commands>
  double alone(const Commands& commands) {  // milliseconds by the wall
    return 1e3 * base::timed([&] {
                   commands(ring_.begin());
                   ring_.wait(ring_.submit());
                 }).wall;
  }

  const Scene& scene_;
  double dt_;
  Crowd crowd_;
  Renderer renderer_;
  render::PictureRing read_;
  gpu::CommandRing ring_;
};

// The median of each part, in the order of the first frame's.
std::vector<StageTime> mediansOf(const std::vector<std::vector<StageTime>>& frames) {
  std::vector<StageTime> medians;
  for (const StageTime& part : frames.front()) {
    std::vector<double> found;
    for (const std::vector<StageTime>& frame : frames)
      for (const StageTime& time : frame)
        if (time.stage == part.stage) found.push_back(time.milliseconds);
    medians.push_back({part.stage, bench::quantile(found, 0.5)});
  }
  return medians;
}

}  // namespace

FrameTimes timeFrames(Device& device, const Heightfield& terrain, const Scene& scene,
                      const FrameOptions& options, const std::function<void(double)>& step,
                      const std::function<bool()>& stopped) {
  Studio studio(device, terrain, scene, options);
  FrameTimes times{
      .agents = studio.agents(), .framesPerSecond = 0, .cpuMilliseconds = 0, .counts = {}, .parts = {}};
  const uint32_t all = options.warmUp + options.frames + options.timedFrames;
  std::vector<double> seconds;
  double last = 0, cpuBefore = 0;
  for (uint32_t frame = 0; frame < options.warmUp + options.frames && !stopped(); ++frame) {
    if (frame == options.warmUp) {
      studio.finish();
      cpuBefore = base::processSeconds();
      last = base::wallSeconds();
    }
    studio.frame();
    if (frame >= options.warmUp) {
      const double now = base::wallSeconds();
      seconds.push_back(now - last);
      last = now;
    }
    step(static_cast<double>(frame) / all);
  }
  studio.finish();
  if (stopped()) return times;
  times.cpuMilliseconds = 1e3 * (base::processSeconds() - cpuBefore) / options.frames;
  // The first one waited for no frame.
  seconds.erase(seconds.begin());
  times.framesPerSecond = 1 / bench::quantile(seconds, 0.5);
  std::vector<std::vector<StageTime>> timed;
  for (uint32_t frame = 0; frame < options.timedFrames && !stopped(); ++frame) {
    studio.timedFrame(timed.emplace_back());
    step(static_cast<double>(all - options.timedFrames + frame) / all);
  }
  if (stopped()) return times;
  // The first one with timestamps makes what a device makes only once.
  if (timed.size() > 1) timed.erase(timed.begin());
  times.parts = mediansOf(timed);
  times.counts = studio.counts();
  return times;
}

void print(const FrameTimes& times) {
  const PictureCounts& counts = times.counts;
  fmt::print("\n{} agents, {} in view: {:.2f} frames a second, {:.1f} ms of CPU a frame, {} splats, ",
             times.agents, counts.agents, times.framesPerSecond, times.cpuMilliseconds, counts.splats);
  if (counts.hidden > 0) fmt::print("{} hidden, ", counts.hidden);
  fmt::print("{} triangles\n", counts.triangles);
  for (const StageTime& part : times.parts) fmt::print("{:<12}{:>10.3f} ms\n", part.stage, part.milliseconds);
}

nlohmann::ordered_json jsonOf(const FrameTimes& times) {
  nlohmann::ordered_json parts = nlohmann::ordered_json::object();
  for (const StageTime& part : times.parts) parts[part.stage] = part.milliseconds;
  return {{"agents", times.agents},
          {"framesPerSecond", times.framesPerSecond},
          {"cpuMilliseconds", times.cpuMilliseconds},
          {"inView", times.counts.agents},
          {"splats", times.counts.splats},
          {"hidden", times.counts.hidden},
          {"triangles", times.counts.triangles},
          {"milliseconds", parts}};
}

}  // namespace skitter::app
