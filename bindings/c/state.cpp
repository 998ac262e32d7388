#include <algorithm>
#include <cstddef>
#include <string>

#include "bindings/c/handles.h"

using namespace skitter;
using c::crowdOf;
using c::given;
using c::guarded;

namespace {

std::string noteOf(const char* note) { return note != nullptr ? note : ""; }

}  // namespace

skitter_result skitter_crowd_save(const skitter_crowd* crowd, const char* file, const char* note) {
  return guarded([&] {
    const Crowd& saved = crowdOf(crowd);
    given(file, "file");
    saved.save(file, noteOf(note));
  });
}

skitter_result skitter_crowd_save_to_memory(const skitter_crowd* crowd, const char* note, void* bytes,
                                            size_t room, size_t* size) {
  return guarded([&] {
    const Crowd& saved = crowdOf(crowd);
    given(size, "size");
    auto* const to = static_cast<std::byte*>(bytes);
    if (room > 0) given(to, "bytes");
    const std::vector<std::byte> state = saved.saveToMemory(noteOf(note));
    *size = state.size();
    if (room == 0) return;
    c::checkRoom("bytes", room, state.size());
    std::ranges::copy(state, to);
  });
}

skitter_result skitter_state_load(const char* file, skitter_state** state) {
  return guarded([&] {
    given(file, "file");
    given(state, "state");
    *state = new skitter_state{loadState(file)};
  });
}

skitter_result skitter_state_parse(const void* bytes, size_t size, skitter_state** state) {
  return guarded([&] {
    const auto from = c::listOf(static_cast<const std::byte*>(bytes), size, "bytes");
    given(state, "state");
    *state = new skitter_state{parseState({from.begin(), from.end()}, "the state")};
  });
}

skitter_result skitter_state_tick(const skitter_state* state, uint64_t* tick) {
  return guarded([&] {
    given(tick, "tick");
    *tick = given(state, "state").state.tick;
  });
}

skitter_result skitter_state_dt(const skitter_state* state, float* dt) {
  return guarded([&] {
    given(dt, "dt");
    *dt = given(state, "state").state.dt;
  });
}

skitter_result skitter_state_note(const skitter_state* state, const char** note) {
  return guarded([&] {
    given(note, "note");
    *note = given(state, "state").state.note.c_str();
  });
}

skitter_result skitter_state_scene(const skitter_state* state, skitter_scene** scene) {
  return guarded([&] {
    const Scene& kept = given(state, "state").state.scene;
    given(scene, "scene");
    *scene = new skitter_scene{kept};
  });
}

skitter_result skitter_state_destroy(skitter_state* state) {
  return guarded([&] { delete state; });
}
