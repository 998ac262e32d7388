#include "cpu_reference/evolve/trial.h"

#include <algorithm>
#include <cmath>

#include "cpu_reference/stages/measure.h"

namespace skitter::reference {
namespace {

glm::dvec3 localOf(const AgentBody& body) { return {body.localX, body.y, body.localZ}; }

// A body that goes over to the next tile seems to jump by its side.
glm::dvec3 wayFrom(const glm::dvec3& before, const glm::dvec3& now) {
  glm::dvec3 way = now - before;
  for (double* along : {&way.x, &way.z}) *along -= tileSize * std::round(*along / tileSize);
  return way;
}

bool isPlanted(const Foot& foot) { return foot.progress >= 1; }

double marginOf(const TrialNumbers& numbers, const AgentBody& body, const std::vector<Foot>& feet,
                const std::vector<Chain>& chains) {
  std::vector<glm::dvec2> support;
  for (size_t leg = 0; leg < feet.size(); ++leg)
    if (isPlanted(feet[leg])) support.emplace_back(chains[leg].tip.x, chains[leg].tip.z);
  if (support.empty()) return -numbers.legLength;
  const glm::dvec3 centre = body.orientation * glm::dvec3(0, numbers.bodyHeight, 0);
  return stabilityMargin(support, {centre.x, centre.z});
}

}  // namespace

Trial beginTrial(const AgentBody& body, const Gait& gait, const std::vector<Foot>& feet,
                 const std::vector<Chain>& chains) {
  Trial trial;
  trial.body = localOf(body);
  trial.phase = gait.phase;
  for (size_t leg = 0; leg < feet.size(); ++leg)
    trial.legs.push_back({.tip = trial.body + chains[leg].tip, .planted = isPlanted(feet[leg])});
  return trial;
}

Sampled sampleTrial(const TrialNumbers& numbers, const Trial& before, const AgentBody& body, const Gait& gait,
                    const std::vector<Foot>& feet, const std::vector<Chain>& chains) {
  Sampled sampled{beginTrial(body, gait, feet, chains)};
  Trial& trial = sampled.trial;
  trial.samples = before.samples + 1;
  trial.distance = before.distance + wayFrom(before.body, trial.body).z;
  trial.cycles = before.cycles + (trial.phase - before.phase) - std::floor(trial.phase - before.phase);
  trial.slip = before.slip;
  trial.error = before.error;
  for (size_t leg = 0; leg < feet.size(); ++leg) {
    const Trial::Leg& last = before.legs[leg];
    Trial::Leg& now = trial.legs[leg];
    now.stood = last.stood + (now.planted ? 1 : 0);
    const glm::dvec3 way = wayFrom(last.tip, now.tip);
    if (now.planted && last.planted) trial.slip += std::hypot(way.x, way.z);
    trial.error = std::max(trial.error, chains[leg].reachError);
  }
  sampled.margin = marginOf(numbers, body, feet, chains);
  trial.unstable = before.unstable + (sampled.margin < numbers.safe ? 1 : 0);
  trial.least = before.samples > 0 ? std::min(before.least, sampled.margin) : sampled.margin;
  return sampled;
}

}  // namespace skitter::reference
