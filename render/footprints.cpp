#include "render/footprints.h"

#include <algorithm>
#include <array>

#include "crowd/page.h"
#include "embedded/contact_frag.h"
#include "embedded/footprint_vert_storage.h"
#include "embedded/footprint_vert_texel.h"
#include "embedded/leave_prints_comp_storage.h"
#include "embedded/leave_prints_comp_texel.h"
#include "embedded/see_prints_comp_storage.h"
#include "embedded/see_prints_comp_texel.h"
#include "gpu/transfer.h"
#include "skitter/records.h"

namespace skitter::render {
namespace {

using gpu::BindingKind;

constexpr float kRadius = 0.085f;  // of the leg length
constexpr double kLife = 20;       // seconds
constexpr std::array<glm::vec2, 4> kCorners{{{-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};
constexpr std::array<uint32_t, 6> kIndices{0, 2, 1, 1, 2, 3};
constexpr auto kPush = uint32_t(sizeof(shared::FootprintConstants));

gpu::Kernel leaveKernel(const gpu::Context& context) {
  return {context,
          {.name = "leave prints",
           .code = {embedded::leave_prints_comp_texel(), embedded::leave_prints_comp_storage()},
           .bindings = {{shared::DRAW_PICTURE, BindingKind::uniform},
                        {shared::DRAW_BODY, BindingKind::load4},
                        {shared::DRAW_STEP, BindingKind::load4},
                        {shared::DRAW_HEIGHTS, BindingKind::heights},
                        {shared::DRAW_PRINTS_OUT, BindingKind::store},
                        {shared::DRAW_PRINT_STEPS, BindingKind::store},
                        {shared::DRAW_PRINT_COUNTS, BindingKind::store}},
           .pushBytes = kPush}};
}

gpu::Kernel seeKernel(const gpu::Context& context) {
  return {context,
          {.name = "see prints",
           .code = {embedded::see_prints_comp_texel(), embedded::see_prints_comp_storage()},
           .bindings = {{shared::DRAW_PICTURE, BindingKind::uniform},
                        {shared::DRAW_PRINTS, BindingKind::load4},
                        {shared::DRAW_PRINT_COUNTS, BindingKind::store},
                        {shared::DRAW_PRINT_LIST, BindingKind::store}},
           .pushBytes = kPush}};
}

gpu::GraphicsPipeline pipelineOf(const Setting& s) {
  return {s.context,
          s.dimming({.name = "footprints",
                     .vertex = {embedded::footprint_vert_texel(), embedded::footprint_vert_storage()},
                     .fragment = embedded::contact_frag(),
                     .bindings = {{shared::DRAW_PICTURE, BindingKind::uniform},
                                  {shared::DRAW_PRINTS, BindingKind::load4},
                                  {shared::DRAW_PRINT_COUNTS, BindingKind::store},
                                  {shared::DRAW_HEIGHTS, BindingKind::heights}},
                     .pushBytes = kPush,
                     .streams = {{.stride = sizeof(glm::vec2),
                                  .rate = vk::VertexInputRate::eVertex,
                                  .attributes = {{1, vk::Format::eR32G32Sfloat, 0}}},
                                 {.stride = sizeof(uint32_t),
                                  .rate = vk::VertexInputRate::eInstance,
                                  .attributes = {{0, vk::Format::eR32Uint, 0}}}},
                     .constants = {{shared::CONSTANT_ROOTS, s.filtered()}}})};
}

}  // namespace

Footprints::Footprints(const Setting& s)
    : leave_(leaveKernel(s.context)),
      see_(seeKernel(s.context)),
      pipeline_(pipelineOf(s)),
      prints_(s.context, sizeof(glm::vec4) * shared::PRINT_STRIDE * shared::PRINTS, "footprints"),
      counts_(s.context, sizeof(uint32_t) * shared::PRINT_DRAW + sizeof(VkDrawIndexedIndirectCommand),
              "footprint counts", gpu::BufferUse::indirect),
      list_(s.context, sizeof(uint32_t) * shared::PRINTS, "footprint list", gpu::BufferUse::vertex),
      corners_(s.context, sizeof kCorners, "footprint corners", gpu::BufferUse::vertex),
      indices_(s.context, sizeof kIndices, "footprint indices", gpu::BufferUse::index) {
  gpu::upload(s.context, corners_, std::span(kCorners));
  gpu::upload(s.context, indices_, std::span(kIndices));
  gpu::clear(s.context, counts_);
  constexpr std::array<uint32_t, 3> noGroups{0, 1, 1};
  gpu::uploadBytes(s.context, counts_, std::as_bytes(std::span(noGroups)),
                   shared::PRINT_GROUPS * sizeof(uint32_t));
  seeing_ = see_.bind(s.context, {{shared::DRAW_PICTURE, &s.picture},
                                  {shared::DRAW_PRINTS, &prints_},
                                  {shared::DRAW_PRINT_COUNTS, &counts_},
                                  {shared::DRAW_PRINT_LIST, &list_}});
  const std::vector<gpu::Binding> list{{shared::DRAW_PICTURE, &s.picture},
                                       {shared::DRAW_PRINTS, &prints_},
                                       {shared::DRAW_PRINT_COUNTS, &counts_},
                                       {shared::DRAW_HEIGHTS, &s.heights}};
  drawing_ = pipeline_.bind(s.context, list);
}

void Footprints::follow(const Setting& s, const Crowd::Impl& crowd) {
  pages_.clear();
  for (const crowd::Kind& kind : crowd.kinds) {
    if (kind.controller != Controller::adaptive) continue;  // the feet of all others slide, or have no steps
    for (const crowd::Page& records : kind.pages) {
      if (records.agents == 0) continue;
      Page& page = pages_.emplace_back();
      const auto legs = uint32_t(kind.legs);
      page.constants = {.agents = records.agents,
                        .records = crowd::wholeBlocks(records.agents) * legs,
                        .legs = legs,
                        .radius = kRadius * kind.rig.legLength,
                        .tick = 0,
                        .life = 0};
      page.steps = gpu::Buffer(s.context, page.constants.records * sizeof(float), "footprint steps");
      gpu::upload(s.context, page.steps, std::vector(page.constants.records, float(shared::PRINT_UNSEEN)));
      page.leave = leave_.bind(s.context, {{shared::DRAW_PICTURE, &s.picture},
                                           {shared::DRAW_BODY, &records.body},
                                           {shared::DRAW_STEP, &records.step},
                                           {shared::DRAW_HEIGHTS, &s.heights},
                                           {shared::DRAW_PRINTS_OUT, &prints_},
                                           {shared::DRAW_PRINT_STEPS, &page.steps},
                                           {shared::DRAW_PRINT_COUNTS, &counts_}});
    }
  }
}

void Footprints::prepare(vk::CommandBuffer cmd) const {
  const VkDrawIndexedIndirectCommand draw{.indexCount = uint32_t(kIndices.size()),
                                          .instanceCount = 0,
                                          .firstIndex = 0,
                                          .vertexOffset = 0,
                                          .firstInstance = 0};
  cmd.updateBuffer(counts_.handle(), shared::PRINT_DRAW * sizeof(uint32_t), sizeof draw, &draw);
}

void Footprints::record(vk::CommandBuffer cmd, uint64_t tick, float dt) {
  // Before the first tick there is no length of one.
  now_.tick = float(tick);
  now_.life = dt > 0 ? float(kLife / double(dt)) : 1;
  for (const Page& page : pages_) {
    shared::FootprintConstants constants = page.constants;
    constants.tick = now_.tick;
    constants.life = now_.life;
    leave_.dispatch(cmd, page.leave, gpu::bytesOf(constants),
                    gpu::groupsFor(constants.records, shared::WORK_GROUP));
  }
  gpu::computeToIndirectAndCompute(cmd);
  see_.dispatchIndirect(cmd, seeing_, gpu::bytesOf(now_), counts_, shared::PRINT_GROUPS * sizeof(uint32_t));
}

void Footprints::draw(vk::CommandBuffer cmd) const {
  pipeline_.use(cmd, drawing_, gpu::bytesOf(now_));
  cmd.bindIndexBuffer(indices_.handle(), 0, vk::IndexType::eUint32);
  const std::array buffers{corners_.handle(), list_.handle()};
  const std::array<vk::DeviceSize, 2> offsets{0, 0};
  cmd.bindVertexBuffers(0, 2, buffers.data(), offsets.data());
  cmd.drawIndexedIndirect(counts_.handle(), shared::PRINT_DRAW * sizeof(uint32_t), 1,
                          sizeof(VkDrawIndexedIndirectCommand));
}

}  // namespace skitter::render
