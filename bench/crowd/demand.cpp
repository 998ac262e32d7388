#include "bench/crowd/demand.h"

#include <algorithm>
#include <string>

#include "bench/crowd/operations.h"
#include "crowd/herd.h"
#include "crowd/page.h"
#include "crowd/record.h"
#include "gpu/context.h"
#include "gpu/transfer.h"

namespace skitter::bench {
namespace {

double boundBytes(const Crowd::Impl& crowd, const crowd::Kind& kind, const crowd::Page& page,
                  const crowd::Stage& stage) {
  double bytes = 0;
  for (const gpu::BindingDecl& declared : stage.bindings) {
    // Counters, lists, tables and heights are shared by all, or small.
    if (!crowd::recordAt(declared.binding)) continue;
    // Gait looks at arcs after an edit of the heights alone.
    if (declared.binding == shared::BINDING_ARC && stage.makes.has(crowd::StageId::gait)) continue;
    const gpu::Binding bound = crowd::bindingOf(crowd, kind, page, declared.binding);
    if (const auto* buffer = std::get_if<const gpu::Buffer*>(&bound.resource))
      bytes += static_cast<double>((*buffer)->size());
  }
  return bytes;
}

double invocationsOf(const crowd::Kind& kind, const crowd::Page& page, crowd::Stage::Over over) {
  const double agents = page.agents;
  switch (over) {
    case crowd::Stage::Over::legs:
    case crowd::Stage::Over::everyLeg:
    case crowd::Stage::Over::listed:
      return agents * kind.legs;
    case crowd::Stage::Over::joints:
      return agents * kind.clips.joints;
    case crowd::Stage::Over::blocks:
    case crowd::Stage::Over::everyone:
    case crowd::Stage::Over::lookers:
    case crowd::Stage::Over::agents:
    case crowd::Stage::Over::watched:
      break;
  }
  return agents;
}

}  // namespace

std::vector<StageDemand> demandOf(const Crowd& crowd, const CrowdOptions& options) {
  const Crowd::Impl& impl = implOf(crowd);
  const gpu::Context& context = *impl.context;
  std::vector<StageDemand> demands;
  for (const crowd::Kind& kind : impl.kinds)
    for (const crowd::ReadyStage& stage : kind.stages) {
      if (stage.makes == crowd::StageId::measure || stage.makes == crowd::StageId::footfall) continue;
      const std::string name = stage.makes.name();
      const auto found = std::ranges::find(demands, name, &StageDemand::stage);
      StageDemand& sum = found != demands.end() ? *found : demands.emplace_back(StageDemand{name});
      const gpu::KernelInfo info = crowd::kernelsOf(stage, {context, options, kind}).first;
      const double operations = operationsAnInvocation(info.code.pick(context), info.constants);
      for (const crowd::Page& page : kind.pages) {
        const double invocations = invocationsOf(kind, page, stage.over);
        double share = 1;
        if (stage.over == crowd::Stage::Over::listed)
          share = gpu::download<uint32_t>(context, page.counters)[shared::COUNTER_LISTED] /
                  std::max(invocations, 1.0);
        sum.bytes += share * boundBytes(impl, kind, page, stage);
        sum.operations += share * invocations * operations;
      }
    }
  return demands;
}

}  // namespace skitter::bench
