#include "skitter/palettes.h"

#include <fmt/format.h>

#include "crowd/controller.h"
#include "crowd/host_space.h"
#include "crowd/page.h"
#include "embedded/instances_comp_storage.h"
#include "embedded/instances_comp_texel.h"
#include "embedded/palettes_comp_storage.h"
#include "embedded/palettes_comp_texel.h"
#include "gpu/barrier.h"
#include "gpu/transfer.h"
#include "palettes/transforms.h"
#include "skitter/error.h"

namespace skitter {
namespace {

using crowd::Part;
using gpu::BindingKind;

uint32_t entriesOfKind(const crowd::Kind& kind) {
  return static_cast<uint32_t>(crowd::traitsOf(kind.controller).playsClips ? kind.clips.joints
                                                                           : kind.rig.paletteSize());
}

// Where transforms are, in vec4.
struct Arrangement {
  uint64_t stride = 0;  // from one to the next
  uint64_t plane = 1;   // from one of its vec4 to the next
  uint64_t parts = 0;   // vec4 of one

  uint64_t end(uint64_t count) const {
    return count == 0 ? 0 : (count - 1) * stride + (parts - 1) * plane + 1;
  }
};

// Throws where `count` of them do not fit.
Arrangement arrangementOf(const TransformRange& range, uint64_t count, const char* what) {
  const auto refuse = [&](const std::string& why) { throw inputError(fmt::format("{}: {}", what, why)); };
  Arrangement made{.parts = bytesOf(range.format) / 16};
  for (const auto& [name, value] : {std::pair("offset", range.offset), std::pair("stride", range.stride)})
    if (value % 16 != 0) refuse(fmt::format("{} {}, expected a multiple of 16 bytes", name, value));
  if (range.planar) {
    if (range.stride != 0) refuse(fmt::format("stride {} of planar transforms, expected 0", range.stride));
    made.stride = 1, made.plane = count;
  } else {
    if (range.stride != 0 && range.stride < 16 * made.parts)
      refuse(fmt::format("stride {}, expected 0 or at least {} bytes", range.stride, 16 * made.parts));
    made.stride = range.stride == 0 ? made.parts : range.stride / 16;
  }
  if (const uint64_t needed = 16 * made.end(count); needed > range.bytes)
    refuse(fmt::format("{} bytes for {} transforms, expected at least {}", range.bytes, count, needed));
  return made;
}

}  // namespace

struct Palettes::Impl {
  const gpu::Context* context = nullptr;
  const Crowd::Impl* crowd = nullptr;
  Controller controller = Controller::adaptive;
  uint32_t herd = 0, generation = 0, entries = 0;
  PaletteOptions options;
  std::vector<gpu::Buffer> starts;  // at each of the herd's sizes
  // Of each format that a target asks for.
  struct Kernels {
    gpu::Kernel instances, palettes;
  };
  std::array<Kernels, 2> kernels;
  // A part's share of a target's range.
  struct Output {
    gpu::Buffer buffer;
    gpu::Bindings bindings;
    shared::TransformConstants constants{};
    uint32_t groups = 0;
  };
  struct Write {
    const gpu::Kernel* kernel;
    std::vector<Output> outputs;
  };
  std::vector<std::vector<Write>> targets;

