#pragma once

#include "crowd/herd.h"
#include "skitter/state.h"

namespace skitter::crowd {

// The crowd's herds, and of its kinds where their herds begin. Throws Error(input) where the state's options
// lack the rigs of a program's own.
void restoreHerds(Crowd::Impl& crowd, const State& state);

// Throws Error(input) where the state is not one of such a crowd, before any of its records is read.
void checkState(const Crowd::Impl& crowd, const State& state);

// Gives a crowd that has no agents but zeros those of the state. Throws Error(input) where it is damaged.
void restore(Crowd::Impl& crowd, const State& state);

}  // namespace skitter::crowd
