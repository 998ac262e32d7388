#include "experiments/collection.h"

#include <fmt/format.h>

#include <cstring>
#include <string_view>

#include "bench/statistics.h"
#include "crowd/herd.h"
#include "experiments/collection_cpu.h"
#include "experiments/walk.h"
#include "gpu/barrier.h"
#include "gpu/transfer.h"

namespace skitter::experiments {
namespace {

constexpr int inRow = 32;  // dispatches of one submission

size_t footholdIndex(const crowd::Herd& herd) {
  for (size_t i = 0; i < herd.stages.size(); ++i)
    if (std::string_view(herd.stages[i].name) == "foothold") return i;
  return herd.stages.size();
}

// The foothold stage over the first legs of a crowd that walks, again and again.
class Stage {
 public:
  Stage(Walk& walk, const gpu::Context& context, uint32_t legs, bool nearestOnly)
      : walk_(walk), herd_(walk.crowd().impl().herds.front()), index_(footholdIndex(herd_)) {
    herd_.parameters.nearestOnly = nearestOnly ? 1 : 0;
    std::memcpy(herd_.parameterBlock.bytes().data(), &herd_.parameters, sizeof herd_.parameters);
    uint32_t left = legs;
    for (const crowd::Page& page : herd_.pages) {
      const uint32_t here = std::min(left, page.agents * static_cast<uint32_t>(herd_.legs));
      std::vector<uint32_t> list(here);
      for (uint32_t i = 0; i < here; ++i) {
        const auto each = static_cast<uint32_t>(herd_.legs);
        list[i] = 2 * static_cast<uint32_t>(shared::legRecord(static_cast<int>(i / each),
                                                              static_cast<int>(i % each),
                                                              herd_.legs));  // they lift
      }
      gpu::upload(context, page.list, list);
      const std::vector<uint32_t> counters = {gpu::groupsFor(here, shared::WORK_GROUP), 1, 1, here};
      gpu::upload(context, page.counters, counters);
      listed_.push_back(here);
      left -= here;
    }
  }

  bench::Seconds run(int times) {
    const shared::TickConstants constants{
        .count = 0, .tick = tick(), .first = 0, .every = 1, .watched = 0, .room = 0, .sleepTime = 0};
    return bench::timed([&] {
      const vk::CommandBuffer cmd = walk_.ring().begin();
      for (int i = 0; i < times; ++i) {
        for (size_t p = 0; p < herd_.pages.size(); ++p) {
          const crowd::Page& page = herd_.pages[p];
          if (listed_[p] > 0)
            herd_.kernels[index_].dispatchIndirect(cmd, page.bindings[index_], gpu::bytesOf(constants),
                                                   page.counters);
        }
        gpu::computeToCompute(cmd);
      }
      walk_.ring().wait(walk_.ring().submit());
    });
  }
  float tick() const { return static_cast<float>(walk_.crowd().tick() + 1); }
  crowd::Herd& herd() { return herd_; }

 private:
  Walk& walk_;
  crowd::Herd& herd_;
  size_t index_;
  std::vector<uint32_t> listed_;  // a page
};

CollectionTime measure(Walk& walk, const gpu::Context& context, const Heightfield& ground,
                       const Settings& settings, uint32_t legs, bool nearestOnly) {
  Stage stage(walk, context, legs, nearestOnly);
  const crowd::Herd& herd = stage.herd();
  CollectionTime made;
  made.rule = nearestOnly ? "nearest" : "weighed";
  made.legs = legs;

  const HerdState before = walk.crowd().download(0);
  stage.run(1);
  const HerdState after = walk.crowd().download(0);
  const CollectionCpu cpu(herd.parameters, ground, herd.rigRecords, herd.legs, herd.bones);
  std::vector<float> steps = before.step, arcs = before.arc;
  cpu.run(before, legs, stage.tick(), steps, arcs);
  std::vector<double> apart;
  size_t differing = 0;
  for (size_t at = 0; at < size_t{legs} * 4 * shared::STEP_STRIDE; at += 4 * shared::STEP_STRIDE) {
    const glm::vec3 device(after.step[at], after.step[at + 1], after.step[at + 2]);
    apart.push_back(glm::distance(device, glm::vec3(steps[at], steps[at + 1], steps[at + 2])));
    differing += apart.back() > 1e-3 ? 1 : 0;
  }
  made.apart = bench::quantile(apart, 0.5);
  made.differing = static_cast<double>(differing) / legs;

  std::vector<double> alone, row, host;
  for (int i = 0; i < settings.collectionRepetitions; ++i) {
    alone.push_back(1e3 * stage.run(1).wall);
    if (i % 8 == 0) row.push_back(1e3 * stage.run(inRow).wall / inRow);
  }
  // Short runs are repeated: a clock has its grain.
  const int times = static_cast<int>(std::max(1u, 2000 / legs));
  for (int i = 0; i < std::max(3, settings.collectionRepetitions / 10); ++i) {
    host.push_back(1e3 / times * bench::timed([&] {
                                   for (int k = 0; k < times; ++k)
                                     cpu.run(before, legs, stage.tick(), steps, arcs);
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
    Walk walk(device, ground, crossing("adaptive", agents, 1, settings.seed), settings.dt);
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
