#include "render/crowd_drawing.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <numeric>

#include "crowd/controller.h"
#include "embedded/crowd_frag.h"
#include "embedded/crowd_vert_storage.h"
#include "embedded/crowd_vert_texel.h"
#include "embedded/cutout_frag.h"
#include "embedded/cutout_vert_storage.h"
#include "embedded/cutout_vert_texel.h"
#include "embedded/fading_cutout_frag.h"
#include "embedded/fading_cutout_vert_storage.h"
#include "embedded/fading_cutout_vert_texel.h"
#include "embedded/fading_frag.h"
#include "embedded/fading_shadow_frag.h"
#include "embedded/fading_shadow_vert_storage.h"
#include "embedded/fading_shadow_vert_texel.h"
#include "embedded/fading_vert_storage.h"
#include "embedded/fading_vert_texel.h"
#include "embedded/fading_worn_frag.h"
#include "embedded/fading_worn_vert_storage.h"
#include "embedded/fading_worn_vert_texel.h"
#include "embedded/lit_frag.h"
#include "embedded/lit_vert_storage.h"
#include "embedded/lit_vert_texel.h"
#include "embedded/shadow_vert_storage.h"
#include "embedded/shadow_vert_texel.h"
#include "embedded/worn_frag.h"
#include "embedded/worn_vert_storage.h"
#include "embedded/worn_vert_texel.h"
#include "gpu/transfer.h"
#include "render/bindings.h"
#include "render/material.h"
#include "skitter/error.h"

