#pragma once

#include <fmt/format.h>

#include <concepts>
#include <exception>
#include <memory>
#include <new>
#include <type_traits>

#include "bindings/c/skitter.h"
#include "bindings/common/walk.h"
#include "skitter/crowd.h"
#include "skitter/error.h"
#include "skitter/ik.h"

// What is behind the handles. Members are destroyed last first: what is made on a device before its share of
// it.

struct skitter_device {
  std::shared_ptr<skitter::Device> device;
};

struct skitter_scene {
  skitter::Scene scene;
};

struct skitter_crowd {
  std::shared_ptr<skitter::Device> device;
  skitter::Crowd crowd;
  skitter::bindings::Walk walk;
};

struct skitter_ik_batch {
  std::shared_ptr<skitter::Device> device;
  skitter::ik::Batch batch;
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

// Throws Error(input) where `room` is not enough for `needed` things.
inline void checkRoom(const char* name, size_t room, size_t needed) {
  if (room < needed) throw inputError(fmt::format("{} has room for {}, expected {}", name, room, needed));
}

}  // namespace skitter::c
