#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "bench/crowd/avoid_contest.h"

// What the grid and stage avoid take the device and its opponents. `cpu`: the device is a CPU too, so that
// CPU time is compared and not the wall's clock.
namespace skitter::app {

void print(const bench::AvoidMatch& match, uint32_t rounds, bool cpu);
void print(const std::vector<bench::Growth>& growth);
nlohmann::ordered_json jsonOf(const bench::AvoidMatch& match);
nlohmann::ordered_json jsonOf(const std::vector<bench::Growth>& growth);

}  // namespace skitter::app
