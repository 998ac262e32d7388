#pragma once

#include <fmt/format.h>

#include <concepts>
#include <exception>
#include <glm/glm.hpp>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "bindings/c/skitter.h"
#include "bindings/common/herd_reader.h"
#include "bindings/common/walk.h"
#include "skitter/crowd.h"
#include "skitter/error.h"
#include "skitter/ik.h"
#include "skitter/palettes.h"
#include "skitter/readback.h"
#include "skitter/renderer.h"
#include "skitter/skin_mesh.h"
#include "skitter/spline.h"
#include "skitter/state.h"

// What is behind the handles. Members are destroyed last first: what is made on a device before its share of
// it.

namespace skitter::c {

// A crowd, with what makes its ticks. The handles of whatever reads and draws it share it.
struct LiveCrowd {
  std::shared_ptr<Device> device;
  Crowd crowd;
  bindings::Walk walk;
};

}  // namespace skitter::c

struct skitter_device {
  std::shared_ptr<skitter::Device> device;
};

struct skitter_scene {
  skitter::Scene scene;
};

struct skitter_crowd {
  std::shared_ptr<skitter::c::LiveCrowd> live;
};

struct skitter_readback {
  std::shared_ptr<skitter::c::LiveCrowd> live;
  skitter::Readback readback;
  std::optional<skitter::Snapshot> taken = {};
};

struct skitter_palettes {
  std::shared_ptr<skitter::c::LiveCrowd> live;
  skitter::Palettes palettes;
  size_t targets;
};

struct skitter_skin_mesh {
  skitter::SkinMesh mesh;
};

struct skitter_renderer {
  std::shared_ptr<skitter::c::LiveCrowd> live;
  skitter::Renderer renderer;
  bool drawn = false;
};

struct skitter_state {
  skitter::State state;
};

struct skitter_ik_batch {
  std::shared_ptr<skitter::Device> device;
  skitter::ik::Batch batch;
};

struct skitter_spline_batch {
  std::shared_ptr<skitter::Device> device;
  skitter::SplineBatch batch;
};

namespace skitter::c {

// Keeps the message for skitter_last_error().
void remember(const char* message) noexcept;

// Runs `call`; an exception becomes a result.
template <std::invocable Call>
skitter_result guarded(Call&& call) noexcept {
  try {
    call();
    return SKITTER_OK;
  } catch (const Error& error) {
    remember(error.what());
    return error.kind() == Error::Kind::device ? SKITTER_ERROR_DEVICE : SKITTER_ERROR_INPUT;
  } catch (const std::bad_alloc&) {
    remember("the host has no memory left");
    return SKITTER_ERROR_MEMORY;
  } catch (const std::exception& error) {
    remember(error.what());
    return SKITTER_ERROR_OTHER;
  } catch (...) {
    remember("an unknown fault");
    return SKITTER_ERROR_OTHER;
  }
}

// Throws Error(input) for NULL; else what it points at.
template <typename Pointee>
Pointee& given(Pointee* pointer, const char* name) {
  if (pointer == nullptr) throw inputError(fmt::format("{} is NULL", name));
  return *pointer;
}

// A list of the caller's. Throws Error(input) for one of NULL that has something in it.
template <typename Element>
std::span<const Element> listOf(const Element* first, size_t count, const char* name) {
  if (count > 0) given(first, name);
  return {first, count};
}

// x, y, z of each.
inline std::vector<glm::vec3> vectorsOf(const float* xyz, size_t count, const char* name) {
  std::vector<glm::vec3> vectors;
  vectors.reserve(count);
  const std::span<const float> numbers = listOf(xyz, 3 * count, name);
  for (size_t i = 0; i < numbers.size(); i += 3)
    vectors.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  return vectors;
}
template <typename Number>
void copyVectors(const std::vector<glm::vec<3, Number>>& vectors, Number* xyz) {
  for (const auto& vector : vectors)
    for (int k = 0; k < 3; ++k) *xyz++ = vector[k];
}

template <typename SceneOrConst>
auto& herdOf(SceneOrConst& scene, uint32_t herd) {
  if (herd >= scene.herds.size())
    throw inputError(fmt::format("herd {}: the scene has {}, counted from 0", herd, scene.herds.size()));
  return scene.herds[herd];
}

// Throws Error(input) where `room` is not enough for `needed` things.
inline void checkRoom(const char* name, size_t room, size_t needed) {
  if (room < needed) throw inputError(fmt::format("{} has room for {}, expected {}", name, room, needed));
}

inline Crowd& crowdOf(skitter_crowd* crowd) { return given(crowd, "crowd").live->crowd; }
inline const Crowd& crowdOf(const skitter_crowd* crowd) { return given(crowd, "crowd").live->crowd; }

inline glm::dvec3 vectorOf(const double* xyz, const char* name) {
  given(xyz, name);
  return {xyz[0], xyz[1], xyz[2]};
}
// NULL: the world's.
inline glm::dvec3 originOf(const double* origin) {
  if (origin == nullptr) return glm::dvec3(0);
  const glm::dvec3 place = vectorOf(origin, "origin");
  bindings::expectFinite("origin", place);
  return place;
}
template <typename Number, glm::length_t Size>
void copyVector(const glm::vec<Size, Number>& vector, Number* to) {
  for (glm::length_t k = 0; k < Size; ++k) to[k] = vector[k];
}

inline skitter_footfall toC(const Footfall& footfall) {
  return {.tick = footfall.tick,
          .agent = footfall.agent,
          .leg = footfall.leg,
          .place = {footfall.place.x, footfall.place.y, footfall.place.z},
          .speed = footfall.speed};
}

// Writes what `ask` says of the crowd.
template <typename Value, typename Ask>
skitter_result tell(const skitter_crowd* crowd, Value* value, const char* name, Ask ask) {
  return guarded([&] {
    const Crowd& asked = crowdOf(crowd);
    given(value, name);
    *value = ask(asked);
  });
}

// Writes the agent that `ask` finds, if any.
template <typename Ask>
void tellPicked(skitter_picked* picked, int* found, Ask ask) {
  given(picked, "picked");
  given(found, "found");
  const std::optional<Picked> agent = ask();
  *found = agent ? 1 : 0;
  if (agent)
    *picked = {agent->herd, agent->agent, agent->distance, {agent->place.x, agent->place.y, agent->place.z}};
}

// The caller's room for a list, and for how many elements it has. Throws Error(input) for NULL.
template <typename Element>
struct Told {
  Told(Element* first, size_t space, const char* name, size_t* counter)
      : list(first), room(space), count(given(counter, "count")) {
    if (room > 0) given(list, name);
  }
  // Writes the elements that there is room for, converted, and tells how many there are.
  template <typename From, typename Convert>
  void write(const std::vector<From>& all, Convert convert) {
    for (size_t i = 0; i < all.size() && i < room; ++i) list[i] = convert(all[i]);
    count = all.size();
  }

  Element* list;
  size_t room;
  size_t& count;
};

}  // namespace skitter::c
