#include "crowd/page.h"

#include <algorithm>
#include <span>
#include <string>

#include "crowd/stage.h"
#include "gpu/barrier.h"
#include "gpu/context.h"
#include "gpu/submit.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

constexpr uint32_t kMostPageAgents = 65536;

}  // namespace

gpu::Binding bindingOf(const Crowd::Impl& crowd, const Herd& herd, const Page& page, uint32_t binding) {
  using namespace shared;
  switch (binding) {
    case BINDING_PARAMETERS:
      return {binding, &herd.parameterBlock};
    case BINDING_HEIGHTS:
      return {binding, &crowd.heights};
    case BINDING_RIG:
      return {binding, &herd.rigBuffer};
    case BINDING_LIST:
      return {binding, &page.list};
    case BINDING_COUNTERS:
      return {binding, &page.counters};
    case BINDING_AWAKE:
    case BINDING_AWAKE_OUT:
      return {binding, &page.awake};
    case BINDING_HISTOGRAM:
      return {binding, &page.histogram};
    case BINDING_GOAL:
    case BINDING_GOAL_OUT:
      return {binding, &page.goal};
    case BINDING_STEER:
    case BINDING_STEER_OUT:
      return {binding, &page.steer};
    case BINDING_BODY:
    case BINDING_BODY_OUT:
      return {binding, &page.body};
    case BINDING_GAIT:
    case BINDING_GAIT_OUT:
      return {binding, &page.gait};
    case BINDING_STEP:
    case BINDING_STEP_OUT:
      return {binding, &page.step};
    case BINDING_ARC:
    case BINDING_ARC_OUT:
      return {binding, &page.arc};
    case BINDING_FOOT:
    case BINDING_FOOT_OUT:
      return {binding, &page.foot};
    case BINDING_CHAIN:
    case BINDING_CHAIN_OUT:
      return {binding, &page.chain};
    case BINDING_MISS:
    case BINDING_MISS_OUT:
      return {binding, &page.miss};
    case BINDING_TIP:
    case BINDING_TIP_OUT:
      return {binding, &page.tip};
    case BINDING_POSE:
    case BINDING_POSE_OUT:
      return {binding, &page.pose};
    case BINDING_PLAY:
    case BINDING_PLAY_OUT:
      return {binding, &page.play};
    case BINDING_START:
    case BINDING_START_OUT:
      return {binding, &page.start};
    case BINDING_FIX:
    case BINDING_FIX_OUT:
      return {binding, &page.fix};
    case BINDING_SPRING:
    case BINDING_SPRING_OUT:
      return {binding, &page.spring};
    case BINDING_KEY:
      return {binding, &herd.keyBuffer};
    case BINDING_CLIP:
      return {binding, &herd.clipHeads};
    case BINDING_CLIP_FRAME:
      return {binding, &herd.clipTimes};
    case BINDING_CLIP_ROW:
      return {binding, &herd.clipRows};
    case BINDING_CLIP_LEG:
      return {binding, &herd.clipLegs};
    case BINDING_CLIP_JOINT:
      return {binding, &herd.clipBones};
    case BINDING_WATCH:
    case BINDING_WATCH_OUT:
      return {binding, &page.watch};
    case BINDING_FLIGHT:
    case BINDING_FLIGHT_OUT:
      return {binding, &page.flight};
    case BINDING_FOOTFALL_OUT:
      return {binding, &page.footfall};
    default:
      return {binding, &page.metric};
  }
}

namespace {

// What is spawned is written once, to where the device copies it from; all else begins as zeros.
void spawn(const gpu::Context& context, const std::vector<PageBuffer>& buffers, const Spawner& spawner,
           const gpu::HostBuffer& staging, const Page& page) {
  SpawnRecords records;
  gpu::submitAndWait(context, [&](vk::CommandBuffer cmd) {
    uint64_t end = 0;
    for (const PageBuffer& each : buffers) {
      const gpu::Buffer& buffer = page.*each.buffer;
      if (each.spawned == nullptr) {
        cmd.fillBuffer(buffer.handle(), 0, VK_WHOLE_SIZE, 0);
        continue;
      }
      records.*each.spawned = staging.as<float>().subspan(end / sizeof(float), buffer.size() / sizeof(float));
      cmd.copyBuffer(staging.handle(), buffer.handle(),
                     vk::BufferCopy{.srcOffset = end, .size = buffer.size()});
      end += buffer.size();
    }
    gpu::allToAll(cmd);
    spawner.write(page.firstAgent, page.agents, records);
  });
}

}  // namespace

