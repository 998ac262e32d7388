// A host of Skitter: a program with a window, a device, queues, memory, pipelines, culling and steering of
// its own, in which a crowd walks. README.md shows the way of a frame.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "drawing.h"
#include "gpu.h"
#include "skitter/buffers.h"
#include "skitter/error.h"
#include "skitter/readback.h"
#include "steer_comp.h"
#include "window.h"

namespace host {
namespace {

using namespace skitter;

struct Options {
  std::string scene;
  uint32_t agents = 600;
  uint64_t frames = 0;  // 0: until the window is closed
  VkExtent2D extent{1280, 720};
  std::string out;  // a picture of the last frame, without a window
  bool steer = true;
  bool validate = false;
};

[[noreturn]] void usage() {
  std::fputs(
      "usage: skitter_host [--scene FILE.json] [--agents N] [--frames N] [--size WxH] [--out FILE.ppm]\n"
      "                    [--no-steer] [--validate]\n",
      stderr);
  std::exit(2);
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    const auto value = [&] { return ++i < argc ? std::string(argv[i]) : (usage(), std::string()); };
    if (name == "--scene") {
      options.scene = value();
    } else if (name == "--agents") {
      options.agents = static_cast<uint32_t>(std::stoul(value()));
    } else if (name == "--frames") {
      options.frames = std::stoull(value());
    } else if (name == "--size") {
      if (std::sscanf(value().c_str(), "%ux%u", &options.extent.width, &options.extent.height) != 2) usage();
    } else if (name == "--out") {
      options.out = value();
    } else if (name == "--no-steer") {
      options.steer = false;
    } else if (name == "--validate") {
      options.validate = true;
    } else {
      usage();
    }
  }
  if (!options.out.empty() && options.frames == 0) options.frames = 1;
  return options;
}

// The buffers of a herd that goes are freed, and steering, palettes and readback are made for all herds once.
void expectNoHerdEvents(const Scene& scene) {
  for (const Event& event : scene.events)
    if (std::holds_alternative<HerdAddition>(event.what) || std::holds_alternative<HerdRemoval>(event.what))
      throw inputError(scene.name + ": an event adds or removes a herd, expected the same herds all along");
}

// Spiders that choose their footholds, and some that play an animation.
Scene sceneOf(const Options& options) {
  if (!options.scene.empty()) {
    Scene loaded = loadScene(options.scene);
    expectNoHerdEvents(loaded);
    return loaded;
  }
  Scene scene;
  scene.terrain = TerrainNoise{.columns = 257, .rows = 257, .amplitude = 5};
  scene.herds[0].agents = options.agents;
  scene.herds[0].spawn = {.kind = Spawn::Kind::grid, .spacing = 1.2f};
  scene.herds.push_back(scene.herds[0]);
  scene.herds[1].agents = options.agents / 6;
  scene.herds[1].controller = Controller::clip;
  scene.herds[1].spawn.centre = {24, 0};
  return scene;
}

// The host's own compute pass in front of the tick.
class Steering {
 public:
  Steering(Gpu& gpu, const Crowd& crowd) : pipeline_(gpu.makeCompute(steer_comp, 2, sizeof(Constants))) {
    for (uint32_t herd = 0; herd < crowd.herdCount(); ++herd) {
      const std::vector<RecordBuffer> goals = crowd.buffers(herd, Record::goal);
      const std::vector<RecordBuffer> bodies = crowd.buffers(herd, Record::body);
      for (size_t page = 0; page < goals.size(); ++page)
        pages_.push_back({gpu.bind(pipeline_, {goals[page].buffer, bodies[page].buffer}), goals[page].first,
                          goals[page].agents});
    }
  }

