#include "experiments/collection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>

#include "bench/cpu_crowd/crowd.h"
#include "bench/statistics.h"
#include "crowd/herd.h"
#include "experiments/walk.h"
#include "gpu/barrier.h"
#include "gpu/transfer.h"
#include "validation/herd_facts.h"

namespace skitter::experiments {
namespace {

constexpr int inRow = 32;  // dispatches of one submission

size_t footholdIndex(const crowd::Kind& kind) {
  for (size_t i = 0; i < kind.stages.size(); ++i)
    if (kind.stages[i].makes == crowd::StageId::foothold) return i;
  return kind.stages.size();
}

// The foothold stage over the first legs of a crowd that walks, again and again.
class Stage {
 public:
  Stage(Walk& walk, const gpu::Context& context, uint32_t legs, bool nearestOnly)
      : walk_(walk), kind_(implOf(walk.crowd()).kindOf(0)), index_(footholdIndex(kind_)) {
    kind_.parameters.nearestOnly = nearestOnly ? 1 : 0;
    std::memcpy(kind_.parameterBlock.bytes().data(), &kind_.parameters, sizeof kind_.parameters);
    uint32_t left = legs;
    for (const crowd::Page& page : kind_.pages) {
      const uint32_t here = std::min(left, page.agents * static_cast<uint32_t>(kind_.legs));
      std::vector<uint32_t> list(here);
      for (uint32_t i = 0; i < here; ++i) {
        const auto each = static_cast<uint32_t>(kind_.legs);
        list[i] = 2 * static_cast<uint32_t>(shared::legRecord(static_cast<int>(i / each),
                                                              static_cast<int>(i % each),
                                                              kind_.legs));  // they lift
      }
      gpu::upload(context, page.list, list);
      const std::vector<uint32_t> counters = {gpu::groupsFor(here, shared::WORK_GROUP), 1, 1, here};
      gpu::upload(context, page.counters, counters);
      listed_.push_back(here);
      left -= here;
    }
  }

  base::Seconds run(int times) {
    const shared::TickConstants constants{.count = 0,
                                          .tick = static_cast<float>(tick()),
                                          .first = 0,
                                          .every = 1,
                                          .watched = 0,
                                          .room = 0,
                                          .sleepTime = 0};
    return base::timed([&] {
      const vk::CommandBuffer cmd = walk_.ring().begin();
      for (int i = 0; i < times; ++i) {
        for (size_t p = 0; p < kind_.pages.size(); ++p) {
          const crowd::Page& page = kind_.pages[p];
          if (listed_[p] > 0)
            kind_.stages[index_].first.dispatchIndirect(cmd, page.bindings[index_], gpu::bytesOf(constants),
                                                        page.counters);
        }
        gpu::computeToCompute(cmd);
      }
      walk_.ring().wait(walk_.ring().submit());
    });
  }
  uint64_t tick() const { return walk_.crowd().tick() + 1; }
  crowd::Kind& kind() { return kind_; }

 private:
  Walk& walk_;
  crowd::Kind& kind_;
  size_t index_;
  std::vector<uint32_t> listed_;  // a page
};

// How far the steps of the first legs are apart, metres: the furthest of the landing, the lift-off and the
// two vectors of the arc.
std::vector<double> stepsApart(const HerdState& a, const HerdState& b, uint32_t legs) {
  static_assert(shared::STEP_STRIDE == 2 && shared::ARC_STRIDE == 2);
  const auto distance = [](const std::vector<float>& p, const std::vector<float>& q, size_t at) {
    return static_cast<double>(glm::distance(glm::make_vec3(&p[at]), glm::make_vec3(&q[at])));
  };
  std::vector<double> apart;
  for (size_t at = 0; at < size_t{8} * legs; at += 8)
    apart.push_back(std::max({distance(a.step, b.step, at), distance(a.step, b.step, at + 4),
                              distance(a.arc, b.arc, at), distance(a.arc, b.arc, at + 4)}));
  return apart;
}

CollectionTime measure(Walk& walk, const gpu::Context& context, const Heightfield& ground,
                       const Settings& settings, uint32_t legs, bool nearestOnly) {
  Stage stage(walk, context, legs, nearestOnly);
  CollectionTime made;
  made.rule = nearestOnly ? "nearest" : "weighed";
  made.legs = legs;

  const HerdState before = walk.crowd().download(0);
  stage.run(1);
  const HerdState after = walk.crowd().download(0);
  cpu_crowd::CpuCrowd cpu(validation::herdFacts(stage.kind(), ground), before,
                          {.width = cpu_crowd::Width::scalar});
  cpu.beginSteps(stage.tick(), legs);
  const std::vector<double> apart = stepsApart(after, cpu.state(), legs);
  made.apart = bench::quantile(apart, 0.5);
  made.differing =
      static_cast<double>(std::ranges::count_if(apart, [](double d) { return d > 1e-3; })) / legs;

  std::vector<double> alone, row, host;
  for (int i = 0; i < settings.collectionRepetitions; ++i) {
    alone.push_back(1e3 * stage.run(1).wall);
    if (i % 8 == 0) row.push_back(1e3 * stage.run(inRow).wall / inRow);
  }
  // Short runs are repeated: a clock has its grain.
  const int times = static_cast<int>(std::max(1u, 2000 / legs));
  for (int i = 0; i < std::max(3, settings.collectionRepetitions / 10); ++i) {
    host.push_back(1e3 / times * base::timed([&] {
                                   for (int k = 0; k < times; ++k) cpu.beginSteps(stage.tick(), legs);
                                 }).wall);
  }
  made.deviceMilliseconds = bench::quantile(alone, 0.5);
  made.lower = bench::quantile(alone, 0.25);
  made.upper = bench::quantile(alone, 0.75);
  made.inRowMilliseconds = bench::quantile(row, 0.5);
  made.cpuMilliseconds = bench::quantile(host, 0.5);
  return made;
}

}  // namespace

Collection measureCollection(Device& device, const Heightfield& ground, const Settings& settings,
                             Course& course) {
  Collection made;
  double done = 0;
  for (const uint32_t legs : settings.collectionLegs) {
    const uint32_t agents = (legs + 7) / 8;
    Walk walk(device, ground, crossing(Controller::adaptive, agents, 1, settings.seed), settings.dt);
    walk.ticks(std::min(settings.settleTicks, 40u));
    for (const bool nearestOnly : {true, false}) {
      course.at(done / static_cast<double>(2 * settings.collectionLegs.size()));
      made.times.push_back(measure(walk, device.context(), ground, settings, legs, nearestOnly));
      ++done;
    }
  }
  return made;
}

const CollectionTime* Collection::find(const std::string& rule, uint32_t legs) const {
  for (const CollectionTime& time : times)
    if (time.rule == rule && time.legs == legs) return &time;
  return nullptr;
}

Table Collection::table() const {
  Table table{{"rule", "legs", "device_ms", "lower_quartile_ms", "upper_quartile_ms", "device_in_row_ms",
               "cpu_scalar_ms", "median_apart_m", "share_differing"}};
  for (const CollectionTime& t : times)
    table.rows.push_back({t.rule, fmt::format("{}", t.legs), fmt::format("{:.6f}", t.deviceMilliseconds),
                          fmt::format("{:.6f}", t.lower), fmt::format("{:.6f}", t.upper),
                          fmt::format("{:.6f}", t.inRowMilliseconds),
                          fmt::format("{:.6f}", t.cpuMilliseconds), fmt::format("{:.2e}", t.apart),
                          fmt::format("{:.5f}", t.differing)});
  return table;
}

}  // namespace skitter::experiments
