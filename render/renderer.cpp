#include "skitter/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "embedded/antialias_frag.h"
#include "embedded/enlarge_frag.h"
#include "gpu/barrier.h"
#include "gpu/submit.h"
#include "gpu/timer.h"
#include "gpu/transfer.h"
#include "render/composition.h"
#include "render/crowd_drawing.h"
#include "render/footprints.h"
#include "render/image_pass.h"
#include "render/obstacle_drawing.h"
#include "render/sky.h"
#include "render/terrain.h"

namespace skitter {
namespace {

constexpr vk::Format kColour = vk::Format(Renderer::colourFormat);
constexpr vk::Format kDepth = vk::Format::eD32Sfloat;
// cull, shadow, splats, crowd, ground, occlusion, revealed, contacts, sky, filter, enlarge
constexpr uint32_t kPasses = 11;

vk::Extent2D checkedExtent(const gpu::Context& context, uint32_t width, uint32_t height) {
  const uint32_t most = context.limits().maxImageDimension2D;
  if (width == 0 || height == 0)
    throw inputError(fmt::format("a picture of {} x {} pixels: both must be at least 1", width, height));
  if (width > most || height > most)
    throw deviceError(fmt::format("a picture of {} x {} pixels: {} draws at most {} x {}", width, height,
                                  context.report().name, most, most));
  return {width, height};
}

const gpu::Context& checkedContext(const gpu::Context& context) {
  if (!context.draws())
    throw deviceError(fmt::format(
        "a renderer needs a queue for graphics, and {} was given queue family {}, which only computes",
        context.report().name, context.queueFamily()));
  return context;
}

const RendererOptions& checked(const RendererOptions& options) {
  const auto expect = [](const char* name, float value, float least, float most) {
    // Also refuses NaN.
    if (!(value >= least && value <= most))
      throw inputError(fmt::format("{} is {}, expected {} to {}", name, value, least, most));
  };
  expect("detail", options.detail, RendererOptions::leastDetail, RendererOptions::mostDetail);
  expect("scale", options.scale, RendererOptions::leastScale, 1);
  return options;
}

vk::Extent2D scaled(const vk::Extent2D& extent, float scale) {
  const auto side = [&](uint32_t pixels) {
    return std::max(1u, uint32_t(std::lround(double(scale) * double(pixels))));
  };
  return {side(extent.width), side(extent.height)};
}

// Four samples where a GPU gives them almost for nothing; a software device pays sevenfold.
vk::SampleCountFlagBits sampleCount(const gpu::Context& context) {
  return context.isCpu() ? vk::SampleCountFlagBits::e1 : vk::SampleCountFlagBits::e4;
}

bool leavesHiddenOut(const gpu::Context& context, const Crowd::Impl& crowd, const RendererOptions& options) {
  uint64_t agents = 0;
  for (const crowd::Kind& kind : crowd.kinds) agents += kind.agents;
  return options.occlusion.value_or(!context.isCpu() && agents >= RendererOptions::occlusionAgents);
}

}  // namespace

struct Renderer::Impl {
  Impl(const gpu::Context& context, const Crowd::Impl& crowd, uint32_t width, uint32_t height,
       const RendererOptions& options);

  void record(vk::CommandBuffer, const View&, const std::function<void(VkCommandBuffer)>& over);
  bool filtered() const { return samples == vk::SampleCountFlagBits::e1; }
  bool enlarged() const { return drawn.extent() != colour.extent(); }
  vk::Format drawnFormat() const { return filtered() ? vk::Format::eR8G8B8A8Unorm : kColour; }
  // The whole picture. It is enlarged afterwards where fewer pixels are shaded.
  const gpu::Image& finished() const { return enlarged() ? small : colour; }
  void lookForCasters();
  void drawShadows(vk::CommandBuffer);
  void drawPicture(vk::CommandBuffer);
  void smoothEdges(vk::CommandBuffer);
  void enlarge(vk::CommandBuffer);

