#include "app/viewer/viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <thread>

#include "app/common/signals.h"
#include "app/common/warnings.h"
#include "app/viewer/camera_control.h"
#include "app/viewer/followed.h"
#include "app/viewer/gui.h"
#include "app/viewer/lens.h"
#include "app/viewer/overlays.h"
#include "app/viewer/pace.h"
#include "crowd/herd.h"
#include "gpu/context.h"
#include "gpu/submit.h"
#include "gpu/swapchain.h"
#include "skitter/error.h"
#include "skitter/image.h"
#include "skitter/renderer.h"

namespace skitter::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double longestFrame = 1.0 / 30;  // seconds, so that the camera moves however long a tick is
constexpr float turnAPixel = 0.006f;       // radians
constexpr float clickMost = 24;            // pixels beside an agent
constexpr auto hintTime = std::chrono::seconds(8), messageTime = std::chrono::seconds(5);

double secondsOf(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

// Draws at the window's size. While the user drags a corner the old picture is stretched: making a new
// renderer for every step of that would be slow.
class Canvas {
 public:
  Canvas(const WindowRun& run, Size size) : run_(run) { make(size); }

  Renderer& renderer(Size wanted) {
    const auto now = Clock::now();
    if (wanted.width != wanted_.width || wanted.height != wanted_.height) {
      wanted_ = wanted;
      since_ = now;
    }
    const bool fits = renderer_ && renderer_->width() == wanted.width && renderer_->height() == wanted.height;
    if (!renderer_ || (!fits && now - since_ > std::chrono::milliseconds(200))) {
      run_.device.waitIdle();
      make(wanted);
    }
    return *renderer_;
  }
  // Before the crowd changes, which the renderer reads.
  void drop() { renderer_.reset(); }

 private:
  void make(Size size) {
    renderer_.reset();
    renderer_.emplace(run_.device, run_.crowd, size.width, size.height, run_.drawing);
    warnOfImages(*renderer_);
  }

  const WindowRun& run_;
  std::optional<Renderer> renderer_;
  Size wanted_{0, 0};
  Clock::time_point since_;
};

// The first that there is not yet, in the folder where the command runs.
std::filesystem::path screenshotFile() {
  for (int number = 1;; ++number) {
    const std::filesystem::path file = fmt::format("skitter-{:04}.png", number);
    if (!std::filesystem::exists(file)) return file;
  }
}

std::string speedText(double speed) {
  return speed < 1 ? fmt::format("1/{:.0f}", 1 / speed) : fmt::format("{:.0f}", speed);
}

// Ticks and frames a second and the stages' times, worked out anew twice a second.
class Rates {
 public:
  void count(uint64_t ticks) {
    ++frames_;
    ticks_ += ticks;
  }
  // Whether the figures are new.
  bool update(const TickTimes& times) {
    const auto now = Clock::now();
    const double seconds = secondsOf(now - since_);
    if (seconds < 0.5) return false;
    framesASecond = static_cast<double>(frames_) / seconds;
    ticksASecond = static_cast<double>(ticks_) / seconds;
    if (ticks_ > 0) {
      const auto made = static_cast<std::ptrdiff_t>(std::min<uint64_t>(ticks_, times.milliseconds.size()));
      tickMilliseconds = 0;
      for (auto t = times.milliseconds.end() - made; t != times.milliseconds.end(); ++t)
        tickMilliseconds += *t / static_cast<double>(std::max<std::ptrdiff_t>(made, 1));
      stages = times.stages;
      for (size_t s = 0; s < stages.size(); ++s) {
        if (s < before_.size()) stages[s].milliseconds -= before_[s].milliseconds;
        stages[s].milliseconds /= static_cast<double>(ticks_);
      }
      before_ = times.stages;
    }
    since_ = now;
    frames_ = ticks_ = 0;
    return true;
  }
  void restart() { *this = Rates(); }

  double framesASecond = 0, ticksASecond = 0, tickMilliseconds = 0;
  std::vector<StageTime> stages;

 private:
  Clock::time_point since_ = Clock::now();
  uint64_t frames_ = 0, ticks_ = 0;
  std::vector<StageTime> before_;
};

class Viewer {
 public:
  Viewer(Window& window, const WindowRun& run, TickTimes& times)
      : window_(window),
        run_(run),
        times_(times),
        ring_(run.device.context()),
        swapchain_(run.device.context(), window.makeSurface(run.device.instance()), ring_.slots()),
        canvas_(run, {std::max(window.size().width, 1u), std::max(window.size().height, 1u)}),
        gui_(run.device.context(), window.scale()),
        frameSeconds_(static_cast<double>(run.dt) * static_cast<double>(run.ticksPerFrame)),
        pace_(static_cast<double>(run.ticksPerFrame) * std::min(1.0, longestFrame / frameSeconds_),
              run.paused),
        drawn_(window.size()) {
    run_.crowd.timeStages(run.timings);
    window_.setTitle(fmt::format("skitter: {} agents", run_.crowd.agentCount()));
  }

  uint64_t loop();

 private:
  void waitForDevice();
  void advance();
  void handle(const Input& input, float seconds);
  void act(Action action, bool shift);
  void follow(std::optional<AgentId> agent);
  void followWhere(const glm::vec2& pixel, float most);
  void restart(std::optional<Controller> controller);
  void showOverlay(bool& overlay);
  void say(std::string text);
  void draw(Size size, const Input& input, float seconds);
  void shoot(Renderer& renderer);
  Figures figures() const;
  View scenesView() const;
  Lens lens() const;

  Window& window_;
  const WindowRun& run_;
  TickTimes& times_;
  gpu::CommandRing ring_;
  gpu::Swapchain swapchain_;
  Canvas canvas_;
  Gui gui_;
  double frameSeconds_;
  Pace pace_;
  CameraControl camera_;
  Overlays overlays_;
  Rates rates_;
  std::optional<Followed> followed_;
  bool helps_ = false, showsFigures_ = false;
  int shootsIn_ = 0;  // frames until the one that F12 asked for
  std::string message_ = "F1: help";
  Clock::time_point messageUntil_ = Clock::now() + hintTime;
  Size drawn_;
};

void Viewer::waitForDevice() {
  const StopDeadline deadline(std::ref(run_.leave));
  ring_.waitAll();
}

uint64_t Viewer::loop() {
  const auto interval = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(std::min(frameSeconds_, longestFrame)));
  uint64_t frames = 0;
  auto last = Clock::now(), nextFrame = last;
  while (window_.poll() && !stopRequested() && run_.crowd.tick() < run_.ticks) {
    std::this_thread::sleep_until(nextFrame);
    nextFrame = std::max(nextFrame + interval, Clock::now());
    waitForDevice();  // or the drawing of the last frame would be timed as part of the tick
    const auto now = Clock::now();
    const auto seconds = static_cast<float>(std::min(secondsOf(now - last), 0.25));
    last = now;

    const Input input = window_.takeInput();
    handle(input, seconds);
    advance();
    std::optional<CameraControl::Followed> followed;
    if (followed_) followed = {followed_->middle(), 3.5f * followed_->legLength()};
    camera_.advance(scenesView(), followed, seconds);

    const Size size = window_.size();
    swapchain_.resize({size.width, size.height});
    if (size.width > 0 && size.height > 0) {
      draw(size, input, seconds);
      ++frames;
    }
    if (rates_.update(times_)) {
      window_.setTitle(fmt::format("skitter: {} agents, {:.0f} frames/s{}", run_.crowd.agentCount(),
                                   rates_.framesASecond, pace_.paused() ? ", paused" : ""));
    }
  }
  waitForDevice();
  if (!run_.timings) times_.stages.clear();
  return frames;
}

