#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "ik/skeleton.h"

// A chain as the shaders read it: include/skitter/records.h (rig, bone) and shaders/shared/ik_batch.h.
namespace skitter::ik {

// Points as records: xyz, 0.
std::vector<glm::vec4> widened(std::span<const glm::vec3>);
std::vector<float> boneRecords(const Skeleton&);
// CONSTANT_LIMITS_LOW and CONSTANT_LIMITS_HIGH.
std::pair<uint32_t, uint32_t> limitWords(const Skeleton&);
// CONSTANT_PARALLEL.
uint32_t parallelWord(const Skeleton&);
// Directions and twists, whole vec4.
void appendPose(const Skeleton&, const Skeleton::Pose&, std::vector<float>& records);
std::vector<float> seedRecords(const Skeleton&, const std::vector<Skeleton::Pose>&, bool aimed);
// The cells after the seeds.
std::vector<float> seedCells(const Skeleton&, const std::vector<Skeleton::Pose>&, bool aimed);

}  // namespace skitter::ik
