#include "assets/rigs/clip_heading.h"

#include <algorithm>
#include <cmath>

#include "assets/models/clip_sampler.h"
#include "assets/rigs/joint_names.h"

namespace skitter {
namespace {

constexpr size_t mostHeadingClips = 16;
constexpr int headingSamples = 48;    // of a clip, evenly
constexpr double standsBelow = 0.25;  // of a foot's range of heights: so low it is on the ground
constexpr double stepShare = 0.1;     // of the reach: a foot that goes less far along the axis does not step
constexpr double travelShare = 0.5;   // of the reach: a body that goes less far stays where it is

constexpr const char* walkWords[] = {"walk*",   "run*",   "trot*",  "gallop*", "jog*",
                                     "sprint*", "crawl*", "march*", "creep*"};
constexpr const char* otherWays[] = {"back*", "reverse*", "left*", "right*", "strafe*", "side*", "turn*"};

// The ways of standing feet and of the body along the axis.
struct Steps {
  double forward = 0, all = 0;
};

Steps stepsOf(const BodyPlan& plan, const gltf::Clip& clip, const glm::dvec3& axis) {
  ClipSampler sampler(*plan.document, clip, plan.document->parentsFirst, glm::dmat4(1));
  const size_t limbs = plan.limbs.size();
  std::vector<std::vector<glm::dvec3>> feet(limbs), roots(limbs);
  for (int k = 0; k <= headingSamples; ++k) {
    const std::vector<glm::dmat4>& nodes = sampler.sample(clip.seconds * k / headingSamples);
    for (size_t i = 0; i < limbs; ++i) {
      const glm::dvec3 root(nodes[static_cast<size_t>(plan.limbs[i].root())][3]);
      const auto last = static_cast<size_t>(plan.limbs[i].joints.back());
      // A foot without a joint is where its last joint carries it.
      const glm::dvec4 tip =
          glm::inverse(plan.model.nodes[last].modelFromNode) * glm::dvec4(plan.limbs[i].tip, 1);
      feet[i].push_back(glm::dvec3(nodes[last] * tip) - root);
      roots[i].push_back(root);
    }
  }
  Steps steps;
  for (size_t i = 0; i < limbs; ++i) {
    double low = HUGE_VAL, high = -HUGE_VAL, least = HUGE_VAL, most = -HUGE_VAL;
    for (const glm::dvec3& foot : feet[i]) {
      low = std::min(low, plan.height(foot));
      high = std::max(high, plan.height(foot));
      least = std::min(least, glm::dot(foot, axis));
      most = std::max(most, glm::dot(foot, axis));
    }
    if (most - least < stepShare * plan.limbs[i].reach) continue;
    for (size_t k = 0; k + 1 < feet[i].size(); ++k) {
      if (std::max(plan.height(feet[i][k]), plan.height(feet[i][k + 1])) > low + standsBelow * (high - low))
        continue;
      const double way = -glm::dot(feet[i][k + 1] - feet[i][k], axis);
      steps.forward += way;
      steps.all += std::fabs(way);
    }
    const double travel = glm::dot(roots[i].back() - roots[i].front(), axis);
    if (std::fabs(travel) < travelShare * plan.limbs[i].reach) continue;
    steps.forward += travel;
    steps.all += std::fabs(travel);
  }
  return steps;
}

}  // namespace

double headingOfClips(const BodyPlan& plan, const glm::dvec3& axis) {
  if (!plan.document || plan.document->nodes.size() != plan.model.nodes.size()) return 0;
  Steps sum;
  size_t heard = 0;
  for (const gltf::Clip& clip : plan.document->clips) {
    const std::vector<std::string> words = wordsOf(clip.name);
    if (!hasWord(words, walkWords) || hasWord(words, otherWays) || !(clip.seconds > 0)) continue;
    if (++heard > mostHeadingClips) break;
    const Steps steps = stepsOf(plan, clip, axis);
    sum.forward += steps.forward;
    sum.all += steps.all;
  }
  return sum.all > 0 ? sum.forward / sum.all : 0;
}

}  // namespace skitter