// Fast motion stops short where the device cannot keep up, or the window would no longer answer.
void Viewer::advance() {
  const auto began = Clock::now();
  const uint64_t due = pace_.ticks();
  uint64_t made = 0;
  while (made < due && run_.crowd.tick() < run_.ticks && !stopRequested()) {
    if (pace_.speed() > 1 && !pace_.paused() && made >= run_.ticksPerFrame &&
        secondsOf(Clock::now() - began) > longestFrame)
      break;
    {
      const StopDeadline deadline(std::ref(run_.leave));
      run_.crowd.lookFrom(camera_.view(run_.crowd.terrain()).eye);
      runTick(ring_, run_.crowd, run_.dt, times_);
    }
    run_.afterTick();
    if (followed_ && !followed_->isThere(run_.crowd)) followed_.reset();
    if (followed_) followed_->look(run_.crowd);
    ++made;
  }
  rates_.count(made);
}

void Viewer::handle(const Input& input, float seconds) {
  for (const Input::Pressed& pressed : input.pressed) act(pressed.action, pressed.shift);
  if (input.flown != glm::vec3(0)) {
    follow(std::nullopt);
    camera_.fly(input.flown, seconds);
  }
  if (gui_.hasMouse()) return;
  const auto height = static_cast<float>(drawn_.height);
  if (input.grabbed) camera_.aim(run_.crowd.terrain());
  if (input.turned != glm::vec2(0)) camera_.orbit(input.turned.x * turnAPixel, input.turned.y * turnAPixel);
  if (input.moved != glm::vec2(0)) {
    follow(std::nullopt);
    camera_.pan(input.moved.x / height, -input.moved.y / height);
  }
  if (input.wheel != 0) camera_.zoom(input.wheel);
  if (input.clicked) followWhere(*input.clicked, clickMost);
}

