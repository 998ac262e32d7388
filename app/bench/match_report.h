#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "bench/crowd/contest.h"
#include "bench/crowd/peaks.h"

// What a match of a device and its opponents came to. `cpu`: the device is a CPU too, so that CPU time is
// compared and not the wall's clock.
namespace skitter::app {

void printResults(const bench::Match& match, bool cpu);
// A row a stage of the device, beside what the same stage takes its opponents.
void printStages(const bench::Match& match, const bench::Peaks& peaks, bool cpu);
nlohmann::ordered_json jsonOf(Controller controller, const bench::Match& match);

// What is wrong with the results, empty if nothing.
std::string faultsOf(const bench::Match& match);

}  // namespace skitter::app
