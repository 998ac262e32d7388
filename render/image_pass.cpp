#include "render/image_pass.h"

#include "embedded/image_pass_vert.h"
#include "render/bindings.h"

namespace skitter::render {

ImagePass::ImagePass(const gpu::Context& context, const std::string& name, gpu::ShaderCode fragment,
                     const gpu::Image& from, vk::Format to)
    : sampler_(gpu::makeSampler(context, {.name = name})) {
  pipeline_ = gpu::GraphicsPipeline(context, {.name = name,
                                              .vertex = embedded::image_pass_vert(),
                                              .fragment = fragment,
                                              .bindings = {{shared::DRAW_DRAWN, gpu::BindingKind::texture}},
                                              .colour = to,
                                              .depthUse = gpu::DepthUse::none,
                                              .cull = {}});
  const std::vector<gpu::Binding> list{{shared::DRAW_DRAWN, &from, *sampler_}};
  bindings_ = pipeline_.bind(context, list);
}

void ImagePass::draw(vk::CommandBuffer cmd) const {
  pipeline_.use(cmd, bindings_, {});
  cmd.draw(3, 1, 0, 0);
}

}  // namespace skitter::render