std::vector<PageBuffer> pageBuffers(const Crowd::Impl& crowd, const Herd& herd) {
  using namespace shared;
  constexpr uint32_t aPage = UINT32_MAX;
  const CrowdOptions& options = crowd.options;
  const Rig& rig = herd.rig;
  const bool clips = playsClips(herd.controller), planted = herd.controller == Controller::planted;
  const auto legs = static_cast<uint64_t>(rig.legCount());
  const auto vec4s = [](uint64_t count, int stride) { return count * static_cast<uint64_t>(stride) * 16; };
  const auto ofLegs = [&](const char* name, gpu::Buffer Page::*buffer, int stride,
                          std::span<float> SpawnRecords::*spawned = nullptr) {
    PageBuffer made{name, buffer, vec4s(legs, stride), spawned};
    made.inBlocks = true;
    return made;
  };
  std::vector<PageBuffer> buffers = {
      {"goal", &Page::goal, vec4s(1, GOAL_STRIDE), &SpawnRecords::goal},
      {"steer", &Page::steer, vec4s(1, STEER_STRIDE)},
      {"body", &Page::body, vec4s(1, BODY_STRIDE), &SpawnRecords::body},
      {"gait", &Page::gait, vec4s(1, GAIT_STRIDE), &SpawnRecords::gait},
      ofLegs("step", &Page::step, STEP_STRIDE, &SpawnRecords::step),
      ofLegs("chain", &Page::chain, chainStride(rig.maxBones()), &SpawnRecords::chain),
      {"list", &Page::list, legs * sizeof(uint32_t)}};
  // What is not kept is bound all the same.
  const auto ofFeet = [&](const char* name, gpu::Buffer Page::*buffer, int stride,
                          std::span<float> SpawnRecords::*spawned, bool kept) {
    PageBuffer made = ofLegs(name, buffer, stride, kept ? spawned : nullptr);
    if (!kept) made.most = made.bytes;
    buffers.push_back(made);
  };
  ofFeet("foot", &Page::foot, FOOT_STRIDE, &SpawnRecords::foot, hasFootRecords(herd, options));
  ofFeet("tip", &Page::tip, TIP_STRIDE, &SpawnRecords::tip, keepsFeet(options));
  if (aimsSteps(herd.controller)) buffers.push_back(ofLegs("arc", &Page::arc, ARC_STRIDE));
  if (tellsMisses(herd.controller))
    buffers.push_back({"miss", &Page::miss, vec4s(1, missStride(rig.legCount()))});
  if (clips) buffers.push_back({"play", &Page::play, vec4s(1, PLAY_STRIDE), &SpawnRecords::play});
  if (planted) {
    buffers.push_back(ofLegs("start", &Page::start, startStride(rig.maxBones())));
    buffers.push_back(ofLegs("fix", &Page::fix, rig.maxBones() * FIX_STRIDE));
  }
  if (herd.controller == Controller::pose)
    buffers.push_back(ofLegs("spring", &Page::spring, chainStride(rig.maxBones())));
  if (options.pose)
    buffers.push_back({"pose", &Page::pose,
                       clips ? vec4s(static_cast<uint64_t>(herd.clips.joints), MATRIX_STRIDE)
                             : vec4s(static_cast<uint64_t>(rig.paletteSize()), POSE_STRIDE)});
  if (options.measure) {
    buffers.push_back({"metric", &Page::metric, vec4s(1, METRIC_STRIDE)});
    buffers.push_back(
        {"watch", &Page::watch, vec4s(1, watchStride(rig.legCount())), nullptr, crowd.watchEvery});
    buffers.push_back({"histogram", &Page::histogram, HISTOGRAM_BUCKETS * sizeof(uint32_t), nullptr, aPage});
  }
  if (options.footfalls > 0) {
    buffers.push_back(ofLegs("flight", &Page::flight, FLIGHT_STRIDE));
    buffers.push_back({"footfall", &Page::footfall, vec4s(legs, FOOTFALL_STRIDE), nullptr, 1,
                       vec4s(options.footfalls, FOOTFALL_STRIDE)});
  }
  // The last work group reads on after the list's end.
  PageBuffer awake{"awake", &Page::awake, vec4s(1, AWAKE_STRIDE), nullptr, BLOCK};
  if (options.sleep)
    awake.more = vec4s(WORK_GROUP, AWAKE_STRIDE);
  else
    awake.most = awake.bytes;
  buffers.push_back(awake);
  buffers.push_back({"counters", &Page::counters, COUNTERS * sizeof(uint32_t), nullptr, aPage, UINT64_MAX,
                     gpu::BufferUse::indirect});
  return buffers;
}