  const gpu::Context& context;
  const Crowd::Impl& live;
  uint32_t revision;   // of the live crowd, as it is drawn
  bool casts = false;  // whether there is anything that casts a shadow
  bool drew = false;   // a picture was recorded
  bool occlusion;      // agents that are hidden are left out
  gpu::StageTimer timer;
  vk::SampleCountFlagBits samples;
  gpu::Image colour;
  gpu::Image drawn, depth;  // before edges are smoothed: multisampled, or to be filtered
  gpu::Image small;         // smooth, before it is enlarged; none where it is not
  render::LightModel light;
  gpu::Buffer picture;
  gpu::Image ground;
  vk::raii::Sampler groundSampler;
  render::ShadowMap shadow;
  render::Setting setting;
  render::Terrain terrain;
  render::ObstacleDrawing obstacles;
  render::TextureStore textures;
  render::CrowdDrawing crowd;
  render::Footprints footprints;  // none without the option
  render::Sky sky;
  render::ImagePass antialias;    // where there are no samples to resolve
  render::ImagePass enlargement;  // where fewer pixels are shaded
};

Renderer::Impl::Impl(const gpu::Context& c, const Crowd::Impl& source, uint32_t width, uint32_t height,
                     const RendererOptions& options)
    : context(checkedContext(c)),
      live(source),
      revision(source.revision),
      occlusion(leavesHiddenOut(c, source, options)),
      timer(c, kPasses),
      samples(sampleCount(c)),
      colour(c,
             {.format = kColour,
              .extent = checkedExtent(c, width, height),
              .usage = vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eTransferSrc,
              .codes = options.scale < 1},
             "picture"),
      drawn(c,
            {.format = drawnFormat(),
             .extent = scaled(colour.extent(), options.scale),
             .usage = vk::ImageUsageFlagBits::eColorAttachment |
                      (filtered() ? vk::ImageUsageFlagBits::eSampled : vk::ImageUsageFlags()),
             .samples = samples},
            "picture, drawn"),
      depth(c,
            {.format = kDepth,
             .extent = drawn.extent(),
             .usage = vk::ImageUsageFlagBits::eDepthStencilAttachment |
                      (occlusion ? vk::ImageUsageFlagBits::eSampled : vk::ImageUsageFlags()),
             .samples = samples},
            "picture depth"),
      light(render::lightModel(source.scene.light)),
      picture(c, sizeof(shared::Picture), "picture block", gpu::BufferUse::uniform),
      ground(render::makeGroundMap(c, source.terrain, glm::vec3(light.towards))),
      groundSampler(gpu::makeSampler(c, {.name = "ground map"})),
      shadow(c, height, options.scale),
      setting{c,
              source.terrain,
              source.heights,
              picture,
              ground,
              *groundSampler,
              shadow,
              drawnFormat(),
              kDepth,
              samples,
              drawn.extent(),
              render::lightConstants(light),
              options.detail,
              occlusion ? &depth : nullptr},
      terrain(setting),
      obstacles(setting, source),
      crowd(setting, source, textures),
      sky(setting, light.stars) {
  timer.measure(false);
  if (enlarged()) {
    small = gpu::Image(c,
                       {.format = kColour,
                        .extent = drawn.extent(),
                        .usage = vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eSampled,
                        .codes = true},
                       "picture, to be enlarged");
    enlargement =
        render::ImagePass(c, "enlarge", embedded::enlarge_frag(), small.codes(), colour.codes().format());
  }
  if (filtered()) antialias = render::ImagePass(c, "antialias", embedded::antialias_frag(), drawn, kColour);
  if (options.footprints) {
    footprints = render::Footprints(setting);
    footprints.follow(setting, live);
  }
  lookForCasters();
}

// The whole picture.
void Renderer::Impl::record(vk::CommandBuffer cmd, const View& view,
                            const std::function<void(VkCommandBuffer)>& over) {
  // Herds have come or gone. Pictures in flight may still use what goes.
  if (revision != live.revision) {
    context.waitIdle();
    crowd = render::CrowdDrawing(setting, live, textures);
    if (footprints) footprints.follow(setting, live);
    revision = live.revision;
    lookForCasters();
  }
  drew = true;
  const vk::Extent2D extent = drawn.extent();
  const render::Composition composition =
      render::compose(view, light, setting.terrain, terrain.lowest(), terrain.highest(), extent.width,
                      extent.height, shadow.texels());
  context.beginLabel(cmd, "picture");
  timer.reset(cmd);
  timer.next(cmd, "cull");

  gpu::graphicsToTransfer(cmd);  // the last picture may still be reading what is written now
  gpu::graphicsToCompute(cmd);
  cmd.updateBuffer(picture.handle(), 0, sizeof(shared::Picture), &composition.block);
  terrain.prepare(cmd, composition, casts);
  crowd.prepare(cmd);
  if (footprints) footprints.prepare(cmd);
  gpu::transferToCompute(cmd);
  gpu::transferToGraphics(cmd);

  crowd.cull(cmd, live);
  if (footprints) footprints.record(cmd, live.tick, live.dt);
  gpu::computeToGraphics(cmd);
  crowd.countParts(cmd);
  timer.next(cmd, "shadow");
  if (casts) drawShadows(cmd);
  timer.next(cmd, "splats");
  crowd.splat(cmd);
  gpu::computeToGraphics(cmd);
  drawPicture(cmd);
  if (filtered()) smoothEdges(cmd);
  if (enlarged()) enlarge(cmd);
  if (over) {
    gpu::transition(cmd, colour, gpu::ImageState::colour, gpu::ImageState::colour);
    const gpu::Rendering rendering(cmd, {.colour = &colour, .drawnOver = true}, false);
    over(cmd);
  }
  gpu::transition(cmd, colour, gpu::ImageState::colour, gpu::ImageState::transferSrc);
  context.endLabel(cmd);
}

// Where nothing casts, the map is emptied here once and for all: no picture draws it.
void Renderer::Impl::lookForCasters() {
  casts = obstacles || crowd.hasAgents();
  if (!casts) gpu::submitAndWait(context, [&](vk::CommandBuffer cmd) { drawShadows(cmd); });
}

void Renderer::Impl::drawShadows(vk::CommandBuffer cmd) {
  gpu::transition(cmd, shadow.image(), gpu::ImageState::discard, gpu::ImageState::depth);
  {
    const gpu::Rendering rendering(cmd, {.depth = &shadow.image(), .depthClear = 1, .keepDepth = true},
                                   false);
    for (int cascade = 0; cascade < shared::SHADOW_CASCADES; ++cascade) {
      rendering.confine(shadow.square(cascade));
      obstacles.drawShadows(cmd, cascade);
      crowd.drawShadows(cmd, cascade);
    }
  }
  gpu::transition(cmd, shadow.image(), gpu::ImageState::depth, gpu::ImageState::sampled);
}

void Renderer::Impl::drawPicture(vk::CommandBuffer cmd) {
  gpu::transition(cmd, finished(), gpu::ImageState::discard, gpu::ImageState::colour);
  gpu::transition(cmd, depth, gpu::ImageState::discard, gpu::ImageState::depth);
  gpu::transition(cmd, drawn, gpu::ImageState::discard, gpu::ImageState::colour);
  // Timed, each pass renders by itself: a software device takes all timestamps of one rendering at its end.
  const bool parted = timer.measures();
  std::optional<gpu::Rendering> rendering;
  bool begun = false;
  const auto pass = [&](const char* name, bool last) {
    if (parted) rendering.reset();
    timer.next(cmd, name);
    if (rendering) return;
    if (begun) {
      gpu::transition(cmd, drawn, gpu::ImageState::colour, gpu::ImageState::colour);
      gpu::transition(cmd, depth, gpu::ImageState::depth, gpu::ImageState::depth);
    }
    rendering.emplace(cmd,
                      gpu::RenderTargets{.colour = &drawn,
                                         .resolve = filtered() || !last ? nullptr : &finished(),
                                         .depth = &depth,
                                         .keepDepth = !last,
                                         .drawnOver = begun,
                                         .covered = true},  // by the sky, wherever nothing else is
                      true);
    begun = true;
  };
  pass("crowd", !parted && !occlusion);
  crowd.draw(cmd);
  pass("ground", !parted && !occlusion);
  obstacles.draw(cmd);
  terrain.draw(cmd);
  if (occlusion) {
    rendering.reset();
    timer.next(cmd, "occlusion");
    gpu::transition(cmd, depth, gpu::ImageState::depth, gpu::ImageState::sampled);
    crowd.lookAgain(cmd);
    gpu::transition(cmd, depth, gpu::ImageState::sampled, gpu::ImageState::depth);
    pass("revealed", !parted);
    crowd.drawLater(cmd);
    pass("contacts", !parted);
  }
  if (footprints) footprints.draw(cmd);
  crowd.drawContacts(cmd);
  pass("sky", true);
  sky.draw(cmd);
  rendering.reset();
  if (!filtered()) timer.end(cmd, "sky");
}

void Renderer::Impl::smoothEdges(vk::CommandBuffer cmd) {
  timer.next(cmd, "filter");
  gpu::transition(cmd, drawn, gpu::ImageState::colour, gpu::ImageState::sampled);
  {
    const gpu::Rendering rendering(cmd, {.colour = &finished(), .covered = true}, true);
    antialias.draw(cmd);
  }
  timer.end(cmd, "filter");
}

void Renderer::Impl::enlarge(vk::CommandBuffer cmd) {
  timer.next(cmd, "enlarge");
  gpu::transition(cmd, small, gpu::ImageState::colour, gpu::ImageState::sampled);
  gpu::transition(cmd, colour, gpu::ImageState::discard, gpu::ImageState::colour);
  {
    // Making light of codes and codes of light again would cost a software device half as much more.
    const gpu::Rendering rendering(cmd, {.colour = &colour.codes(), .covered = true}, true);
    enlargement.draw(cmd);
  }
  timer.end(cmd, "enlarge");
}

bool Renderer::needsPoses(const Scene& scene) {
  const auto needs = [](const Herd& herd) { return herd.controller != Controller::clip; };
  return std::ranges::any_of(scene.herds, needs) ||
         std::ranges::any_of(scene.events, [&](const Event& event) {
           const auto* addition = std::get_if<HerdAddition>(&event.what);
           return addition != nullptr && needs(addition->herd);
         });
}

Renderer::Renderer(Device& device, const Crowd& crowd, uint32_t width, uint32_t height,
                   const RendererOptions& options)
    : impl_(std::make_unique<Impl>(device.context(), implOf(crowd), width, height, checked(options))) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

void Renderer::record(VkCommandBuffer commandBuffer, const View& view,
                      const std::function<void(VkCommandBuffer)>& over) {
  impl_->record(commandBuffer, view, over);
}
VkImage Renderer::image() const { return impl_->colour.handle(); }
uint32_t Renderer::width() const { return impl_->colour.extent().width; }
uint32_t Renderer::height() const { return impl_->colour.extent().height; }

const std::vector<std::string>& Renderer::notes() const { return impl_->textures.notes(); }

void Renderer::timeStages(bool on) { impl_->timer.measure(on); }

std::vector<StageTime> Renderer::stageTimes() const {
  std::vector<StageTime> times;
  if (!impl_->timer.measures()) return times;
  impl_->context.waitIdle();
  for (const gpu::StageTime& t : impl_->timer.milliseconds()) times.push_back({t.stage, t.milliseconds});
  return times;
}

PictureCounts Renderer::counts() const {
  if (!impl_->drew) return {};
  impl_->context.waitIdle();
  PictureCounts counts = impl_->crowd.counts(impl_->context);
  counts.triangles += impl_->terrain.triangles() + impl_->obstacles.triangles();
  return counts;
}

std::vector<uint8_t> Renderer::download() const {
  impl_->context.waitIdle();
  return gpu::downloadImage<uint8_t>(impl_->context, impl_->colour, gpu::ImageState::transferSrc);
}

}  // namespace skitter