  void record(VkCommandBuffer cmd) const {
    // Behind the last tick, which is in an earlier submission to the same queue, and in front of the next.
    barrier(cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    for (const Page& page : pages_) {
      use(cmd, pipeline_, page.set, Constants{{0, 0}, 6, 30, page.first, page.agents});
      vkCmdDispatch(cmd, (page.agents + 63) / 64, 1, 1);
    }
    barrier(cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
  }

 private:
  struct Constants {
    glm::vec2 centre;
    float least, most;
    uint32_t first, agents;
  };
  struct Page {
    VkDescriptorSet set;
    uint32_t first, agents;
  };
  Pipeline pipeline_;
  std::vector<Page> pages_;
};

// Circles about the middle of the map.
struct Camera {
  glm::dvec3 eye{0}, target{0};
  View view;

  Camera(double seconds, const Heightfield& ground, VkExtent2D extent) {
    const double angle = 0.6 + 0.05 * seconds;
    target = {0, double{ground.at(0, 0)} - 2, 0};
    eye = target + glm::dvec3(24 * std::sin(angle), 9, -24 * std::cos(angle));
    const auto width = static_cast<float>(extent.width), height = static_cast<float>(extent.height);
    constexpr float fieldOfView = 0.8f;
    glm::mat4 projection = glm::perspectiveRH_ZO(fieldOfView, width / height, 0.1f, 400.0f);
    projection[1][1] = -projection[1][1];
    // The origin goes with the eye, so that float32 is exact wherever on the map it is.
    view.origin = glm::floor(eye);
    view.eye = eye - view.origin;
    view.clip = projection * glm::lookAt(view.eye, glm::vec3(target - view.origin), glm::vec3(0, 1, 0));
    view.pixelsAway = height / (2 * std::tan(fieldOfView / 2));
  }

  // Through a pixel, relative to View::origin.
  Ray rayThrough(VkOffset2D pixel, VkExtent2D extent) const {
    const glm::vec2 at(2 * (static_cast<float>(pixel.x) + 0.5f) / static_cast<float>(extent.width) - 1,
                       2 * (static_cast<float>(pixel.y) + 0.5f) / static_cast<float>(extent.height) - 1);
    const glm::dvec4 far = glm::inverse(glm::dmat4(view.clip)) * glm::dvec4(at, 0.5, 1);
    return {view.eye, glm::dvec3(far) / far.w - glm::dvec3(view.eye)};
  }
};

VkSemaphoreSubmitInfo semaphore(VkSemaphore handle, uint64_t value, VkPipelineStageFlags2 stages) {
  VkSemaphoreSubmitInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
  info.semaphore = handle;
  info.value = value;
  info.stageMask = stages;
  return info;
}

void begin(VkCommandBuffer cmd) {
  VkCommandBufferBeginInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  VK_CHECK(vkBeginCommandBuffer(cmd, &info));
}

void submit(const Queue& queue, VkCommandBuffer cmd, const std::vector<VkSemaphoreSubmitInfo>& waits,
            const std::vector<VkSemaphoreSubmitInfo>& signals) {
  VK_CHECK(vkEndCommandBuffer(cmd));
  VkCommandBufferSubmitInfo one{};
  one.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
  one.commandBuffer = cmd;
  VkSubmitInfo2 info{};
  info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
  info.waitSemaphoreInfoCount = static_cast<uint32_t>(waits.size());
  info.pWaitSemaphoreInfos = waits.data();
  info.commandBufferInfoCount = 1;
  info.pCommandBufferInfos = &one;
  info.signalSemaphoreInfoCount = static_cast<uint32_t>(signals.size());
  info.pSignalSemaphoreInfos = signals.data();
  VK_CHECK(vkQueueSubmit2(queue.queue, 1, &info, VK_NULL_HANDLE));
}

void waitFor(const Gpu& gpu, VkSemaphore timeline, uint64_t value) {
  VkSemaphoreWaitInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO;
  info.semaphoreCount = 1;
  info.pSemaphores = &timeline;
  info.pValues = &value;
  VK_CHECK(vkWaitSemaphores(gpu.device, &info, UINT64_MAX));
}

void writePicture(const std::string& file, VkExtent2D extent, const uint8_t* rgba) {
  std::ofstream out(file, std::ios::binary);
  out << "P6\n" << extent.width << " " << extent.height << "\n255\n";
  for (size_t i = 0; i < size_t{extent.width} * extent.height; ++i)
    out.write(reinterpret_cast<const char*>(rgba + 4 * i), 3);
  if (!out.flush()) throw std::runtime_error(file + ": cannot be written");
}

int run(const Options& options) {
  std::unique_ptr<Window> window;
  if (options.out.empty()) window = std::make_unique<Window>(options.extent);
  Gpu gpu(window ? window->instanceExtensions() : std::vector<const char*>{}, options.validate);
  if (window) window->open(gpu);

  // Skitter on the host's device. It owns nothing of it, and submits only while the crowd is made and where a
  // function says that it waits.
  Device device = Device::adopt({.instance = gpu.instance,
                                 .physicalDevice = gpu.physical,
                                 .device = gpu.device,
                                 .queue = gpu.compute.queue,
                                 .queueFamily = gpu.compute.family,
                                 .features = &gpu.features,
                                 .extensions = gpu.extensions});
  const Scene scene = sceneOf(options);
  Crowd crowd(device, scene.loadTerrain(), scene, CrowdOptions{.measure = false});
  Readback readback(device, crowd);
  Drawing drawing(gpu, device, crowd, options.extent);
  const Steering steering(gpu, crowd);
  const Buffer picture = gpu.makeBuffer(4ull * options.extent.width * options.extent.height,
                                        VK_BUFFER_USAGE_TRANSFER_DST_BIT, true);

  // Frame f of either queue signals its timeline to f.
  const VkSemaphore computed = gpu.makeTimeline(), drawn = gpu.makeTimeline();
  struct Slot {
    VkCommandPool computePool, graphicsPool;
    VkCommandBuffer compute, graphics;
  };
  std::vector<Slot> slots(framesInFlight);
  for (Slot& slot : slots) {
    slot.computePool = gpu.makePool(gpu.compute.family);
    slot.graphicsPool = gpu.makePool(gpu.graphics.family);
    slot.compute = gpu.makeCommands(slot.computePool);
    slot.graphics = gpu.makeCommands(slot.graphicsPool);
  }

  constexpr float dt = 1.0f / 60;
  uint64_t frame = 0;
  while ((options.frames == 0 || frame < options.frames) && (!window || window->pump())) {
    ++frame;
    const uint32_t index = frame % framesInFlight;
    const Slot& slot = slots[index];
    const Camera camera(static_cast<double>(frame) * dt, crowd.terrain(), options.extent);
    if (frame > framesInFlight) waitFor(gpu, drawn, frame - framesInFlight);

    VK_CHECK(vkResetCommandPool(gpu.device, slot.computePool, 0));
    begin(slot.compute);
    if (options.steer) steering.record(slot.compute);
    crowd.record(slot.compute, dt);
    readback.record(slot.compute);
    drawing.recordPalettes(slot.compute, camera.view.origin, index);
    submit(gpu.compute, slot.compute, {}, {semaphore(computed, frame, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT)});

    // Positions are a frame or two old, and nothing waits for them.
    if (const std::optional<VkOffset2D> press = window ? window->takePress() : std::nullopt)
      if (const std::optional<Snapshot> snapshot = readback.latest())
        if (const auto picked =
                snapshot->pick(camera.rayThrough(*press, options.extent), camera.view.origin)) {
          std::printf("agent %u of herd %u, %.2f m away\n", picked->agent, picked->herd, picked->distance);
          drawing.mark(picked->herd, picked->agent);
        }

    VK_CHECK(vkResetCommandPool(gpu.device, slot.graphicsPool, 0));
    begin(slot.graphics);
    drawing.record(slot.graphics, camera.view, index);
    std::vector<VkSemaphoreSubmitInfo> waits{
        semaphore(computed, frame, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT)};
    std::vector<VkSemaphoreSubmitInfo> signals{semaphore(drawn, frame, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT)};
    if (window) {
      window->recordCopy(slot.graphics, drawing.colour(), index);
      waits.push_back(semaphore(window->acquired(index), 0, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT));
      signals.push_back(semaphore(window->drawn(), 0, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT));
    } else if (frame == options.frames) {
      VkBufferImageCopy region{};
      region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      region.imageExtent = {options.extent.width, options.extent.height, 1};
      vkCmdCopyImageToBuffer(slot.graphics, drawing.colour().handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                             picture.handle, 1, &region);
      barrier(slot.graphics, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
              VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    }
    submit(gpu.graphics, slot.graphics, waits, signals);
    if (window) window->show(gpu.graphics);
  }
  waitFor(gpu, drawn, frame);
  if (!options.out.empty())
    writePicture(options.out, options.extent, static_cast<const uint8_t*>(picture.mapped));
  std::printf(
      "%llu agents, %llu ticks, state hash %016llx\n", static_cast<unsigned long long>(crowd.agentCount()),
      static_cast<unsigned long long>(crowd.tick()), static_cast<unsigned long long>(crowd.stateHash()));
  if (window) window->close();
  if (options.validate) std::printf("%u validation messages\n", gpu.messages());
  return gpu.messages() > 0 ? 1 : 0;
}

}  // namespace
}  // namespace host

int main(int argc, char** argv) {
  try {
    return host::run(host::parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "skitter_host: %s\n", error.what());
    return 1;
  }
}
