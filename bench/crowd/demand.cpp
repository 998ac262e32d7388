#include "bench/crowd/demand.h"

#include <string_view>

#include "bench/crowd/operations.h"
#include "crowd/herd.h"
#include "crowd/page.h"
#include "gpu/context.h"
#include "gpu/transfer.h"

namespace skitter::bench {
namespace {

// Counters, lists, tables and heights are shared by all, or small.
bool isRecord(uint32_t binding) {
  using namespace shared;
  return binding >= BINDING_GOAL && binding != BINDING_KEY && binding < BINDING_AWAKE &&
         (binding < BINDING_CLIP || binding > BINDING_CLIP_JOINT);
}

double boundBytes(const Crowd::Impl& crowd, const crowd::Herd& herd, const crowd::Page& page,
                  const crowd::Stage& stage) {
  double bytes = 0;
  for (const gpu::BindingDecl& declared : stage.bindings) {
    if (!isRecord(declared.binding)) continue;
    // Gait looks at arcs after an edit of the heights alone.
    if (declared.binding == shared::BINDING_ARC && crowd::makes(stage.name, "gait")) continue;
    const gpu::Binding bound = crowd::bindingOf(crowd, herd, page, declared.binding);
    if (const auto* buffer = std::get_if<const gpu::Buffer*>(&bound.resource))
      bytes += static_cast<double>((*buffer)->size());
  }
  return bytes;
}

double invocationsOf(const crowd::Herd& herd, const crowd::Page& page, crowd::Stage::Over over) {
  const double agents = page.agents;
  switch (over) {
    case crowd::Stage::Over::legs:
    case crowd::Stage::Over::everyLeg:
    case crowd::Stage::Over::listed:
      return agents * herd.legs;
    case crowd::Stage::Over::joints:
      return agents * herd.clips.joints;
    case crowd::Stage::Over::blocks:
    case crowd::Stage::Over::everyone:
    case crowd::Stage::Over::agents:
    case crowd::Stage::Over::watched:
      break;
  }
  return agents;
}

}  // namespace

std::vector<StageDemand> demandOf(const Crowd& crowd, const CrowdOptions& options) {
  const Crowd::Impl& impl = crowd.impl();
  const gpu::Context& context = *impl.context;
  std::vector<StageDemand> demands;
  for (const std::string_view name : crowd::frame()) {
    if (name == "measure" || name == "footfall") continue;
    StageDemand sum{std::string(name)};
    bool found = false;
    for (const crowd::Herd& herd : impl.herds)
      for (const crowd::Stage& stage : herd.stages) {
        if (stage.name != name) continue;
        found = true;
        const gpu::KernelInfo info = crowd::kernelsOf(context, stage, options, herd).first;
        const double operations = operationsAnInvocation(info.code.pick(context), info.constants);
        for (const crowd::Page& page : herd.pages) {
          const double invocations = invocationsOf(herd, page, stage.over);
          double share = 1;
          if (stage.over == crowd::Stage::Over::listed)
            share = gpu::download<uint32_t>(context, page.counters)[shared::COUNTER_LISTED] /
                    std::max(invocations, 1.0);
          sum.bytes += share * boundBytes(impl, herd, page, stage);
          sum.operations += share * invocations * operations;
        }
      }
    if (found) demands.push_back(sum);
  }
  return demands;
}

}  // namespace skitter::bench