void Viewer::act(Action action, bool shift) {
  switch (action) {
    case Action::followNext:
      if (followed_)
        follow(neighbourOf(run_.crowd, followed_->id(), !shift));
      else
        followWhere(lens().middle(), std::numeric_limits<float>::infinity());
      break;
    case Action::sceneCamera:
      follow(std::nullopt);
      camera_.letGo();
      break;
    case Action::pause:
      pace_.pause();
      say(pace_.paused() ? "paused" : "");
      break;
    case Action::step:
      pace_.step();
      break;
    case Action::faster:
    case Action::slower:
      action == Action::faster ? pace_.faster() : pace_.slower();
      say(fmt::format("{} times real time", speedText(pace_.speed())));
      break;
    case Action::restart:
    case Action::adaptive:
    case Action::loop:
    case Action::clip:
    case Action::planted:
    case Action::keyPoses:
      restart(controllerOf(action));
      break;
    case Action::chains:
      showOverlay(overlays_.chains);
      break;
    case Action::footholds:
      showOverlay(overlays_.footholds);
      break;
    case Action::splines:
      showOverlay(overlays_.splines);
      break;
    case Action::support:
      showOverlay(overlays_.support);
      break;
    case Action::help:
      helps_ = !helps_;
      break;
    case Action::figures:
      showsFigures_ = !showsFigures_;
      run_.crowd.timeStages(run_.timings || showsFigures_);
      break;
    case Action::screenshot:
      shootsIn_ = 2;  // Dear ImGui hides a panel in its first frame
      break;
    case Action::close:
      window_.close();
      break;
    default:
      break;  // held keys and the mouse
  }
}

void Viewer::follow(std::optional<AgentId> agent) {
  if (!agent) return followed_.reset();
  followed_.emplace(run_.crowd, *agent);
  say(run_.crowd.herdCount() > 1 ? fmt::format("agent {} of herd {}", agent->agent, agent->herd)
                                 : fmt::format("agent {}", agent->agent));
}

void Viewer::followWhere(const glm::vec2& pixel, float most) {
  follow(agentAt(run_.crowd, lens(), pixel, most));
}

void Viewer::showOverlay(bool& overlay) {
  overlay = !overlay;
  if (overlay && !followed_) act(Action::followNext, false);
  if (overlay && !followed_) say("no agent to show this of: click on one");
}

void Viewer::restart(std::optional<Controller> controller) {
  if (!run_.unbroken.empty()) {
    return say(fmt::format("{} writes one run from its start to its end, so this one cannot begin anew",
                           run_.unbroken));
  }
  const std::optional<AgentId> agent = followed_ ? std::optional(followed_->id()) : std::nullopt;
  try {
    const StopDeadline deadline(std::ref(run_.leave));
    run_.device.waitIdle();
    canvas_.drop();
    run_.restart(controller);
    followed_.reset();
    times_ = {};
    rates_.restart();
    pace_.forget();
    run_.crowd.timeStages(run_.timings || showsFigures_);
    if (agent && hasPlace(run_.crowd, *agent)) followed_.emplace(run_.crowd, *agent);
    say(controller ? fmt::format("controller {}", nameOf(*controller)) : "from the start");
  } catch (const Error& error) {
    say(error.what());
  }
}