namespace skitter::render {
namespace {

// The level that each list of shadows draws: their outline forgives much.
constexpr int kOtherLod[shared::CONTACTS - shared::CAMERA_LODS] = {2, 3, 4};
// The lists of each cascade.
constexpr std::array kNearLists{shared::NEAR_FINE, shared::NEAR_COARSE};
constexpr std::array kFarLists{shared::FAR_SHADOWS};

using gpu::BindingKind;

std::vector<gpu::VertexStream> streams(bool shaded) {
  using F = vk::Format;
  const auto influence = [](uint32_t i) {
    return uint32_t(offsetof(MeshVertex, influences) + i * sizeof(glm::vec4));
  };
  gpu::VertexStream vertices{.stride = sizeof(MeshVertex),
                             .rate = vk::VertexInputRate::eVertex,
                             .attributes = {{1, F::eR16G16B16A16Uint, offsetof(MeshVertex, bones)}}};
  for (uint32_t i = 0; i < 4; ++i)
    vertices.attributes.push_back({2 + i, F::eR32G32B32A32Sfloat, influence(i)});
  vertices.attributes.push_back({6, F::eR32G32B32Sfloat, offsetof(MeshVertex, normal)});
  vertices.attributes.push_back({7, F::eR32Sfloat, offsetof(MeshVertex, halfWidth)});
  if (shaded) vertices.attributes.push_back({8, F::eR32G32B32Sfloat, offsetof(MeshVertex, colour)});
  return {vertices,
          {.stride = sizeof(uint32_t),
           .rate = vk::VertexInputRate::eInstance,
           .attributes = {{0, F::eR32Uint, 0}}}};
}

// The vertices as materials see them, after the other streams.
gpu::VertexStream wornStream(bool shaded) {
  using F = vk::Format;
  gpu::VertexStream stream{.stride = sizeof(MaterialVertex),
                           .rate = vk::VertexInputRate::eVertex,
                           .attributes = {{9, F::eR32G32B32A32Sfloat, offsetof(MaterialVertex, uv)},
                                          {11, F::eR32Sfloat, offsetof(MaterialVertex, opacity)}}};
  if (shaded) stream.attributes.push_back({10, F::eR32G32B32A32Sfloat, offsetof(MaterialVertex, tangent)});
  return stream;
}

void addTextures(gpu::GraphicsInfo& info, const Material& material, int has) {
  info.bindings.push_back({shared::DRAW_MATERIAL, BindingKind::uniform});
  for (int role = 0; role < shared::TEXTURES; ++role)
    info.bindings.push_back({uint32_t(shared::DRAW_TEXTURES + role), BindingKind::texture});
  info.constants.push_back({shared::CONSTANT_TEXTURES, has});
  info.constants.push_back({shared::CONSTANT_CUTOUT, material.alphaCutoff > 0});
}

gpu::GraphicsPipeline drawPipeline(const Setting& s, gpu::GraphicsInfo info) {
  info.colour = s.colour;
  info.depth = s.depth;
  info.samples = s.samples;
  std::ranges::copy(s.lit(), std::back_inserter(info.constants));
  return {s.context, info};
}

// Both faces cast: a closed skin loses nothing by it, an open one keeps its shadow.
gpu::GraphicsInfo shadowInfo(const Setting& s, int influences, const CrowdForms& forms) {
  return {.name = "crowd shadow",
          .vertex = {embedded::shadow_vert_texel(), embedded::shadow_vert_storage()},
          .fragment = {},
          .bindings = {{shared::DRAW_PICTURE, BindingKind::uniform},
                       {shared::DRAW_BODY, BindingKind::load4},
                       {shared::DRAW_POSE, BindingKind::load4}},
          .pushBytes = sizeof(shared::CrowdConstants),
          .streams = streams(false),
          .depth = s.shadow.image().format(),
          .depthUse = gpu::DepthUse::shadow,
          .cull = {},
          .constants = {{shared::CONSTANT_INFLUENCES, influences},
                        {shared::CONSTANT_MATRICES, forms.matrices},
                        {shared::CONSTANT_STUMPS, forms.stumps}}};
}

// The same pipeline with other shaders.
gpu::GraphicsInfo shadedBy(gpu::GraphicsInfo info, const char* name, gpu::ShaderCode vertex,
                           gpu::ShaderCode fragment) {
  info.name = name;
  info.vertex = vertex;
  info.fragment = fragment;
  return info;
}

// The same for a material that lets light through.
gpu::GraphicsInfo cutoutInfo(const Setting& s, int influences, const CrowdForms& forms,
                             const Material& material, int has) {
  gpu::GraphicsInfo info =
      shadedBy(shadowInfo(s, influences, forms), "cutout shadow",
               {embedded::cutout_vert_texel(), embedded::cutout_vert_storage()}, embedded::cutout_frag());
  info.streams.push_back(wornStream(false));
  addTextures(info, material, has);
  return info;
}

// The same of what goes over to splats.
gpu::GraphicsInfo fadingShading(int influences, const CrowdForms& forms) {
  return shadedBy(crowdShading(influences, forms), "fading crowd",
                  {embedded::fading_vert_texel(), embedded::fading_vert_storage()}, embedded::fading_frag());
}

gpu::GraphicsInfo fadingShadowInfo(const Setting& s, int influences, const CrowdForms& forms) {
  return shadedBy(shadowInfo(s, influences, forms), "fading shadow",
                  {embedded::fading_shadow_vert_texel(), embedded::fading_shadow_vert_storage()},
                  embedded::fading_shadow_frag());
}

gpu::GraphicsInfo fadingWornShading(int influences, const CrowdForms& forms, const Material& material,
                                    int has) {
  return shadedBy(wornShading(influences, forms, material, has), "fading worn crowd",
                  {embedded::fading_worn_vert_texel(), embedded::fading_worn_vert_storage()},
                  embedded::fading_worn_frag());
}

gpu::GraphicsInfo fadingCutoutInfo(const Setting& s, int influences, const CrowdForms& forms,
                                   const Material& material, int has) {
  return shadedBy(cutoutInfo(s, influences, forms, material, has), "fading cutout shadow",
                  {embedded::fading_cutout_vert_texel(), embedded::fading_cutout_vert_storage()},
                  embedded::fading_cutout_frag());
}

CrowdForms formsOf(const crowd::Kind& kind) {
  return {
      .matrices = crowd::traitsOf(kind.controller).playsClips, .tinted = kind.tinted, .stumps = kind.hurts};
}

// The lists of those whom the picture shows, though the last one did not.
constexpr std::array kLaterLists{shared::LATER,     shared::LATER + 1, shared::LATER + 2,
                                 shared::LATER + 3, shared::LATER + 4, shared::LATER + 5};
static_assert(kLaterLists.size() == shared::CAMERA_LISTS);
// All that draw meshes.
constexpr auto kMeshLists = [] {
  std::array<int, shared::INSTANCE_LISTS - 3> lists{};
  size_t count = 0;
  for (int list = 0; list < shared::INSTANCE_LISTS; ++list)
    if (list != shared::CONTACTS && list != shared::SPLATS && list != shared::SHOWN) lists[count++] = list;
  return lists;
}();
// Without occlusion there are those before its own.
constexpr size_t kPlainMeshLists =
    size_t(std::ranges::find(kMeshLists, shared::FIRST_LOOK) - kMeshLists.begin());
// The level that a list draws: of the camera's each its own; what fades goes on as it was.
int levelOf(int list) {
  if (list >= shared::FIRST_LOOK)
    return levelOf(shared::cameraList((list - shared::FIRST_LOOK) % shared::CAMERA_LISTS));
  if (list == shared::FADING) return shared::FIRST_VERTEX_LIT;
  if (list == shared::NEAR_FADING) return levelOf(shared::NEAR_COARSE);
  if (list == shared::FAR_FADING) return levelOf(shared::FAR_SHADOWS);
  return list < shared::CAMERA_LODS ? list : kOtherLod[list - shared::CAMERA_LODS];
}

// The place of a part's draw in a list among those of a kind with so many parts.
size_t partDraw(size_t parts, int list, size_t part) { return size_t(list) * parts + part; }

VkDrawIndexedIndirectCommand commandOf(const MeshLod& lod) {
  return {.indexCount = lod.indexCount,
          .instanceCount = 0,
          .firstIndex = lod.firstIndex,
          .vertexOffset = lod.firstVertex,
          .firstInstance = 0};
}

}  // namespace

gpu::GraphicsInfo crowdShading(int influences, const CrowdForms& forms) {
  return {.name = "crowd",
          .vertex = {embedded::crowd_vert_texel(), embedded::crowd_vert_storage()},
          .fragment = embedded::crowd_frag(),
          .bindings = {{shared::DRAW_PICTURE, BindingKind::uniform},
                       {shared::DRAW_BODY, BindingKind::load4},
                       {shared::DRAW_POSE, BindingKind::load4},
                       {shared::DRAW_TINT, BindingKind::load4},
                       {shared::DRAW_GROUND, BindingKind::texture},
                       {shared::DRAW_SHADOW, BindingKind::texture}},
          .pushBytes = sizeof(shared::CrowdConstants),
          .streams = streams(true),
          .constants = {{shared::CONSTANT_INFLUENCES, influences},
                        {shared::CONSTANT_MATRICES, forms.matrices},
                        {shared::CONSTANT_TINTED, forms.tinted},
                        {shared::CONSTANT_STUMPS, forms.stumps}}};
}

gpu::GraphicsInfo litShading(int influences, const CrowdForms& forms) {
  return shadedBy(crowdShading(influences, forms), "crowd lit at its vertices",
                  {embedded::lit_vert_texel(), embedded::lit_vert_storage()}, embedded::lit_frag());
}

gpu::GraphicsInfo wornShading(int influences, const CrowdForms& forms, const Material& material, int has) {
  gpu::GraphicsInfo info =
      shadedBy(crowdShading(influences, forms), "worn crowd",
               {embedded::worn_vert_texel(), embedded::worn_vert_storage()}, embedded::worn_frag());
  info.streams.push_back(wornStream(true));
  addTextures(info, material, has);
  if (material.doubleSided) info.cull = {};
  return info;
}

CrowdDrawing::CrowdDrawing(const Setting& s, const Crowd::Impl& crowd, TextureStore& store)
    : cull_(s.context, s.detail), occlusion_(s) {
  if (crowd.rates) interpolation_ = Interpolation(s.context);
  for (const crowd::Kind& source : crowd.kinds) {
    Kind kind;
    if (source.pages.empty()) {  // of a herd that is gone; kinds keep their numbers
      kinds_.push_back(std::move(kind));
      continue;
    }
    const bool clips = crowd::traitsOf(source.controller).playsClips;
    if (!crowd.options.pose && source.controller != Controller::clip)
      throw inputError(
          "a crowd that is drawn needs CrowdOptions::pose, unless its herds' controller is clip");
    const Look& look = clips ? source.clipSet.look : source.rig.look;
    const Textures* textures = look ? &store.of(s.context, look.materials) : nullptr;
    const Limbs limbs = limbsOf(source);
    kind.palette = uint32_t(clips ? source.clips.joints : source.rig.paletteSize());
    const MeshData mesh = clips ? makeMesh(source.clipSet, limbs) : makeMesh(source.rig, limbs);
    kind.mesh = uploadMesh(s.context, mesh, source.rig.name);
    if (occlusion_) kind.occlusion = occlusion_.makeKind(s, source, mesh, kind.palette);
    const int influences = kind.mesh.influences;
    kind.passes[kDraw] = drawPipeline(s, crowdShading(influences, formsOf(source)));
    kind.passes[kShadow] = {s.context, shadowInfo(s, influences, formsOf(source))};
    kind.lit = drawPipeline(s, litShading(influences, formsOf(source)));
    kind.contact = Contact(s, source, limbs);
    if (!splats_) splats_ = Splats(s);
    kind.splat = splats_.makeKind(s, source, limbs, kind.mesh.radius);
    if (kind.splat) {
      kind.passes[kFading] = drawPipeline(s, fadingShading(influences, formsOf(source)));
      kind.passes[kFadingShadow] = {s.context, fadingShadowInfo(s, influences, formsOf(source))};
    }
    if (!crowd.options.pose) kind.clipPoses = ClipPoses(s.context, source, bool(interpolation_));
    if (textures) makeParts(s, source, *textures, kind);
    for (const crowd::Page& records : source.pages) {
      if (records.agents == 0) continue;
      Page page;
      page.firstAgent = records.firstAgent;
      const Interpolation::Source live{records.body, records.pose, records.rate, clips};
      if (interpolation_) page.shown = interpolation_.makePage(s.context, live);
      const gpu::Buffer& body = interpolation_ ? page.shown.body : records.body;
      if (kind.clipPoses) page.clipPoses = kind.clipPoses.makePoses(s.context, records.agents);
      const gpu::Buffer& pose = kind.clipPoses   ? page.clipPoses
                                : interpolation_ ? page.shown.pose
                                                 : records.pose;
      const gpu::Buffer& tint = source.tinted ? records.tint : body;
      const bool listsShown = interpolation_ || kind.clipPoses;
      page.culled = cull_.makePage(s.context, s.picture, body, records.agents, listsShown, bool(occlusion_));
      if (occlusion_) page.occlusion = occlusion_.makePage(s, kind.occlusion, body, pose, page.culled);
      if (interpolation_) interpolation_.bindLists(s.context, live, page.culled, page.shown);
      if (kind.clipPoses)
        page.posesClips = kind.clipPoses.bind(s.context, source, records, body, page.culled, pose);
      const std::vector<gpu::Binding> shadow{
          {shared::DRAW_PICTURE, &s.picture}, {shared::DRAW_BODY, &body}, {shared::DRAW_POSE, &pose}};
      std::vector<gpu::Binding> draw = shadow;
      draw.push_back({shared::DRAW_TINT, &tint});
      draw.push_back({shared::DRAW_GROUND, &s.ground, s.groundSampler});
      draw.push_back({shared::DRAW_SHADOW, &s.shadow.image(), s.shadow.sampler()});
      const ByPass<std::vector<gpu::Binding>> lists{draw, draw, shadow, shadow};
      for (size_t pass = 0; pass < kPasses; ++pass)
        if (kind.passes[pass]) page.passes[pass] = kind.passes[pass].bind(s.context, lists[pass]);
      page.lit = kind.lit.bind(s.context, draw);
      if (kind.splat) page.splat = splats_.bind(s, kind.splat, body, pose, tint, page.culled);
      if (kind.contact) page.contact = kind.contact.makePage(s, body, pose);
      if (!kind.parts.empty()) bindParts(s, *textures, lists, kind, page);
      kind.pages.push_back(std::move(page));
    }
    kinds_.push_back(std::move(kind));
  }
}

void CrowdDrawing::makeParts(const Setting& s, const crowd::Kind& source, const Textures& textures,
                             Kind& kind) const {
  const CrowdForms forms = formsOf(source);
  for (const MeshPart& from : kind.mesh.parts) {
    Part& part = kind.parts.emplace_back();
    if (from.material == -1) continue;
    const Material& material = textures.materials()->list[size_t(from.material)];
    const int has = textures.has(size_t(from.material));
    const bool cutout = material.alphaCutoff > 0;
    const auto same = std::ranges::find_if(kind.worn, [&](const Worn& known) {
      return known.textures == has && known.cutout == cutout && known.doubleSided == material.doubleSided;
    });
    part.worn = int(same - kind.worn.begin());
    if (same != kind.worn.end()) continue;
    Worn& worn = kind.worn.emplace_back();
    worn.textures = has;
    worn.cutout = cutout;
    worn.doubleSided = material.doubleSided;
    const int influences = kind.mesh.influences;
    worn.passes[kDraw] = drawPipeline(s, wornShading(influences, forms, material, has));
    if (cutout) worn.passes[kShadow] = {s.context, cutoutInfo(s, influences, forms, material, has)};
    if (!kind.splat) continue;
    worn.passes[kFading] = drawPipeline(s, fadingWornShading(influences, forms, material, has));
    if (cutout)
      worn.passes[kFadingShadow] = {s.context, fadingCutoutInfo(s, influences, forms, material, has)};
  }
}

const gpu::GraphicsPipeline* CrowdDrawing::wornOf(const Kind& kind, size_t part, Pass pass) {
  const int worn = kind.parts[part].worn;
  if (worn == -1) return nullptr;
  const gpu::GraphicsPipeline& pipeline = kind.worn[size_t(worn)].passes[pass];
  return pipeline ? &pipeline : nullptr;
}

// Part draws never change but for their counts of agents, which countParts() copies.
void CrowdDrawing::bindParts(const Setting& s, const Textures& textures,
                             const ByPass<std::vector<gpu::Binding>>& lists, const Kind& kind,
                             Page& page) const {
  for (size_t p = 0; p < kind.parts.size(); ++p) {
    ByPass<gpu::Bindings>& bindings = page.parts.emplace_back();
    for (const Pass pass : {kDraw, kFading, kShadow, kFadingShadow}) {
      const gpu::GraphicsPipeline* pipeline = wornOf(kind, p, pass);
      if (pipeline == nullptr) continue;
      std::vector<gpu::Binding> list = lists[pass];
      textures.bind(size_t(kind.mesh.parts[p].material), list);
      bindings[pass] = pipeline->bind(s.context, list);
    }
  }
  std::vector<VkDrawIndexedIndirectCommand> draws(size_t(meshLists().back() + 1) * kind.parts.size());
  for (const int list : meshLists())
    for (size_t p = 0; p < kind.parts.size(); ++p)
      draws[partDraw(kind.parts.size(), list, p)] = commandOf(kind.mesh.parts[p].lods[size_t(levelOf(list))]);
  page.partDraws =
      gpu::Buffer(s.context, draws.size() * sizeof draws[0], "part draws", gpu::BufferUse::indirect);
  gpu::upload(s.context, page.partDraws, draws);
}

void CrowdDrawing::prepare(vk::CommandBuffer cmd) const {
  for (const Kind& kind : kinds_)
    for (const Page& page : kind.pages) {
      VkDrawIndexedIndirectCommand draws[shared::INSTANCE_LISTS] = {};
      for (const int list : meshLists()) draws[list] = commandOf(kind.mesh.lods[size_t(levelOf(list))]);
      for (const int list : {shared::SPLATS, shared::SHOWN})
        draws[list] = std::bit_cast<VkDrawIndexedIndirectCommand>(ListDispatch{});
      cmd.updateBuffer(page.culled.commands.handle(), 0, sizeof draws, draws);
    }
  if (hasSplats()) splats_.prepare(cmd);
}

void CrowdDrawing::cull(vk::CommandBuffer cmd, const Crowd::Impl& crowd) {
  const auto interpolated = [&](const Kind& kind, const Page& page) -> shared::InterpolationConstants {
    return {.agents = page.culled.agents,
            .palette = kind.palette,
            .tick = float(crowd.tick),
            .before = before_ ? float(*before_) : -1};
  };
  if (interpolation_) {
    for (const Kind& kind : kinds_)
      for (const Page& page : kind.pages)
        interpolation_.recordBodies(cmd, page.shown, interpolated(kind, page));
    gpu::computeToCompute(cmd);
  }
  for (const Kind& kind : kinds_)
    for (const Page& page : kind.pages) cull_.record(cmd, page.culled, kind.mesh.radius, bool(kind.splat));
  if (occlusion_) {
    gpu::computeToCompute(cmd);
    for (const Kind& kind : kinds_)
      for (const Page& page : kind.pages) occlusion_.lookFirst(cmd, page.culled, page.occlusion);
  }
  if (!interpolation_ && std::ranges::none_of(kinds_, [](const Kind& kind) { return bool(kind.clipPoses); }))
    return;
  gpu::computeToIndirectAndCompute(cmd);
  for (size_t k = 0; k < kinds_.size(); ++k)
    for (const Page& page : kinds_[k].pages) {
      if (kinds_[k].clipPoses)
        kinds_[k].clipPoses.record(cmd, page.posesClips, crowd.kinds[k], page.culled, crowd.tick);
      else
        interpolation_.recordPoses(cmd, page.shown, page.culled, interpolated(kinds_[k], page));
    }
  if (interpolation_) before_ = crowd.tick;
}

void CrowdDrawing::splat(vk::CommandBuffer cmd) const {
  if (!hasSplats()) return;
  gpu::computeToIndirectAndCompute(cmd);
  for (uint32_t k = 0; k < kinds_.size(); ++k)
    if (kinds_[k].splat)
      for (const Page& page : kinds_[k].pages)
        splats_.record(cmd, kinds_[k].splat, page.splat, page.culled,
                       constantsOf(k, page, shared::VIEW_CAMERA));
}

void CrowdDrawing::countParts(vk::CommandBuffer cmd) const { countParts(cmd, meshLists(), true); }

void CrowdDrawing::countParts(vk::CommandBuffer cmd, std::span<const int> lists, bool contacts) const {
  const auto hasContacts = [&](const Kind& kind) { return contacts && kind.contact; };
  const auto counts = [&](const Kind& kind) { return !kind.parts.empty() || hasContacts(kind); };
  if (std::none_of(kinds_.begin(), kinds_.end(), counts)) return;
  constexpr vk::DeviceSize stride = sizeof(VkDrawIndexedIndirectCommand);
  constexpr vk::DeviceSize count = offsetof(VkDrawIndexedIndirectCommand, instanceCount);
  gpu::computeToTransfer(cmd);
  for (const Kind& kind : kinds_) {
    std::vector<vk::BufferCopy> copies;
    for (const int list : lists)
      for (size_t part = 0; part < kind.parts.size(); ++part)
        copies.push_back({.srcOffset = vk::DeviceSize(list) * stride + count,
                          .dstOffset = partDraw(kind.parts.size(), list, part) * stride + count,
                          .size = sizeof(uint32_t)});
    for (const Page& page : kind.pages) {
      if (hasContacts(kind)) kind.contact.count(cmd, page.contact, page.culled);
      if (!copies.empty()) cmd.copyBuffer(page.culled.commands.handle(), page.partDraws.handle(), copies);
    }
  }
  gpu::transferToGraphics(cmd);
}

void CrowdDrawing::drawShadows(vk::CommandBuffer cmd, int cascade) const {
  const bool isNear = cascade == 0;
  const std::array fading{isNear ? shared::NEAR_FADING : shared::FAR_FADING};
  const auto lists = isNear ? std::span<const int>(kNearLists) : std::span<const int>(kFarLists);
  for (uint32_t k = 0; k < kinds_.size(); ++k)
    for (const Page& page : kinds_[k].pages) {
      const shared::CrowdConstants constants = constantsOf(k, page, shared::VIEW_CAMERA + 1 + cascade);
      if (kinds_[k].splat) drawPass(cmd, kinds_[k], page, kFadingShadow, fading, constants);
      drawPass(cmd, kinds_[k], page, kShadow, lists, constants);
    }
}

shared::CrowdConstants CrowdDrawing::constantsOf(uint32_t kind, const Page& page, int view) const {
  return {
      .view = uint32_t(view), .palette = kinds_[kind].palette, .firstAgent = page.firstAgent, .kind = kind};
}

std::span<const int> CrowdDrawing::meshLists() const {
  return std::span(kMeshLists).first(occlusion_ ? kMeshLists.size() : kPlainMeshLists);
}

bool CrowdDrawing::hasSplats() const {
  return std::ranges::any_of(kinds_, [](const Kind& kind) { return kind.splat && !kind.pages.empty(); });
}

bool CrowdDrawing::hasAgents() const {
  return std::ranges::any_of(kinds_, [](const Kind& kind) { return !kind.pages.empty(); });
}

PictureCounts CrowdDrawing::counts(const gpu::Context& context) const {
  PictureCounts counts;
  for (const Kind& kind : kinds_)
    for (const Page& page : kind.pages) {
      const auto draws = gpu::download<VkDrawIndexedIndirectCommand>(context, page.culled.commands);
      const auto count = [&](int list) { return draws[size_t(list)].instanceCount; };
      for (int i = 0; i < shared::CAMERA_LISTS; ++i) {
        const int list = shared::cameraList(i);
        const int first = shared::FIRST_LOOK + i, later = shared::LATER + i;
        const uint32_t drawn = occlusion_ ? count(first) + count(later) : count(list);
        counts.triangles += uint64_t(drawn) * (draws[size_t(list)].indexCount / 3);
        if (list == shared::FADING) continue;  // its agents are splats, too
        counts.agents += count(list);
        counts.hidden += count(list) - drawn;
      }
      counts.agents += draws[shared::SPLATS].instanceCount;
      counts.splats += draws[shared::SPLATS].instanceCount;
    }
  return counts;
}

void CrowdDrawing::draw(vk::CommandBuffer cmd) const {
  if (hasSplats()) splats_.draw(cmd);
  if (occlusion_)
    drawCamera(cmd, shared::FIRST_LOOK, shared::FIRST_LOOK + shared::CAMERA_LODS);
  else
    drawCamera(cmd, 0, shared::FADING);
}

void CrowdDrawing::lookAgain(vk::CommandBuffer cmd) const {
  gpu::graphicsToCompute(cmd);  // who has been drawn is on lists of the same buffers
  occlusion_.makePyramid(cmd);
  for (const Kind& kind : kinds_)
    for (const Page& page : kind.pages)
      occlusion_.lookAgain(cmd, kind.occlusion, page.culled, page.occlusion);
  gpu::computeToGraphics(cmd);
  countParts(cmd, kLaterLists, false);
}

void CrowdDrawing::drawLater(vk::CommandBuffer cmd) const {
  drawCamera(cmd, kLaterLists.front(), kLaterLists.back());
}

void CrowdDrawing::drawCamera(vk::CommandBuffer cmd, int firstLevel, int fading) const {
  std::array<int, shared::CAMERA_LODS> levels;
  std::iota(levels.begin(), levels.end(), firstLevel);
  for (uint32_t k = 0; k < kinds_.size(); ++k)
    for (const Page& page : kinds_[k].pages) {
      const shared::CrowdConstants constants = constantsOf(k, page, shared::VIEW_CAMERA);
      drawPass(cmd, kinds_[k], page, kDraw, levels, constants);
      if (kinds_[k].splat) drawPass(cmd, kinds_[k], page, kFading, std::array{fading}, constants);
    }
}

void CrowdDrawing::drawPass(vk::CommandBuffer cmd, const Kind& kind, const Page& page, Pass pass,
                            std::span<const int> lists, const shared::CrowdConstants& constants) const {
  const auto useOwn = [&](int list) {
    if (list == lists.front()) kind.passes[pass].use(cmd, page.passes[pass], gpu::bytesOf(constants));
    if (pass == kDraw && levelOf(list) == shared::FIRST_VERTEX_LIT)
      kind.lit.use(cmd, page.lit, gpu::bytesOf(constants));
  };
  if (std::ranges::none_of(kind.worn, [&](const Worn& worn) { return bool(worn.passes[pass]); })) {
    for (const int list : lists) {
      useOwn(list);
      drawList(cmd, kind, page, list);
    }
    return;
  }
  for (size_t p = 0; p < kind.parts.size(); ++p) {
    const gpu::GraphicsPipeline* worn = wornOf(kind, p, pass);
    if (worn) worn->use(cmd, page.parts[p][pass], gpu::bytesOf(constants));
    for (const int list : lists) {
      if (!worn) useOwn(list);
      drawListPart(cmd, kind, page, list, p);
    }
  }
}

void CrowdDrawing::drawContacts(vk::CommandBuffer cmd) const {
  if (hasSplats()) splats_.drawShades(cmd);
  for (const Kind& kind : kinds_)
    if (kind.contact)
      for (const Page& page : kind.pages) kind.contact.draw(cmd, page.contact, page.culled, kind.palette);
}

void CrowdDrawing::bindBuffers(vk::CommandBuffer cmd, const Kind& kind, const Page& page, int list) const {
  // The list's place comes by the vertex buffer's offset: firstInstance in an indirect draw is optional in
  // Vulkan.
  const vk::DeviceSize place = vk::DeviceSize(list) * page.culled.agents * sizeof(uint32_t);
  const std::array buffers{kind.mesh.vertices.handle(), page.culled.instances.handle(),
                           kind.mesh.worn ? kind.mesh.worn.handle() : vk::Buffer()};
  const std::array<vk::DeviceSize, 3> offsets{0, place, 0};
  cmd.bindVertexBuffers(0, kind.mesh.worn ? 3 : 2, buffers.data(), offsets.data());
  cmd.bindIndexBuffer(kind.mesh.indices.handle(), 0, vk::IndexType::eUint32);
}

void CrowdDrawing::drawList(vk::CommandBuffer cmd, const Kind& kind, const Page& page, int list) const {
  bindBuffers(cmd, kind, page, list);
  cmd.drawIndexedIndirect(page.culled.commands.handle(),
                          vk::DeviceSize(list) * sizeof(VkDrawIndexedIndirectCommand), 1,
                          sizeof(VkDrawIndexedIndirectCommand));
}

void CrowdDrawing::drawListPart(vk::CommandBuffer cmd, const Kind& kind, const Page& page, int list,
                                size_t part) const {
  if (kind.mesh.parts[part].lods[size_t(levelOf(list))].indexCount == 0) return;
  bindBuffers(cmd, kind, page, list);
  cmd.drawIndexedIndirect(page.partDraws.handle(),
                          partDraw(kind.parts.size(), list, part) * sizeof(VkDrawIndexedIndirectCommand), 1,
                          sizeof(VkDrawIndexedIndirectCommand));
}

}  // namespace skitter::render
