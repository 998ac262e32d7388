#include "gpu/graphics.h"

#include <cassert>

namespace skitter::gpu {
namespace {

struct Specialization {
  std::vector<vk::SpecializationMapEntry> entries;
  std::vector<uint32_t> data;
  vk::SpecializationInfo info;

  explicit Specialization(const std::vector<SpecConstant>& constants) {
    for (const SpecConstant& constant : constants) {
      entries.push_back({.constantID = constant.id, .offset = uint32_t(data.size() * 4), .size = 4});
      data.push_back(constant.bits);
    }
    info = {.mapEntryCount = uint32_t(entries.size()),
            .pMapEntries = entries.data(),
            .dataSize = data.size() * 4,
            .pData = data.data()};
  }
};

struct VertexInput {
  std::vector<vk::VertexInputBindingDescription> bindings;
  std::vector<vk::VertexInputAttributeDescription> attributes;

  explicit VertexInput(const std::vector<VertexStream>& streams) {
    for (uint32_t i = 0; i < streams.size(); ++i) {
      bindings.push_back({.binding = i, .stride = streams[i].stride, .inputRate = streams[i].rate});
      for (const VertexAttribute& a : streams[i].attributes)
        attributes.push_back({.location = a.location, .binding = i, .format = a.format, .offset = a.offset});
    }
  }
};

vk::PipelineDepthStencilStateCreateInfo depthState(DepthUse use) {
  vk::PipelineDepthStencilStateCreateInfo state{};
  state.depthTestEnable = use != DepthUse::none;
  state.depthWriteEnable = use == DepthUse::reversed || use == DepthUse::shadow;
  state.depthCompareOp = use == DepthUse::reversed     ? vk::CompareOp::eGreater
                         : use == DepthUse::background ? vk::CompareOp::eGreaterOrEqual
                                                       : vk::CompareOp::eLessOrEqual;
  return state;
}

Pipeline makePipeline(const Context& context, const GraphicsInfo& info) {
  Pipeline made{BindingLayout(context, info.name, info.bindings, info.pushBytes,
                              vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment)};
  const vk::raii::ShaderModule vertex = makeModule(context, info.vertex, info.name + " vertex");
  const vk::raii::ShaderModule fragment =
      info.fragment ? makeModule(context, *info.fragment, info.name + " fragment") : nullptr;
  const Specialization constants(info.constants);
  std::vector<vk::PipelineShaderStageCreateInfo> stages{{.stage = vk::ShaderStageFlagBits::eVertex,
                                                         .module = *vertex,
                                                         .pName = "main",
                                                         .pSpecializationInfo = &constants.info}};
  if (info.fragment)
    stages.push_back({.stage = vk::ShaderStageFlagBits::eFragment,
                      .module = *fragment,
                      .pName = "main",
                      .pSpecializationInfo = &constants.info});

  const VertexInput vertexInput(info.streams);
  const vk::PipelineVertexInputStateCreateInfo input{
      .vertexBindingDescriptionCount = uint32_t(vertexInput.bindings.size()),
      .pVertexBindingDescriptions = vertexInput.bindings.data(),
      .vertexAttributeDescriptionCount = uint32_t(vertexInput.attributes.size()),
      .pVertexAttributeDescriptions = vertexInput.attributes.data()};
  const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = vk::PrimitiveTopology::eTriangleList};
  const vk::PipelineViewportStateCreateInfo viewport{.viewportCount = 1, .scissorCount = 1};
  const bool shadow = info.depthUse == DepthUse::shadow;
  const vk::PipelineRasterizationStateCreateInfo raster{.cullMode = info.cull,
                                                        .frontFace = vk::FrontFace::eCounterClockwise,
                                                        .depthBiasEnable = shadow,
                                                        .depthBiasConstantFactor = 0,
                                                        .depthBiasSlopeFactor = shadow ? 1.5f : 0.0f,
                                                        .lineWidth = 1};
  const vk::PipelineMultisampleStateCreateInfo multisample{.rasterizationSamples = info.samples};
  const vk::PipelineDepthStencilStateCreateInfo depth = depthState(info.depthUse);
  using C = vk::ColorComponentFlagBits;
  const vk::PipelineColorBlendAttachmentState colours{
      .blendEnable = info.blended,
      .srcColorBlendFactor = vk::BlendFactor::eSrcAlpha,
      .dstColorBlendFactor = vk::BlendFactor::eOneMinusSrcAlpha,
      .colorBlendOp = vk::BlendOp::eAdd,
      .srcAlphaBlendFactor = vk::BlendFactor::eOne,
      .dstAlphaBlendFactor = vk::BlendFactor::eOneMinusSrcAlpha,
      .alphaBlendOp = vk::BlendOp::eAdd,
      .colorWriteMask = C::eR | C::eG | C::eB | C::eA};
  const bool coloured = info.colour != vk::Format::eUndefined;
  const vk::PipelineColorBlendStateCreateInfo blend{.attachmentCount = coloured ? 1u : 0u,
                                                    .pAttachments = &colours};
  const std::array dynamics{vk::DynamicState::eViewport, vk::DynamicState::eScissor};
  const vk::PipelineDynamicStateCreateInfo dynamic{.dynamicStateCount = uint32_t(dynamics.size()),
                                                   .pDynamicStates = dynamics.data()};
  const vk::PipelineRenderingCreateInfo rendering{.colorAttachmentCount = coloured ? 1u : 0u,
                                                  .pColorAttachmentFormats = &info.colour,
                                                  .depthAttachmentFormat = info.depth};
  const vk::GraphicsPipelineCreateInfo create{.pNext = &rendering,
                                              .stageCount = uint32_t(stages.size()),
                                              .pStages = stages.data(),
                                              .pVertexInputState = &input,
                                              .pInputAssemblyState = &assembly,
                                              .pViewportState = &viewport,
                                              .pRasterizationState = &raster,
                                              .pMultisampleState = &multisample,
                                              .pDepthStencilState = &depth,
                                              .pColorBlendState = &blend,
                                              .pDynamicState = &dynamic,
                                              .layout = made.layout.pipelineLayout()};
  made.handle = guarded("creating the graphics pipeline " + info.name, [&] {
    return vk::raii::Pipeline(context.device(), context.pipelineCache(), create);
  });
  context.name(*made.handle, info.name);
  return made;
}

PipelineKey keyOf(const Context& context, const GraphicsInfo& info) {
  PipelineKey key;
  key.add(info.name).add(context, info.vertex).add(info.fragment.has_value());
  if (info.fragment) key.add(context, *info.fragment);
  key.add(info.bindings).add(info.pushBytes).add(info.streams.size());
  for (const VertexStream& stream : info.streams) {
    key.add(stream.stride).add(stream.rate).add(stream.attributes.size());
    for (const VertexAttribute& each : stream.attributes)
      key.add(each.location).add(each.format).add(each.offset);
  }
  key.add(info.colour).add(info.depth).add(info.samples).add(info.depthUse);
  return key.add(VkCullModeFlags(info.cull)).add(info.blended).add(info.constants);
}

}  // namespace

