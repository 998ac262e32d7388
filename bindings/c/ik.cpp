#include "bindings/c/handles.h"
#include "bindings/common/names.h"

using namespace skitter;
using c::given;
using c::guarded;

namespace {

glm::vec3 vectorOf(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

ik::Limit limitOf(const skitter_ik_bone& bone, uint32_t index) {
  const float* limit = bone.limit;
  switch (bone.limit_kind) {
    case SKITTER_IK_FREE:
      return ik::Free{};
    case SKITTER_IK_CONE:
      return ik::Cone{limit[0]};
    case SKITTER_IK_ELLIPSE:
      return ik::Ellipse{limit[0], limit[1], limit[2], limit[3]};
    case SKITTER_IK_HINGE:
      return ik::Hinge{vectorOf(bone.axis), limit[0], limit[1]};
  }
  throw inputError(fmt::format("bones[{}].limit_kind is {}, expected a skitter_ik_limit", index,
                               static_cast<int>(bone.limit_kind)));
}

ik::Chain chainOf(const skitter_ik_bone* bones, uint32_t count) {
  ik::Chain chain;
  for (uint32_t i = 0; i < count; ++i)
    chain.bones.push_back({.length = bones[i].length,
                           .direction = vectorOf(bones[i].direction),
                           .limit = limitOf(bones[i], i),
                           .twistMin = bones[i].twist_min,
                           .twistMax = bones[i].twist_max,
                           .stiffness = bones[i].stiffness != 0 ? bones[i].stiffness : 1});
  return chain;
}

ik::Options optionsOf(const skitter_ik_options& asked) {
  ik::Options options;
  if (asked.solver != nullptr)
    options.solver = bindings::namedOf(allSolvers, "options->solver", asked.solver);
  options.iterations = asked.iterations;
  if (asked.tolerance != 0) options.tolerance = asked.tolerance;
  if (asked.continues != 0) options.start = ik::Start::previous;
  return options;
}

}  // namespace

skitter_result skitter_ik_batch_create(skitter_device* device, const skitter_ik_bone* bones,
                                       uint32_t bone_count, uint32_t chains,
                                       const skitter_ik_options* options, skitter_ik_batch** batch) {
  return guarded([&] {
    const std::shared_ptr<Device>& on = given(device, "device").device;
    given(bones, "bones");
    given(batch, "batch");
    if (bone_count > ik::Chain::maxBones)
      throw inputError(fmt::format("bone_count is {}, expected 1 to {}", bone_count, ik::Chain::maxBones));
    const ik::Options made = optionsOf(options != nullptr ? *options : skitter_ik_options{});
    *batch = new skitter_ik_batch{on, ik::Batch(*on, chainOf(bones, bone_count), chains, made)};
  });
}

skitter_result skitter_ik_batch_set_targets(skitter_ik_batch* batch, const float* xyz, size_t chains) {
  return guarded([&] {
    ik::Batch& made = given(batch, "batch").batch;
    given(xyz, "xyz");
    if (chains != made.chains())
      throw inputError(fmt::format("{} targets, expected {}, one a chain", chains, made.chains()));
    made.setTargets(c::vectorsOf(xyz, chains, "xyz"));
  });
}

skitter_result skitter_ik_batch_solve(skitter_ik_batch* batch) {
  return guarded([&] { given(batch, "batch").batch.solve(); });
}

skitter_result skitter_ik_batch_record(const skitter_ik_batch* batch, VkCommandBuffer commands) {
  return guarded([&] {
    const ik::Batch& made = given(batch, "batch").batch;
    given(commands, "commands");
    made.record(commands);
  });
}

skitter_result skitter_ik_batch_joints(const skitter_ik_batch* batch, float* xyz, size_t room) {
  return guarded([&] {
    const ik::Batch& made = given(batch, "batch").batch;
    given(xyz, "xyz");
    c::checkRoom("xyz", room, size_t{made.chains()} * made.joints());
    c::copyVectors(made.downloadJoints(), xyz);
  });
}

skitter_result skitter_ik_batch_reports(const skitter_ik_batch* batch, skitter_ik_report* reports,
                                        size_t room) {
  return guarded([&] {
    const ik::Batch& made = given(batch, "batch").batch;
    given(reports, "reports");
    c::checkRoom("reports", room, made.chains());
    for (const ik::Report& report : made.downloadReports())
      *reports++ = {report.error, report.iterations, static_cast<skitter_ik_stop>(report.stop)};
  });
}

skitter_result skitter_ik_batch_destroy(skitter_ik_batch* batch) {
  return guarded([&] { delete batch; });
}
