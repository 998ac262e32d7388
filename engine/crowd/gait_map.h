#pragma once

#include <cstdint>
#include <vector>

#include "skitter/rig.h"
#include "skitter/tuning.h"

namespace skitter::crowd {

// The masks of idle legs with which a creature walks in a gait of its own, in ascending order: of a rig of up
// to eight legs all that leave three legs, of others those of one or two (docs/evolve.md#patterns).
std::vector<uint32_t> walkingPatterns(const Rig& rig);

// The covariance of two behaviours that are so far apart, of variance 1 each: Matern with nu = 5/2.
double matern52(double distance, double lengthScale);

// The gaits that agents of a kind try where they adapt (docs/stages/adapt.md#the-map).
struct GaitMap {
  uint32_t candidates = 0;
  std::vector<float> records = {};  // shaders/shared/adapt.h
};
GaitMap gaitMapOf(const Rig& rig, const Tuning& tuning);

}  // namespace skitter::crowd
