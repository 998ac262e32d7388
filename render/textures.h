#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gpu/bindings.h"
#include "gpu/graphics.h"
#include "skitter/material.h"

namespace skitter::render {

// The materials of a look on the device: images with their levels, samplers and numbers.
class Textures {
 public:
  // An image that cannot be decoded is left out, and `notes` says why.
  Textures(const gpu::Context&, std::shared_ptr<const Materials>, std::vector<std::string>& notes);

  const std::shared_ptr<const Materials>& materials() const { return materials_; }
  // Which textures a material has, bit by bit in the order of TextureRole: CONSTANT_TEXTURES.
  int has(size_t material) const;
  // Binds the numbers of a material and each of its textures; a white texel where it has none.
  void bind(size_t material, std::vector<gpu::Binding>& list) const;

 private:
  using Key = std::pair<int, bool>;  // of an image, and whether its texels are colours
  void load(const gpu::Context&, const Key&, std::vector<std::string>& notes);
  const gpu::Image* imageOf(size_t material, TextureRole) const;

  std::shared_ptr<const Materials> materials_;
  std::map<Key, gpu::Image> images_;
  gpu::Image white_;
  std::vector<std::pair<TextureSampler, vk::raii::Sampler>> samplers_;
  std::vector<gpu::Buffer> numbers_;  // of each material
};

// Textures of every model that a renderer has drawn. Kinds of one model share them.
class TextureStore {
 public:
  const Textures& of(const gpu::Context&, const std::shared_ptr<const Materials>&);
  // Images that are drawn as flat colours, and why, a line each.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::vector<std::unique_ptr<Textures>> all_;
  std::vector<std::string> notes_;
};

}  // namespace skitter::render
