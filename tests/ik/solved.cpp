#include "ik/solved.h"

#include <gtest/gtest.h>

#include "skitter/device.h"
#include "validation/convert_ik.h"

namespace skitter::test {

Solved resultOf(const ik::Batch& batch, bool rotations) {
  Solved solved{batch.joints(), batch.downloadJoints(), {}, batch.downloadReports()};
  if (rotations) solved.rotation = batch.downloadRotations();
  return solved;
}

Solved solve(Device& device, const ik::Chain& chain, const ik::Options& options,
             const std::vector<glm::vec3>& targets) {
  ik::Batch batch(device, chain, static_cast<uint32_t>(targets.size()), options);
  batch.setTargets(targets);
  batch.solve();
  return resultOf(batch, options.rotations);
}

validation::IkJudge::Verdict judge(const validation::IkJudge& judge, const Solved& solved, size_t c,
                                   const glm::vec3& target) {
  const auto own = solved.chain(c);
  const std::vector<glm::dvec3> joints(own.begin(), own.end());
  std::vector<glm::dquat> rotations;
  const size_t bones = solved.joints - 1;
  for (size_t i = 0; !solved.rotation.empty() && i < bones; ++i)
    rotations.emplace_back(solved.rotation[c * bones + i]);
  return judge.judge(target, joints, rotations);
}

void expectSound(const ik::Chain& chain, const Solved& solved) {
  const validation::IkJudge by = validation::judgeOf(chain);
  for (size_t c = 0; c < solved.report.size(); ++c) {
    const auto verdict = judge(by, solved, c, glm::vec3(0));
    EXPECT_LE(verdict.boneLengthError, 1e-5) << "chain " << c;
    EXPECT_LE(verdict.limitViolation, 1e-4) << "chain " << c;
  }
}

}  // namespace skitter::test
