#include "app/viewer/gui_drawing.h"

#include <imgui.h>

#include <algorithm>
#include <cstring>

#include "embedded/gui_frag.h"
#include "embedded/gui_vert.h"
#include "gpu/transfer.h"

namespace skitter::app {
namespace {

static_assert(sizeof(ImDrawIdx) == 2);

// Grows by doubling, so that few frames make one anew.
void makeRoom(const gpu::Context& context, gpu::HostBuffer& buffer, uint64_t bytes, const char* name) {
  if (buffer && buffer.size() >= bytes) return;
  buffer = gpu::HostBuffer(context, std::max<uint64_t>(2 * bytes, 1 << 16), gpu::HostUse::upload, name);
}

vk::Rect2D clipped(const ImVec4& box, const ImDrawData& data) {
  const float left = std::clamp(box.x, 0.0f, data.DisplaySize.x);
  const float top = std::clamp(box.y, 0.0f, data.DisplaySize.y);
  const float right = std::clamp(box.z, left, data.DisplaySize.x);
  const float bottom = std::clamp(box.w, top, data.DisplaySize.y);
  return {{static_cast<int32_t>(left), static_cast<int32_t>(top)},
          {static_cast<uint32_t>(right - left), static_cast<uint32_t>(bottom - top)}};
}

}  // namespace

GuiDrawing::GuiDrawing(const gpu::Context& context, ImFontAtlas& fonts, vk::Format colour)
    : context_(context), sampler_(gpu::makeSampler(context, {.name = "gui font"})) {
  unsigned char* coverage = nullptr;
  int width = 0, height = 0;
  fonts.GetTexDataAsAlpha8(&coverage, &width, &height);
  font_ = gpu::Image(context,
                     {.format = vk::Format::eR8Unorm,
                      .extent = {static_cast<uint32_t>(width), static_cast<uint32_t>(height)},
                      .usage = vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst},
                     "gui font");
  gpu::uploadImage(context, font_,
                   std::span<const unsigned char>(coverage, static_cast<size_t>(width * height)));
  pipeline_ = gpu::GraphicsPipeline(
      context, {.name = "gui",
                .vertex = embedded::gui_vert(),
                .fragment = embedded::gui_frag(),
                .bindings = {{0, gpu::BindingKind::texture}},
                .pushBytes = sizeof(ImVec2),
                .streams = {{.stride = sizeof(ImDrawVert),
                             .rate = vk::VertexInputRate::eVertex,
                             .attributes = {{0, vk::Format::eR32G32Sfloat, offsetof(ImDrawVert, pos)},
                                            {1, vk::Format::eR32G32Sfloat, offsetof(ImDrawVert, uv)},
                                            {2, vk::Format::eR8G8B8A8Unorm, offsetof(ImDrawVert, col)}}}},
                .colour = colour,
                .depthUse = gpu::DepthUse::none,
                .cull = {},
                .blended = true});
  bindings_ = pipeline_.bind(context, std::vector<gpu::Binding>{{0, &font_, *sampler_}});
}

void GuiDrawing::upload(const ImDrawData& data) {
  makeRoom(context_, vertices_, static_cast<uint64_t>(data.TotalVtxCount) * sizeof(ImDrawVert),
           "gui vertices");
  makeRoom(context_, indices_, static_cast<uint64_t>(data.TotalIdxCount) * sizeof(ImDrawIdx), "gui indices");
  std::byte* vertex = vertices_.bytes().data();
  std::byte* index = indices_.bytes().data();
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    std::memcpy(vertex, list.VtxBuffer.Data, static_cast<size_t>(list.VtxBuffer.size_in_bytes()));
    std::memcpy(index, list.IdxBuffer.Data, static_cast<size_t>(list.IdxBuffer.size_in_bytes()));
    vertex += list.VtxBuffer.size_in_bytes();
    index += list.IdxBuffer.size_in_bytes();
  }
}

void GuiDrawing::draw(vk::CommandBuffer cmd, const ImDrawData& data) {
  if (data.TotalIdxCount == 0) return;
  upload(data);
  const ImVec2 size = data.DisplaySize;
  pipeline_.use(cmd, bindings_, std::as_bytes(std::span(&size, 1)));
  cmd.bindVertexBuffers(0, vertices_.handle(), vk::DeviceSize{0});
  cmd.bindIndexBuffer(indices_.handle(), 0, vk::IndexType::eUint16);
  uint32_t firstIndex = 0, firstVertex = 0;
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    for (const ImDrawCmd& part : list.CmdBuffer) {
      cmd.setScissor(0, clipped(part.ClipRect, data));
      cmd.drawIndexed(part.ElemCount, 1, firstIndex + part.IdxOffset,
                      static_cast<int32_t>(firstVertex + part.VtxOffset), 0);
    }
    firstIndex += static_cast<uint32_t>(list.IdxBuffer.Size);
    firstVertex += static_cast<uint32_t>(list.VtxBuffer.Size);
  }
}

}  // namespace skitter::app
