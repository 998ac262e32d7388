#include "ik/runs.h"

#include <gtest/gtest.h>

#include "skitter/device.h"
#include "validation/convert_ik.h"

namespace skitter::test {
namespace {

glm::dvec3 randomTarget(const reference::IkChain& chain, Random& random) {
  if (uniform(random, 0, 1) < 0.7) return uniform(random, 0.998, 1) * legalTarget(chain, random);
  return uniform(random, 0.05, 1.2) * randomDirection(random);
}

ik::Base randomBase(Random& random) {
  const glm::dvec3 axis = randomDirection(random);
  const double half = uniform(random, 0, 3);
  return {2.0 * randomDirection(random), glm::dquat(std::cos(half), std::sin(half) * axis)};
}

}  // namespace

validation::IkRun randomRun(Device& device, const std::string& name, const ik::Chain& chain, size_t chains,
                            ik::Options options, uint64_t seed) {
  ik::Batch batch(device, chain, static_cast<uint32_t>(chains), options);
  options.solver = batch.solver();
  options.iterations = batch.iterations();
  validation::IkRun run{.name = name + ", " + ik::nameOf(options.solver),
                        .chain = chain,
                        .options = options,
                        .seed = seed,
                        .seeds = batch.downloadSeeds()};
  const reference::IkChain expected = validation::referenceOf(chain);
  const validation::IkLayout layout(expected, validation::referenceOf(options.solver));
  Random random(seed);
  for (size_t c = 0; c < chains; ++c) {
    glm::dvec3 target = expected.length * randomTarget(expected, random);
    if (options.bases) {
      const ik::Base base = randomBase(random);
      target = glm::dvec3(base.position) + glm::dquat(base.rotation) * target;
      run.bases.push_back(base);
    }
    run.targets.emplace_back(target);
    if (options.start == ik::Start::previous)
      validation::append(expected, layout, randomState(expected, random), run.before);
  }
  batch.setTargets(run.targets);
  if (options.bases) batch.setBases(run.bases);
  if (options.start == ik::Start::previous) batch.setStates(run.before);
  batch.solve();
  run.joints = batch.downloadJoints();
  run.reports = batch.downloadReports();
  return run;
}

validation::IkRun pacedRun(Device& device, const std::string& name, const ik::Chain& chain, size_t chains,
                           ik::Options options, uint64_t seed) {
  options.start = ik::Start::previous;
  ik::Batch batch(device, chain, static_cast<uint32_t>(chains), options);
  options.solver = batch.solver();
  options.iterations = batch.iterations();
  validation::IkRun run{.name = name + ", paced, " + ik::nameOf(options.solver),
                        .chain = chain,
                        .options = options,
                        .seed = seed,
                        .seeds = batch.downloadSeeds()};
  const reference::IkChain expected = validation::referenceOf(chain);
  const validation::IkLayout layout(expected, validation::referenceOf(options.solver));
  Random random(seed);
  std::vector<glm::vec4> states;
  for (size_t c = 0; c < chains; ++c) {
    run.lastTargets.emplace_back(expected.length * randomTarget(expected, random));
    // A quarter stands still.
    const double way = expected.length * std::max(uniform(random, -0.003, 0.009), 0.0);
    run.targets.emplace_back(glm::dvec3(run.lastTargets[c]) + way * randomDirection(random));
    validation::append(expected, layout, randomState(expected, random), states);
  }
  batch.setStates(states);
  batch.setTargets(run.lastTargets);
  batch.solve();
  run.before = batch.downloadStates();
  batch.setTargets(run.targets);
  batch.solve();
  run.joints = batch.downloadJoints();
  run.reports = batch.downloadReports();
  return run;
}

validation::IkRun runToward(Device& device, const std::string& name, const ik::Chain& chain,
                            const ik::Options& options, const std::vector<glm::vec3>& targets) {
  validation::IkRun run{.name = name, .chain = chain, .options = options, .targets = targets};
  ik::Batch batch(device, chain, static_cast<uint32_t>(targets.size()), options);
  batch.setTargets(targets);
  batch.solve();
  run.joints = batch.downloadJoints();
  run.reports = batch.downloadReports();
  return run;
}

void expectParity(const validation::IkRun& run, double tieShare) {
  const validation::IkParity parity = checkIkBatch(run);
  EXPECT_EQ(parity.chains, run.targets.size());
  EXPECT_LE(parity.worst, 1) << parity.text;
  EXPECT_LE(static_cast<double>(parity.ties), std::max(1.0, tieShare * static_cast<double>(parity.chains)))
      << run.name;
}

}  // namespace skitter::test
