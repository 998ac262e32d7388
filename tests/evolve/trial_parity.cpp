#include "evolve/trial_parity.h"

#include <fmt/format.h>

#include <cmath>

#include "cpu_reference/evolve/trial.h"
#include "evolve/genes.h"
#include "evolve/patterns.h"
#include "shared/trial.h"
#include "validation/convert.h"

namespace skitter::test {
namespace {

// Metres. Coordinates are up to 16 m in float32, so each has an error of up to 2^-20 m; a difference of two
// that are sums themselves has four such errors and one in the sum.
constexpr double placeError = 0x1p-20;
constexpr double wayError = 8 * placeError;
// Phases below 1 and sums of up to 8 cycles: 2^-24 of a difference, 2^-21 of the sum.
constexpr double cycleError = 0x1p-20;
// A margin is a product of a coordinate below 2 m and a unit vector, which some devices round to 2^-21.
constexpr double marginError = 0x1p-18;

reference::Trial trialOf(const std::vector<float>& records, size_t agent, size_t legs) {
  const float* at = &records[agent * 4 * static_cast<size_t>(shared::trialStride(static_cast<int>(legs)))];
  reference::Trial trial{.samples = at[0],
                         .distance = at[1],
                         .cycles = at[2],
                         .unstable = at[3],
                         .slip = at[4],
                         .error = at[5],
                         .least = at[6],
                         .body = {at[8], at[9], at[10]},
                         .phase = at[11]};
  for (size_t leg = 0; leg < legs; ++leg) {
    const float* of = at + 4 * (shared::TRIAL_LEGS + leg);
    const double stood = std::floor(double{of[3]} / 2);
    trial.legs.push_back(
        {.tip = {of[0], of[1], of[2]}, .planted = double{of[3]} - 2 * stood == 1, .stood = stood});
    // Anything but a whole number is neither.
    if (double{of[3]} != std::floor(double{of[3]})) trial.legs.back().stood = -1;
  }
  return trial;
}

std::string trialDifference(const reference::Trial& device, const reference::Trial& truth,
                            bool marginIsSure) {
  const auto compare = [](const char* name, double found, double expected, double error) {
    return std::abs(found - expected) <= error ? std::string()
                                               : fmt::format("{} is {}, expected {}", name, found, expected);
  };
  const size_t legs = truth.legs.size();
  std::vector<std::string> all = {
      compare("samples", device.samples, truth.samples, 0),
      compare("distance", device.distance, truth.distance, wayError),
      compare("cycles", device.cycles, truth.cycles, cycleError),
      compare("unstable", device.unstable, truth.unstable, marginIsSure ? 0 : 1),
      compare("slip", device.slip, truth.slip, static_cast<double>(legs) * 2 * wayError),
      compare("error", device.error, truth.error, 0),
      compare("least", device.least, truth.least, marginError),
      compare("phase", device.phase, truth.phase, 0),
      compare("body", glm::distance(device.body, truth.body), 0, 0)};
  for (size_t leg = 0; leg < legs; ++leg) {
    all.push_back(
        compare("tip", glm::distance(device.legs[leg].tip, truth.legs[leg].tip), 0, 4 * placeError));
    all.push_back(compare("planted", device.legs[leg].planted, truth.legs[leg].planted, 0));
    all.push_back(compare("stood", device.legs[leg].stood, truth.legs[leg].stood, 0));
  }
  for (const std::string& each : all)
    if (!each.empty()) return each;
  return {};
}

}  // namespace

std::vector<evolve::TrialTask> drawnTasks(const Rig& rig, uint32_t count, uint64_t seed) {
  const evolve::GeneSpace space(rig, Tuning{}, Evolution::wantedSpeed);
  const std::vector<uint32_t> patterns = evolve::patternsOf(rig);
  base::SplitMix64 random(seed);
  std::vector<evolve::TrialTask> tasks;
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t idle = patterns[random() % patterns.size()];
    const RigGait gait = space.decode(space.drawn(random), idle);
    tasks.push_back({idle, i % 4 == 0 ? crowd::regaitByRule(rig, Tuning{}, {.idle = idle})
                                      : crowd::regaitOf(rig, gait, {.idle = idle})});
  }
  return tasks;
}

std::string differenceOf(evolve::Trials& trials, const std::vector<evolve::TrialTask>& tasks, uint32_t settle,
                         uint32_t samples) {
  const Rig& rig = trials.crowd().rig(0);
  const size_t legs = rig.legs.size();
  const reference::TrialNumbers numbers{
      .legLength = double{rig.legLength},
      .bodyHeight = double{rig.bodyHeight},
      .safe = double{static_cast<float>(evolve::Trials::safeMargin) * rig.legLength}};
  for (int trial = 0; trial < 2; ++trial) {
    trials.begin(tasks);
    for (uint32_t tick = 0; tick < settle; ++tick) trials.tick();
    std::vector<float> before;
    for (uint32_t sample = 0; sample <= samples; ++sample) {
      if (sample > 0)
        for (uint32_t tick = 0; tick < evolve::Trials::ticksOfSample; ++tick) trials.tick();
      trials.sample();
      const std::vector<float> after = trials.records();
      const HerdState state = trials.crowd().download(0);
      for (size_t agent = 0; agent < tasks.size(); ++agent) {
        const reference::AgentBody body = validation::bodyOf(state, agent);
        const reference::Gait gait = validation::gaitOf(state, agent);
        std::vector<reference::Foot> feet;
        std::vector<reference::Chain> chains;
        for (size_t leg = agent * legs; leg < (agent + 1) * legs; ++leg) {
          feet.push_back(validation::footOf(state, leg));
          chains.push_back(validation::chainOf(state, leg, rig.maxBones()));
        }
        reference::Sampled truth{reference::beginTrial(body, gait, feet, chains)};
        const reference::Trial device = trialOf(after, agent, legs);
        if (sample > 0)
          truth = reference::sampleTrial(numbers, trialOf(before, agent, legs), body, gait, feet, chains);
        else
          truth.trial.least = device.least;  // it begins with the first sample that counts
        const bool isSure = sample == 0 || std::abs(truth.margin - numbers.safe) > marginError;
        const std::string difference = trialDifference(device, truth.trial, isSure);
        if (!difference.empty())
          return fmt::format("trial {}, sample {}, agent {}: {}", trial, sample, agent, difference);
      }
      before = after;
    }
  }
  return {};
}

}  // namespace skitter::test