GraphicsPipeline::GraphicsPipeline(const Context& context, const GraphicsInfo& info)
    : made_(context.pipelines().of(keyOf(context, info), [&] { return makePipeline(context, info); })) {}

void GraphicsPipeline::use(vk::CommandBuffer cmd, const Bindings& bindings,
                           std::span<const std::byte> push) const {
  assert(push.size() == layout().pushBytes());
  cmd.bindPipeline(vk::PipelineBindPoint::eGraphics, *made_->handle);
  cmd.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, layout().pipelineLayout(), 0, bindings.set(), {});
  if (!push.empty())
    cmd.pushConstants(layout().pipelineLayout(), layout().stages(), 0, uint32_t(push.size()), push.data());
}

Rendering::Rendering(vk::CommandBuffer cmd, const RenderTargets& targets, bool yUp) : cmd_(cmd), yUp_(yUp) {
  const vk::Extent2D extent = (targets.colour ? targets.colour : targets.depth)->extent();
  vk::RenderingAttachmentInfo colour, depth;
  if (targets.colour) {
    colour = {.imageView = targets.colour->view(),
              .imageLayout = vk::ImageLayout::eColorAttachmentOptimal,
              .loadOp = targets.drawnOver ? vk::AttachmentLoadOp::eLoad
                        : targets.covered ? vk::AttachmentLoadOp::eDontCare
                                          : vk::AttachmentLoadOp::eClear,
              .storeOp = targets.resolve ? vk::AttachmentStoreOp::eDontCare : vk::AttachmentStoreOp::eStore};
    if (targets.resolve) {
      colour.resolveMode = vk::ResolveModeFlagBits::eAverage;
      colour.resolveImageView = targets.resolve->view();
      colour.resolveImageLayout = vk::ImageLayout::eColorAttachmentOptimal;
    }
  }
  if (targets.depth) {
    depth = {.imageView = targets.depth->view(),
             .imageLayout = layoutOf(ImageState::depth),
             .loadOp = targets.drawnOver ? vk::AttachmentLoadOp::eLoad : vk::AttachmentLoadOp::eClear,
             .storeOp = targets.keepDepth ? vk::AttachmentStoreOp::eStore : vk::AttachmentStoreOp::eDontCare};
    depth.clearValue.depthStencil = vk::ClearDepthStencilValue{targets.depthClear, 0};
  }
  cmd_.beginRendering({.renderArea = {.extent = extent},
                       .layerCount = 1,
                       .colorAttachmentCount = targets.colour ? 1u : 0u,
                       .pColorAttachments = &colour,
                       .pDepthAttachment = targets.depth ? &depth : nullptr});
  confine({.extent = extent});
}

Rendering::~Rendering() { cmd_.endRendering(); }

void Rendering::confine(vk::Rect2D area) const {
  const float width = float(area.extent.width), height = float(area.extent.height);
  const float top = float(area.offset.y);
  cmd_.setViewport(0, vk::Viewport{.x = float(area.offset.x),
                                   .y = yUp_ ? top + height : top,
                                   .width = width,
                                   .height = yUp_ ? -height : height,
                                   .minDepth = 0,
                                   .maxDepth = 1});
  cmd_.setScissor(0, area);
}

vk::raii::Sampler makeSampler(const Context& context, const SamplerInfo& info) {
  const vk::SamplerCreateInfo create{.magFilter = info.filter,
                                     .minFilter = info.minFilter.value_or(info.filter),
                                     .mipmapMode = info.mips,
                                     .addressModeU = info.wrapU,
                                     .addressModeV = info.wrapV,
                                     .addressModeW = vk::SamplerAddressMode::eClampToEdge,
                                     .compareEnable = info.compare.has_value(),
                                     .compareOp = info.compare.value_or(vk::CompareOp::eNever),
                                     .maxLod = info.maxLevel};
  vk::raii::Sampler sampler = guarded("creating the sampler " + info.name,
                                      [&] { return vk::raii::Sampler(context.device(), create); });
  context.name(*sampler, info.name);
  return sampler;
}

void graphicsToTransfer(vk::CommandBuffer cmd) {
  using Stage = vk::PipelineStageFlagBits2;
  const vk::MemoryBarrier2 barrier{
      .srcStageMask = Stage::eAllGraphics | Stage::eDrawIndirect | Stage::eComputeShader,
      .dstStageMask = Stage::eAllTransfer};
  cmd.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &barrier});
}

}  // namespace skitter::gpu
