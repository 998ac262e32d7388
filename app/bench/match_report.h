#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/crowd/contest.h"
#include "bench/crowd/peaks.h"

// What a match of a device and its opponents came to. `cpu`: the device is a CPU too, so that CPU time is
// compared and not the wall's clock.
namespace skitter::app {

void printResults(uint64_t agents, const std::vector<bench::Result>& results, bool cpu);
// A row a stage of the device, beside what the same stage takes its opponents.
void printStages(const bench::Match& match, const bench::Peaks& peaks, bool cpu);
nlohmann::ordered_json jsonOf(Controller controller, const bench::Match& match);
nlohmann::ordered_json jsonOf(const bench::Result& result);

// The clocks of stages give shares; how long the whole takes is CPU time where `cpu`, else the wall's, so
// that who else is at work on the machine does not count. Above 0.
double millisecondsOf(const StageTime& stage, const bench::Result& result, bool cpu);

// What is wrong with the results, empty if nothing.
std::string faultsOf(const std::vector<bench::Result>& results);

}  // namespace skitter::app
