#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "gpu/buffer.h"
#include "shared/bindings.h"
#include "skitter/crowd.h"

// Levels of rate (docs/levels.md).
namespace skitter::crowd {

struct Kind;
struct Page;

struct RateLevels {
  Levels levels;
  std::optional<std::array<int32_t, 3>> camera;  // quarter metres; none before the first
  gpu::Buffer words;                             // shaders/shared/levels.h

  RateLevels(const gpu::Context& context, const Levels& levels);
  // Throws Error(input).
  static void expectFinite(const glm::vec3& camera);
  void look(const glm::vec3& from);
  // Forgets what tick `tick` will count; before the barrier from transfers to compute shaders.
  void clear(uint64_t tick, vk::CommandBuffer cmd) const;
  // The constants of stage wake.
  shared::TickConstants constantsOf(const Crowd::Impl& crowd, const Page& page, uint64_t tick) const;
};

// Throws Error(input) that names what levels of rate are not made for.
void expectLevelled(const CrowdOptions& options);

}  // namespace skitter::crowd
