#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "shared/parameters.h"
#include "skitter/crowd.h"
#include "skitter/heightfield.h"

namespace skitter::experiments {

// The foothold stage of docs/stages.md as plain scalar C++ in single precision: what point collection costs
// without a device. Legs 0 .. `legs` - 1 lift in tick `tick`.
class CollectionCpu {
 public:
  // `rigRecords` as in shaders/shared/records.h. All stay the caller's.
  CollectionCpu(const shared::Parameters& parameters, const Heightfield& ground,
                const std::vector<float>& rigRecords, int legs, int bones)
      : q_(parameters), ground_(ground), rig_(rigRecords), legs_(legs), bones_(bones) {}

  // `steps` and `arcs` hold the records of the last steps and take those of the new ones.
  void run(const HerdState& state, uint32_t legs, float tick, std::vector<float>& steps,
           std::vector<float>& arcs) const;

 private:
  struct Height {
    float y, gx, gz;
  };
  Height heightAt(float x, float z) const;
  void collect(const HerdState& state, uint32_t leg, float tick, float* step, float* arc) const;

  const shared::Parameters& q_;
  const Heightfield& ground_;
  const std::vector<float>& rig_;
  int legs_, bones_;
};

}  // namespace skitter::experiments
