#include "ik/records.h"

#include <algorithm>
#include <cmath>

#include "ik/limits.h"
#include "shared/ik_batch.h"
#include "skitter/records.h"

namespace skitter::ik {
namespace {

void append(std::vector<float>& records, const glm::dvec3& v, double w) {
  for (const double x : {v.x, v.y, v.z, w}) records.push_back(static_cast<float>(x));
}

// For aimed seeds, only lengths matter.
glm::dvec3 compared(const glm::dvec3& joint, bool aimed) {
  return aimed ? glm::dvec3(glm::length(joint), 0, 0) : joint;
}

void padToVec4(std::vector<float>& records) {
  while (records.size() % 4 != 0) records.push_back(0);
}

}  // namespace

std::vector<glm::vec4> widened(std::span<const glm::vec3> values) {
  std::vector<glm::vec4> wide;
  wide.reserve(values.size());
  for (const glm::vec3& v : values) wide.emplace_back(v, 0.0f);
  return wide;
}

std::vector<float> boneRecords(const Skeleton& skeleton) {
  std::vector<float> records;
  glm::dvec3 start(0);
  const std::vector<glm::dvec3> rest = skeleton.place(skeleton.rest());
  for (size_t i = 0; i < skeleton.bones(); ++i) {
    const Skeleton::Joint& joint = skeleton.joints()[i];
    const double edge = std::holds_alternative<Free>(joint.limit)
                            ? shared::WIDEST_FREE
                            : std::tan(std::min(greatestAngle(joint.limit, 0), widestAngle) / 2);
    append(records, joint.frame[0], joint.length);
    append(records, joint.frame[2], edge);
    append(records, start, joint.stiffness);
    const glm::dvec4 numbers = numbersOf(joint.limit, joint.axis);
    append(records, numbers, numbers.w);
    // The dissertation asks whether there is a cone at all.
    append(records, {kindOf(joint.limit), std::tan(joint.twistMin / 2), std::tan(joint.twistMax / 2)}, 0);
    const glm::dmat3 carry =
        i == 0 ? joint.frame : glm::transpose(skeleton.joints()[i - 1].frame) * joint.frame;
    append(records, carry[0], joint.length);
    append(records, carry[2], edge);
    append(records, glm::dvec3(0), 0);
    start = rest[i];
  }
  return records;
}

std::pair<uint32_t, uint32_t> limitWords(const Skeleton& skeleton) {
  uint32_t words[shared::LIMIT_WORDS] = {};
  for (size_t i = 0; i < skeleton.bones(); ++i) {
    const Skeleton::Joint& joint = skeleton.joints()[i];
    int kinds = kindOf(joint.limit);
    if (joint.twistMin != 0 || joint.twistMax != 0) kinds |= shared::LIMIT_TWIST;
    words[i / shared::LIMIT_BONES_A_WORD] |= static_cast<uint32_t>(kinds)
                                             << 4 * (i % shared::LIMIT_BONES_A_WORD);
  }
  return {words[0], words[1]};
}

uint32_t parallelWord(const Skeleton& skeleton) {
  uint32_t word = 0;
  for (size_t i = 1; i < skeleton.bones(); ++i) {
    const Skeleton::Joint &before = skeleton.joints()[i - 1], &joint = skeleton.joints()[i];
    const bool parallel =
        kindOf(joint.limit) == shared::LIMIT_HINGE && glm::length(joint.frame[0] - before.frame[0]) < 1e-7;
    word |= static_cast<uint32_t>(parallel) << i;
  }
  return word;
}

void appendPose(const Skeleton& skeleton, const Skeleton::Pose& pose, std::vector<float>& records) {
  for (const glm::dvec3& d : pose.directions) {
    const double k = 1 / std::max(1 + d.z, 1e-6);
    records.push_back(static_cast<float>(d.x * k));
    records.push_back(static_cast<float>(d.y * k));
  }
  padToVec4(records);
  if (!skeleton.hasTwists()) return;
  for (const double twist : pose.twists) records.push_back(static_cast<float>(std::tan(twist / 2)));
  padToVec4(records);
}

std::vector<float> seedRecords(const Skeleton& skeleton, const std::vector<Skeleton::Pose>& seeds,
                               bool aimed) {
  std::vector<float> records;
  for (const Skeleton::Pose& pose : seeds) {
    appendPose(skeleton, pose, records);
    const std::vector<glm::dvec3> joints = skeleton.place(pose);
    double squares = 0;
    for (const glm::dvec3& p : joints) squares += glm::dot(p, p);
    const glm::dvec3& tip = joints.back();
    const double own = glm::dot(tip, tip) + 0.1 * squares / static_cast<double>(joints.size());
    for (const glm::dvec3& p : joints) append(records, compared(p, aimed), &p == &tip ? own / 2 : 0);
  }
  return records;
}

std::vector<float> seedCells(const Skeleton& skeleton, const std::vector<Skeleton::Pose>& seeds, bool aimed) {
  constexpr int n = shared::SEED_CELLS;
  std::vector<glm::dvec3> tips;
  if (!aimed) tips.push_back(skeleton.place(skeleton.rest()).back());
  for (const Skeleton::Pose& pose : seeds) tips.push_back(compared(skeleton.place(pose).back(), aimed));
  const auto middle = [](int i) { return (i + 0.5) * 2 / n - 1; };
  std::vector<float> cells;
  for (int cell = 0; cell < n * n * n; ++cell) {
    const glm::dvec3 at = aimed ? glm::dvec3((cell + 0.5) / (n * n * n), 0, 0)
                                : glm::dvec3(middle(cell % n), middle(cell / n % n), middle(cell / (n * n)));
    const auto nearest = std::min_element(tips.begin(), tips.end(), [&](const auto& a, const auto& b) {
      return glm::dot(a - at, a - at) < glm::dot(b - at, b - at);
    });
    cells.push_back(static_cast<float>(nearest - tips.begin()) - (aimed ? 0.0f : 1.0f));
  }
  return cells;
}

}  // namespace skitter::ik
