#include "render/antialias.h"

#include "embedded/antialias_frag.h"
#include "embedded/antialias_vert.h"
#include "render/bindings.h"

namespace skitter::render {

Antialias::Antialias(const gpu::Context& context, const gpu::Image& drawn, vk::Format colour)
    : sampler_(gpu::makeSampler(context, {.name = "drawn picture"})) {
  pipeline_ = gpu::GraphicsPipeline(context, {.name = "antialias",
                                              .vertex = embedded::antialias_vert(),
                                              .fragment = embedded::antialias_frag(),
                                              .bindings = {{shared::DRAW_DRAWN, gpu::BindingKind::texture}},
                                              .colour = colour,
                                              .depthUse = gpu::DepthUse::none,
                                              .cull = {}});
  const std::vector<gpu::Binding> list{{shared::DRAW_DRAWN, &drawn, *sampler_}};
  bindings_ = pipeline_.bind(context, list);
}

void Antialias::draw(vk::CommandBuffer cmd) const {
  pipeline_.use(cmd, bindings_, {});
  cmd.draw(3, 1, 0, 0);
}

}  // namespace skitter::render
