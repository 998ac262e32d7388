#include "crowd/tint.h"

#include <algorithm>

#include "assets/materials/worn_colours.h"
#include "base/split_mix.h"
#include "render/tint.h"

namespace skitter::crowd {
namespace {

// Keeps what is drawn apart from what the spawner draws by the same seed.
constexpr uint64_t kStream = 0x74696e74;

float uniform(uint64_t seed, uint64_t n) {
  return static_cast<float>(base::SplitMix64::draw(seed, n) >> 40) * 0x1p-24f;
}

double lightnessOf(const glm::vec3& colour) {
  return glm::dot(colour, glm::vec3(shared::RED_LIGHTNESS, shared::GREEN_LIGHTNESS, shared::BLUE_LIGHTNESS));
}

// At an amount of 1/2 as much as agents vary by number.
glm::vec3 variation(float amount, float light, float warm) {
  const float mean = shared::LEAST_VALUE + 0.5f * shared::VALUE_RANGE;
  const float value = mean + 2 * amount * shared::VALUE_RANGE * (light - 0.5f);
  const float warmth = 2 * amount * shared::WARMTH_RANGE * (warm - 0.5f);
  return value * glm::vec3(1 + warmth, 1, 1 - warmth);
}

}  // namespace

float meanLightness(const Kind& kind) {
  const bool clips = !kind.clipSet.vertices.empty();
  const std::vector<SkinVertex>& vertices = clips ? kind.clipSet.vertices : kind.rig.vertices;
  const std::vector<uint32_t>& indices = clips ? kind.clipSet.indices : kind.rig.indices;
  const std::vector<glm::vec3> colours = wornColours(vertices, clips ? kind.clipSet.look : kind.rig.look);
  double area = 0, sum = 0;
  for (size_t i = 0; i + 2 < indices.size(); i += 3) {
    const uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
    const glm::vec3 from = vertices[a].position;
    const double part = glm::length(glm::cross(vertices[b].position - from, vertices[c].position - from));
    area += part;
    sum += part * lightnessOf((colours[a] + colours[b] + colours[c]) / 3.0f);
  }
  return area > 0 ? static_cast<float>(sum / area) : 0;
}

std::vector<glm::vec4> tintsOf(const skitter::Herd& herd, const Part& part, uint64_t seed, float lightness) {
  // A model that is black all over has nothing lighter or darker.
  const glm::vec3 colour = herd.colour ? *herd.colour / std::max(lightness, 1e-4f) : glm::vec3(1);
  const int flags = (herd.colour ? shared::TINT_LIGHTNESS : 0) | (herd.tint ? shared::TINT_VARIED : 0);
  std::vector<glm::vec4> tints;
  for (uint64_t agent = part.firstAgent; agent < uint64_t{part.firstAgent} + part.agents; ++agent) {
    const glm::vec3 own = herd.tint ? variation(*herd.tint, uniform(seed + kStream, 2 * agent + 1),
                                                uniform(seed + kStream, 2 * agent + 2))
                                    : glm::vec3(1);
    tints.emplace_back(colour * own, flags);
  }
  return tints;
}

}  // namespace skitter::crowd