  gpu::KernelInfo infoOf(TransformFormat format, bool ofPalettes) const;
  const gpu::Kernel& kernelOf(TransformFormat format, bool ofPalettes);
  void add(std::vector<Write>& writes, const TransformRange& range, bool ofPalettes);
};

gpu::KernelInfo Palettes::Impl::infoOf(TransformFormat format, bool ofPalettes) const {
  using namespace shared;
  gpu::KernelInfo info{
      .name = "instances",
      .code = {embedded::instances_comp_texel(), embedded::instances_comp_storage()},
      .bindings = {{TRANSFORM_BODY, BindingKind::load4}, {TRANSFORM_OUT, BindingKind::store}},
      .pushBytes = sizeof(TransformConstants),
      .constants = {{CONSTANT_QUATERNIONS, format == TransformFormat::quaternion}}};
  if (!ofPalettes) return info;
  info.name = "palettes";
  info.code = {embedded::palettes_comp_texel(), embedded::palettes_comp_storage()};
  info.bindings.push_back({TRANSFORM_POSE, BindingKind::load4});
  info.bindings.push_back({TRANSFORM_START, BindingKind::load4});
  info.constants.push_back({CONSTANT_ENTRIES, entries});
  info.constants.push_back({CONSTANT_JOINTS_STRETCH, crowd::traitsOf(controller).playsClips});
  info.constants.push_back({CONSTANT_RELATIVE, options.relative});
  info.constants.push_back({CONSTANT_LOSES_BONES, crowd->kindOf(herd).hurts});
  return info;
}

const gpu::Kernel& Palettes::Impl::kernelOf(TransformFormat format, bool ofPalettes) {
  Kernels& both = kernels[static_cast<size_t>(format)];
  gpu::Kernel& kernel = ofPalettes ? both.palettes : both.instances;
  if (!kernel) kernel = gpu::Kernel(*context, infoOf(format, ofPalettes));
  return kernel;
}

void Palettes::Impl::add(std::vector<Write>& writes, const TransformRange& range, bool ofPalettes) {
  if (range.buffer == VK_NULL_HANDLE) return;
  const char* what = ofPalettes ? "palettes" : "instances";
  if (ofPalettes && !crowd->options.pose)
    throw inputError("palettes of a crowd without poses, expected CrowdOptions::pose");
  if (ofPalettes && range.format == TransformFormat::quaternion && crowd::traitsOf(controller).playsClips)
    throw inputError(
        fmt::format("palettes of herd {}: controller {} poses by matrices, which may stretch, "
                    "expected TransformFormat::matrix",
                    herd, nameOf(controller)));
  const crowd::Herd& from = crowd->herds[herd];
  const uint64_t each = ofPalettes ? entries : 1;
  const Arrangement arrangement = arrangementOf(range, each * from.agents, what);
  const float sizeOfMesh = crowd->kindOf(herd).size;
  // Else the instance's transform scales after them.
  const bool scales = !ofPalettes || !options.relative;
  Write write{.kernel = &kernelOf(range.format, ofPalettes), .outputs = {}};
  for (const Part& part : crowd::partsOf(*crowd, herd)) {
    const auto run = static_cast<size_t>(&from.runOf(part.firstAgent) - from.runs.data());
    // The transforms begin within the binding, whose own beginning is aligned.
    const uint64_t begin = range.offset + 16 * arrangement.stride * each * part.firstAgent;
    const uint64_t slack = begin % std::max<uint64_t>(16, context->limits().minStorageBufferOffsetAlignment);
    const uint64_t count = each * part.agents;
    Output output;
    output.buffer = gpu::Buffer::borrowed(*context, range.buffer, slack + 16 * arrangement.end(count), what,
                                          begin - slack);
    std::vector<gpu::Binding> list{{shared::TRANSFORM_BODY, &part.page->body},
                                   {shared::TRANSFORM_OUT, &output.buffer}};
    if (ofPalettes) {
      list.push_back({shared::TRANSFORM_POSE, &part.page->pose});
      list.push_back({shared::TRANSFORM_START, &starts[run]});
    }
    output.bindings = write.kernel->bind(*context, list);
    const float size = part.kind->size / sizeOfMesh;
    const float units = 1 / options.space.metresPerUnit;
    output.constants = {.rows = {},
                        .how = {0, 0, scales ? units : units / size, options.space.isMirrored() ? -1 : 1},
                        .agents = part.agents,
                        .first = part.first,
                        .base = static_cast<uint32_t>(slack / 16),
                        .stride = static_cast<uint32_t>(arrangement.stride),
                        .plane = static_cast<uint32_t>(arrangement.plane),
                        .size = scales ? size : 1};
    output.groups = gpu::groupsFor(static_cast<uint32_t>(count), shared::WORK_GROUP);
    write.outputs.push_back(std::move(output));
  }
  writes.push_back(std::move(write));
}

Palettes::Palettes(Device& device, const Crowd& crowd, uint32_t herd,
                   const std::vector<PaletteTarget>& targets, const PaletteOptions& options)
    : impl_(std::make_unique<Impl>()) {
  Impl& made = *impl_;
  made.context = &device.context();
  made.crowd = &implOf(crowd);
  const crowd::Kind& kind = made.crowd->kindOf(herd);
  made.controller = kind.controller;
  made.herd = herd;
  made.generation = made.crowd->herds[herd].generation;
  made.entries = entriesOfKind(kind);
  made.options = options;
  crowd::checkSpace(options.space);
  for (const crowd::SizeRun& run : made.crowd->herds[herd].runs) {
    std::vector<glm::vec4> starts(made.entries, glm::vec4(0));
    if (!crowd::traitsOf(made.controller).playsClips) {
      const std::vector<glm::vec3> rest = made.crowd->kinds[run.kind].rig.restStarts();
      std::ranges::transform(rest, starts.begin(),
                             [](const glm::vec3& start) { return glm::vec4(start, 0); });
    }
    gpu::Buffer& buffer =
        made.starts.emplace_back(*made.context, starts.size() * sizeof(glm::vec4), "rest starts");
    gpu::upload(*made.context, buffer, starts);
  }
  for (const PaletteTarget& target : targets) {
    std::vector<Impl::Write>& writes = made.targets.emplace_back();
    made.add(writes, target.instances, false);
    made.add(writes, target.palettes, true);
  }
}

Palettes::~Palettes() = default;
Palettes::Palettes(Palettes&&) noexcept = default;
Palettes& Palettes::operator=(Palettes&&) noexcept = default;

uint32_t Palettes::agentsOf(const Crowd& crowd, uint32_t herd) {
  return implOf(crowd).presentHerdAt(herd).agents;
}
uint32_t Palettes::entriesOf(const Crowd& crowd, uint32_t herd) {
  return entriesOfKind(implOf(crowd).kindOf(herd));
}

void Palettes::record(VkCommandBuffer commandBuffer, const glm::dvec3& origin, uint32_t target) const {
  const Impl& palettes = *impl_;
  if (target >= palettes.targets.size())
    throw inputError(fmt::format("palettes: target {}, expected one of {}", target, palettes.targets.size()));
  palettes.crowd->expectHerd("palettes", {palettes.herd, palettes.generation});
  const glm::dmat3 turn = palettes.options.space.turned();
  const glm::dvec2 tile = glm::floor(glm::dvec2(origin.x, origin.z) / double{shared::TILE_SIZE});
  const glm::dvec3 local = origin - double{shared::TILE_SIZE} * glm::dvec3(tile.x, 0, tile.y);
  const vk::CommandBuffer cmd(commandBuffer);
  gpu::anyToCompute(*palettes.context, cmd);
  for (const Impl::Write& write : palettes.targets[target])
    for (const Impl::Output& output : write.outputs) {
      shared::TransformConstants constants = output.constants;
      for (int row = 0; row < 3; ++row)
        constants.rows[row] = glm::vec4(turn[0][row], turn[1][row], turn[2][row], local[row]);
      constants.how = glm::vec4(tile, constants.how.z, constants.how.w);
      write.kernel->dispatch(cmd, output.bindings, gpu::bytesOf(constants), output.groups);
    }
  gpu::computeToAny(*palettes.context, cmd);
}

}  // namespace skitter
