#include <fmt/format.h>

#include "experiments/page/plot.h"
#include "experiments/sections/sections.h"

namespace skitter::experiments {
namespace {

std::string dissertationTime(uint32_t legs) { return legs == 1 ? "0.83" : (legs == 4 ? "2.63" : "-"); }

Series line(const Collection& collection, const char* rule, const char* name, double CollectionTime::*value,
            const char* colour, const char* dash) {
  Series series{name, {}, colour, true, true, dash};
  for (const CollectionTime& time : collection.times)
    if (time.rule == rule) series.points.emplace_back(time.legs, time.*value);
  return series;
}

}  // namespace

void showCollection(const Collection& collection, const Settings& settings, Report& report) {
  Page& page = report.page;
  page.section("point-collection", "Point collection timed");
  page.paragraph(fmt::format(
      "Choosing a landing point among the 24 candidates of a ladder, and laying the step to it, for legs "
      "that lift: by "
      "the dissertation's rule (the point nearest to the target) and by ours (slope and reach weighed too). "
      "Device: one "
      "dispatch over a prepared list, submitted and waited for, median of {} (quartiles); and a dispatch "
      "among 32 in "
      "one submission, which is what it adds to a frame. CPU: the same stage of the CPU crowd, one leg at a "
      "time in scalar C++ on one thread. Both repeat on the records that they wrote, so all steps but the "
      "first lead from a landing point to the same point.",
      settings.collectionRepetitions));
  Table table{
      {"legs", "rule", "device, ms", "quartiles", "device in a row, ms", "CPU, ms", "dissertation, ms"}};
  double apart = 0, differing = 0;
  for (const CollectionTime& time : collection.times) {
    apart = std::max(apart, time.apart);
    differing = std::max(differing, time.differing);
    const bool its = time.rule == "nearest";
    table.rows.push_back({fmt::format("{}", time.legs), its ? "nearest (its own)" : "weighed (ours)",
                          figure(time.deviceMilliseconds),
                          fmt::format("{} to {}", figure(time.lower), figure(time.upper)),
                          figure(time.inRowMilliseconds), figure(time.cpuMilliseconds),
                          its ? dissertationTime(time.legs) : "-"});
  }
  page.table(table);
  Plot plot;
  plot.title = "time to collect the points of n legs";
  plot.x = {.label = "legs", .log = true};
  plot.y = {.label = "milliseconds", .log = true};
  plot.width = 620;
  plot.series = {
      line(collection, "nearest", "device, its rule", &CollectionTime::deviceMilliseconds, colour::blue, ""),
      line(collection, "weighed", "device, our rule", &CollectionTime::deviceMilliseconds, colour::sky,
           "6 4"),
      line(collection, "nearest", "CPU, its rule", &CollectionTime::cpuMilliseconds, colour::green, ""),
      line(collection, "weighed", "CPU, our rule", &CollectionTime::cpuMilliseconds, colour::purple, "6 4"),
      {"dissertation", {{1, 0.83}, {4, 2.63}}, colour::red},
  };
  page.drawings({draw(plot)}, "Point collection against the number of legs.");
  page.paragraph(
      fmt::format("Device and CPU choose the same points and arcs: their medians differ by at most {:.1g} m; "
                  "at most {:.2f} % of the legs differ by over a millimetre, where two candidates or two "
                  "lanes are as good.",
                  apart, 100 * differing));
  report.raw("point-collection.csv", collection.table().csv());
}

}  // namespace skitter::experiments