void Viewer::say(std::string text) {
  message_ = std::move(text);
  messageUntil_ = Clock::now() + messageTime;
}

View Viewer::scenesView() const {
  return viewOf(run_.scene, run_.crowd,
                static_cast<double>(run_.crowd.tick()) * static_cast<double>(run_.dt));
}

Lens Viewer::lens() const {
  return {camera_.view(run_.crowd.terrain()), static_cast<float>(drawn_.width),
          static_cast<float>(drawn_.height)};
}

Figures Viewer::figures() const {
  Figures rows{{"agents", fmt::format("{}", run_.crowd.agentCount())},
               {"tick", fmt::format("{}", run_.crowd.tick())},
               {"time", fmt::format("{:.2f} s, {} times real time{}",
                                    static_cast<double>(run_.crowd.tick()) * static_cast<double>(run_.dt),
                                    speedText(pace_.speed()), pace_.paused() ? ", paused" : "")},
               {"ticks/s", fmt::format("{:.1f}", rates_.ticksASecond)},
               {"frames/s", fmt::format("{:.1f}", rates_.framesASecond)},
               {"a tick", fmt::format("{:.3f} ms", rates_.tickMilliseconds)}};
  if (!rates_.stages.empty()) rows.emplace_back("stages, ms a tick", "");
  for (const StageTime& stage : rates_.stages)
    rows.emplace_back(stage.stage, fmt::format("{:8.3f}", stage.milliseconds));
  const std::vector<crowd::Herd>& herds = implOf(run_.crowd).herds;
  for (uint32_t h = 0; h < herds.size() && h < 8; ++h) {
    if (herds[h].isGone()) continue;
    rows.emplace_back(fmt::format("herd {}", h), "");
    rows.emplace_back("rig", run_.crowd.rig(h).name);
    rows.emplace_back("controller", nameOf(herds[h].from.controller));
  }
  if (followed_) {
    rows.emplace_back(fmt::format("agent {}", followed_->id().agent), "");
    rows.emplace_back("herd", fmt::format("{}", followed_->id().herd));
    rows.emplace_back("speed", fmt::format("{:.2f} m/s", followed_->speed()));
  }
  return rows;
}

void Viewer::draw(Size size, const Input& input, float seconds) {
  Renderer& renderer = canvas_.renderer(size);
  drawn_ = {renderer.width(), renderer.height()};
  gui_.begin(drawn_, seconds, input);
  if (followed_ && overlays_.any())
    overlays_.draw(gui_.underneath(), lens(), *followed_, run_.crowd.terrain());
  std::optional<Action> clicked;
  if (helps_) clicked = gui_.help();
  if (showsFigures_) gui_.figures(figures());
  // Messages come and go with the clock, and so are not in a screenshot.
  if (shootsIn_ == 0 && !message_.empty() && Clock::now() < messageUntil_) gui_.message(message_);
  gui_.end();

  const vk::CommandBuffer cmd = ring_.begin();
  renderer.record(cmd, camera_.view(run_.crowd.terrain()), [&](VkCommandBuffer in) { gui_.draw(in); });
  warnOfImages(renderer);  // of herds that have come
  swapchain_.show(cmd, renderer.image(), {renderer.width(), renderer.height()}, ring_.slot());
  ring_.submit(swapchain_.links());
  swapchain_.present();
  if (shootsIn_ > 0 && --shootsIn_ == 0) shoot(renderer);
  if (clicked) act(*clicked, false);
}

void Viewer::shoot(Renderer& renderer) {
  try {
    const std::filesystem::path file = screenshotFile();
    writePng(file, renderer.width(), renderer.height(), renderer.download());
    say("written: " + file.string());
  } catch (const Error& error) {
    say(error.what());
  }
}

}  // namespace

uint64_t runInWindow(Window& window, const WindowRun& run, TickTimes& times) {
  return Viewer(window, run, times).loop();
}

}  // namespace skitter::app
