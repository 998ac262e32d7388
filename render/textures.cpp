#include "render/textures.h"

#include <fmt/format.h>

#include <algorithm>

#include "assets/materials/mip_levels.h"
#include "gpu/transfer.h"
#include "render/bindings.h"
#include "render/material.h"
#include "skitter/error.h"

namespace skitter::render {
namespace {

static_assert(allTextureRoles.size() == shared::TEXTURES);
static_assert(int(TextureRole::baseColour) == shared::BASE_COLOUR);
static_assert(int(TextureRole::metallicRoughness) == shared::METALLIC_ROUGHNESS);
static_assert(int(TextureRole::normal) == shared::NORMAL);
static_assert(int(TextureRole::occlusion) == shared::OCCLUSION);
static_assert(int(TextureRole::emissive) == shared::EMISSIVE);

constexpr float kMostLevels = 32;

gpu::Image uploaded(const gpu::Context& context, std::span<const Texels> levels, TexelKind kind,
                    const std::string& name) {
  gpu::Image image(
      context,
      {.format = kind == TexelKind::srgb ? vk::Format::eR8G8B8A8Srgb : vk::Format::eR8G8B8A8Unorm,
       .extent = {levels[0].width, levels[0].height},
       .usage = vk::ImageUsageFlagBits::eSampled,
       .levels = uint32_t(levels.size())},
      name);
  std::vector<std::span<const std::byte>> bytes;
  for (const Texels& level : levels) bytes.push_back(std::as_bytes(std::span(level.rgba)));
  gpu::uploadLevels(context, image, bytes);
  return image;
}

vk::SamplerAddressMode wrapOf(TextureSampler::Wrap wrap) {
  switch (wrap) {
    case TextureSampler::Wrap::mirror:
      return vk::SamplerAddressMode::eMirroredRepeat;
    case TextureSampler::Wrap::clamp:
      return vk::SamplerAddressMode::eClampToEdge;
    case TextureSampler::Wrap::repeat:
      break;
  }
  return vk::SamplerAddressMode::eRepeat;
}

vk::raii::Sampler samplerOf(const gpu::Context& context, const TextureSampler& from) {
  using Mips = TextureSampler::Mips;
  const auto filter = [](bool nearest) { return nearest ? vk::Filter::eNearest : vk::Filter::eLinear; };
  return gpu::makeSampler(
      context,
      {.name = "texture",
       .filter = filter(from.magNearest),
       .minFilter = filter(from.minNearest),
       .wrapU = wrapOf(from.wrapS),
       .wrapV = wrapOf(from.wrapT),
       .mips = from.mips == Mips::linear ? vk::SamplerMipmapMode::eLinear : vk::SamplerMipmapMode::eNearest,
       // At 0 all texels would count as larger than pixels; a quarter of a level is rounded to none.
       .maxLevel = from.mips == Mips::none ? 0.25f : kMostLevels});
}

shared::MaterialNumbers numbersOf(const Material& from) {
  shared::MaterialNumbers to{};
  to.factors = {from.metallic, from.roughness, from.normalScale, from.occlusionStrength};
  to.emissive = {from.emissive, from.alphaCutoff};
  for (size_t role = 0; role < from.textures.size(); ++role) {
    const std::array<glm::vec3, 2> rows = from.textures[role].rows();
    to.rows[2 * role] = {rows[0], float(from.textures[role].set)};
    to.rows[2 * role + 1] = {rows[1], 0};
  }
  return to;
}

}  // namespace

Textures::Textures(const gpu::Context& context, std::shared_ptr<const Materials> materials,
                   std::vector<std::string>& notes)
    : materials_(std::move(materials)) {
  white_ = uploaded(context, std::array{Texels{1, 1, {255, 255, 255, 255}}}, TexelKind::numbers, "white");
  samplers_.emplace_back(TextureSampler(), samplerOf(context, {}));
  for (const Material& material : materials_->list) {
    for (const TextureRole role : allTextureRoles) {
      const Texture& texture = material.texture(role);
      if (texture.image == -1) continue;
      load(context, {texture.image, isColour(role)}, notes);
      const auto same = [&](const auto& known) { return known.first == texture.sampler; };
      if (std::ranges::none_of(samplers_, same))
        samplers_.emplace_back(texture.sampler, samplerOf(context, texture.sampler));
    }
    gpu::Buffer& buffer =
        numbers_.emplace_back(context, sizeof(shared::MaterialNumbers), "material", gpu::BufferUse::uniform);
    const shared::MaterialNumbers numbers = numbersOf(material);
    gpu::upload(context, buffer, std::span(&numbers, 1));
  }
}

void Textures::load(const gpu::Context& context, const Key& key, std::vector<std::string>& notes) {
  const auto [place, isNew] = images_.try_emplace(key);
  if (!isNew) return;
  const ImageFile& file = materials_->images[size_t(key.first)];
  const TexelKind kind = key.second ? TexelKind::srgb : TexelKind::numbers;
  try {
    const std::vector<Texels> levels = mipLevels(decodeImage(file), kind);
    // A device that draws no image of this size begins with a smaller level.
    const uint32_t most = context.limits().maxImageDimension2D;
    const auto first = std::ranges::find_if(
        levels, [&](const Texels& level) { return std::max(level.width, level.height) <= most; });
    place->second = uploaded(context, {first, levels.end()}, kind, file.name);
  } catch (const Error& error) {
    if (error.kind() != Error::Kind::input) throw;
    const std::string note = fmt::format("{}: drawn as a flat colour", error.what());
    if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
  }
}

const gpu::Image* Textures::imageOf(size_t material, TextureRole role) const {
  const auto found = images_.find({materials_->list[material].texture(role).image, isColour(role)});
  return found != images_.end() && found->second ? &found->second : nullptr;
}

int Textures::has(size_t material) const {
  int bits = 0;
  for (const TextureRole role : allTextureRoles)
    if (imageOf(material, role)) bits |= 1 << int(role);
  return bits;
}

void Textures::bind(size_t material, std::vector<gpu::Binding>& list) const {
  list.push_back({shared::DRAW_MATERIAL, &numbers_[material]});
  for (const TextureRole role : allTextureRoles) {
    const TextureSampler& sampler = materials_->list[material].texture(role).sampler;
    const auto found =
        std::ranges::find_if(samplers_, [&](const auto& known) { return known.first == sampler; });
    const gpu::Image* image = imageOf(material, role);
    list.push_back({uint32_t(shared::DRAW_TEXTURES + int(role)), image ? image : &white_,
                    found != samplers_.end() ? *found->second : *samplers_.front().second});
  }
}

const Textures& TextureStore::of(const gpu::Context& context,
                                 const std::shared_ptr<const Materials>& materials) {
  for (const std::unique_ptr<Textures>& known : all_)
    if (known->materials() == materials || *known->materials() == *materials) return *known;
  return *all_.emplace_back(std::make_unique<Textures>(context, materials, notes_));
}

}  // namespace skitter::render