uint32_t agentsPerPage(const Crowd::Impl& crowd, const Herd& herd) {
  using shared::BLOCK;
  const gpu::Context& context = *crowd.context;
  uint64_t limit = context.limits().maxStorageBufferRange;
  if (context.texelLoads()) limit = std::min(limit, context.limits().maxTexelBufferElements * 16);
  uint64_t agents =
      crowd.options.pageAgents > 0 ? std::min(crowd.options.pageAgents, kMostPageAgents) : kMostPageAgents;
  for (const PageBuffer& buffer : pageBuffers(crowd, herd)) {
    const uint64_t fit = limit / buffer.bytes * buffer.agents;
    agents = std::min(agents, buffer.inBlocks ? fit / BLOCK * BLOCK : fit);
    if (agents == 0)
      throw deviceError(context.report().name + ": a binding reaches " + std::to_string(limit) +
                        " bytes, one agent's " + buffer.name + " needs " + std::to_string(buffer.bytes));
  }
  return static_cast<uint32_t>(agents);
}

uint64_t bytesOf(const Crowd::Impl& crowd, const Herd& herd, uint32_t agents) {
  const std::vector<PageBuffer> buffers = pageBuffers(crowd, herd);
  const uint32_t most = agentsPerPage(crowd, herd);
  const auto ofPage = [&](uint32_t count) {
    uint64_t bytes = 0;
    for (const PageBuffer& buffer : buffers) bytes += buffer.bytesOf(count);
    return bytes;
  };
  return agents / most * ofPage(most) + ofPage(agents % most);
}

std::vector<Page> makePages(const Crowd::Impl& crowd, const Herd& herd, const Spawner& spawner,
                            uint32_t agents) {
  const uint32_t most = std::min(agents, agentsPerPage(crowd, herd));
  const std::vector<PageBuffer> buffers = pageBuffers(crowd, herd);
  uint64_t staged = 0;
  for (const PageBuffer& each : buffers) staged += each.spawned != nullptr ? each.bytesOf(most) : 0;
  const gpu::HostBuffer staging(*crowd.context, staged, gpu::HostUse::upload, "spawn staging");
  std::vector<Page> pages;
  for (uint32_t first = 0; first < agents; first += most) {
    Page& page = pages.emplace_back();
    page.firstAgent = first;
    page.agents = std::min(most, agents - first);
    for (const PageBuffer& each : buffers)
      page.*each.buffer = gpu::Buffer(*crowd.context, each.bytesOf(page.agents), each.name, each.use);
    page.footfallRoom = static_cast<uint32_t>(page.footfall.size() / (shared::FOOTFALL_STRIDE * 16));
    spawn(*crowd.context, buffers, spawner, staging, page);
    for (size_t i = 0; i < herd.stages.size(); ++i) {
      std::vector<gpu::Binding> list;
      for (const gpu::BindingDecl& declared : herd.stages[i].bindings)
        list.push_back(bindingOf(crowd, herd, page, declared.binding));
      page.bindings.push_back(herd.kernels[i].bind(*crowd.context, list));
    }
  }
  return pages;
}

PageSample sampleOf(const Page& page, const AgentSample& sample) {
  const uint32_t past = page.firstAgent > sample.first ? (page.firstAgent - sample.first) % sample.stride : 0;
  const uint32_t first = page.firstAgent <= sample.first ? sample.first - page.firstAgent
                         : past > 0                      ? sample.stride - past
                                                         : 0;
  return {first, page.agents > first ? (page.agents - first + sample.stride - 1) / sample.stride : 0};
}

}  // namespace skitter::crowd
