#include <fmt/format.h>

#include <algorithm>

#include "embedded/solve_tree_comp_storage.h"
#include "embedded/solve_tree_comp_texel.h"
#include "gpu/context.h"
#include "gpu/kernel.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"
#include "ik/limits.h"
#include "ik/records.h"
#include "shared/bindings.h"
#include "shared/ik_batch.h"
#include "skitter/error.h"
#include "skitter/ik.h"
#include "skitter/records.h"

namespace skitter::ik {
namespace {

constexpr size_t kMostLegs = 8, kMostTreeBones = 64;

float reachOf(const Tree::Leg& leg) { return Chain{leg.bones, {}}.reach(); }

void check(const Tree& tree) {
  if (tree.legs.empty() || tree.legs.size() > kMostLegs)
    throw inputError(fmt::format("a tree of {} legs, expected 1 to {}", tree.legs.size(), kMostLegs));
  if (!(tree.anchor >= 0 && tree.anchor <= 1))
    throw inputError(fmt::format("the tree's anchor is {}, expected 0 to 1", tree.anchor));
  const size_t bones = tree.legs.front().bones.size();
  for (size_t l = 0; l < tree.legs.size(); ++l) {
    const Chain chain{tree.legs[l].bones, {}};
    check(chain);
    if (!chain.isFree()) throw inputError(fmt::format("leg {} has limits; a tree is solved without", l));
    if (chain.bones.size() != bones)
      throw inputError(fmt::format("leg {} has {} bones, leg 0 has {}: a tree's legs have equally many", l,
                                   chain.bones.size(), bones));
  }
  if (tree.legs.size() * bones > kMostTreeBones)
    throw inputError(
        fmt::format("a tree of {} bones, expected at most {}", tree.legs.size() * bones, kMostTreeBones));
}

std::vector<glm::vec4> recordsOf(const Tree& tree, float reach) {
  std::vector<glm::vec4> records;
  for (const Tree::Leg& leg : tree.legs) {
    records.emplace_back(leg.root / reach, 0.0f);
    for (const Bone& bone : leg.bones)
      records.emplace_back(glm::normalize(bone.direction), bone.length / reach);
  }
  return records;
}

std::vector<glm::vec3> narrowed(const std::vector<glm::vec4>& values) {
  return {values.begin(), values.end()};
}

}  // namespace

struct TreeBatch::Impl {
  Impl(Device&, const Tree&, uint32_t trees, uint32_t iterations, float tolerance);

  const gpu::Context* context;
  uint32_t trees, legs, bones;
  shared::TreeConstants constants = {};
  gpu::Kernel kernel;
  gpu::Buffer rig, targets, bodies, bodiesOut, joints, reports;
  gpu::Bindings bindings;
};

TreeBatch::Impl::Impl(Device& device, const Tree& tree, uint32_t count, uint32_t iterations, float tolerance)
    : context(&device.context()),
      trees((check(tree), count)),
      legs(static_cast<uint32_t>(tree.legs.size())),
      bones(static_cast<uint32_t>(tree.legs.front().bones.size())) {
  using namespace shared;
  using enum gpu::BindingKind;
  if (!(tolerance > 0)) throw inputError(fmt::format("the tolerance is {}, expected more than 0", tolerance));
  const uint64_t most = uint64_t{context->limits().maxComputeWorkGroupCountX} * WORK_GROUP;
  if (count > most) throw inputError(fmt::format("{} trees, expected at most {}", count, most));
  constants = {
      .count = trees, .iterations = iterations, .tolerance = tolerance, .reach = 0, .anchor = tree.anchor};
  for (const Tree::Leg& leg : tree.legs) constants.reach = std::max(constants.reach, reachOf(leg));
  const auto make = [&](uint64_t vec4s, const char* name) {
    return gpu::Buffer(*context, vec4s * 16 * trees, name);
  };
  const std::vector<glm::vec4> records = recordsOf(tree, constants.reach);
  rig = gpu::Buffer(*context, records.size() * sizeof(glm::vec4), "tree rig");
  gpu::upload(*context, rig, records);
  targets = make(legs, "tree targets");
  bodies = make(1, "tree bodies");
  bodiesOut = make(1, "tree bodies solved");
  joints = make(uint64_t{legs} * (bones + 1), "tree joints");
  reports = make(1, "tree reports");
  kernel =
      gpu::Kernel(*context, {.name = "ik tree",
                             .code = {embedded::solve_tree_comp_texel(), embedded::solve_tree_comp_storage()},
                             .bindings = {{BATCH_RIG, load4},
                                          {BATCH_TARGET, load4},
                                          {BATCH_BASE, load4},
                                          {BATCH_STATE_OUT, store},
                                          {BATCH_JOINT_OUT, store},
                                          {BATCH_REPORT_OUT, store}},
                             .pushBytes = sizeof(TreeConstants),
                             .constants = {{CONSTANT_BONES, bones}, {CONSTANT_LEGS, legs}}});
  bindings = kernel.bind(*context, {{BATCH_RIG, &rig},
                                    {BATCH_TARGET, &targets},
                                    {BATCH_BASE, &bodies},
                                    {BATCH_STATE_OUT, &bodiesOut},
                                    {BATCH_JOINT_OUT, &joints},
                                    {BATCH_REPORT_OUT, &reports}});
}

TreeBatch::TreeBatch(Device& device, const Tree& tree, uint32_t trees, uint32_t iterations, float tolerance)
    : impl_(std::make_unique<Impl>(device, tree, trees, iterations, tolerance)) {}
TreeBatch::~TreeBatch() = default;
TreeBatch::TreeBatch(TreeBatch&&) noexcept = default;
TreeBatch& TreeBatch::operator=(TreeBatch&&) noexcept = default;

void TreeBatch::solve(std::span<const glm::vec3> bodies, std::span<const glm::vec3> targets) {
  Impl& batch = *impl_;
  expectCount("bodies", bodies.size(), batch.trees);
  expectCount("targets", targets.size(), size_t{batch.trees} * batch.legs);
  gpu::upload(*batch.context, batch.bodies, widened(bodies));
  gpu::upload(*batch.context, batch.targets, widened(targets));
  gpu::submitAndWait(*batch.context, [&](vk::CommandBuffer cmd) {
    gpu::transferToCompute(cmd);
    batch.kernel.dispatch(cmd, batch.bindings, gpu::bytesOf(batch.constants),
                          gpu::groupsFor(batch.trees, shared::WORK_GROUP));
    gpu::computeToTransfer(cmd);
  });
}

std::vector<glm::vec3> TreeBatch::downloadBodies() const {
  return narrowed(gpu::download<glm::vec4>(*impl_->context, impl_->bodiesOut));
}

std::vector<glm::vec3> TreeBatch::downloadJoints() const {
  return narrowed(gpu::download<glm::vec4>(*impl_->context, impl_->joints));
}

std::vector<Report> TreeBatch::downloadReports() const {
  std::vector<Report> reports;
  for (const glm::vec4& r : gpu::download<glm::vec4>(*impl_->context, impl_->reports))
    reports.push_back({r.x, static_cast<uint32_t>(r.y), static_cast<Stop>(r.z)});
  return reports;
}

}  // namespace skitter::ik
