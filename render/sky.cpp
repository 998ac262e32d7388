#include "render/sky.h"

#include "embedded/sky_frag.h"
#include "embedded/sky_vert.h"
#include "render/bindings.h"

namespace skitter::render {

Sky::Sky(const Setting& s, bool stars) {
  std::vector<gpu::SpecConstant> constants = s.lit();
  constants.emplace_back(shared::CONSTANT_STARS, stars);
  pipeline_ =
      gpu::GraphicsPipeline(s.context, {.name = "sky",
                                        .vertex = embedded::sky_vert(),
                                        .fragment = embedded::sky_frag(),
                                        .bindings = {{shared::DRAW_PICTURE, gpu::BindingKind::uniform}},
                                        .colour = s.colour,
                                        .depth = s.depth,
                                        .samples = s.samples,
                                        .depthUse = gpu::DepthUse::background,
                                        .cull = {},
                                        .constants = constants});
  const std::vector<gpu::Binding> list{{shared::DRAW_PICTURE, &s.picture}};
  bindings_ = pipeline_.bind(s.context, list);
}

void Sky::draw(vk::CommandBuffer cmd) const {
  pipeline_.use(cmd, bindings_, {});
  cmd.draw(3, 1, 0, 0);
}

}  // namespace skitter::render
