#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/agents.h"
#include "experiments/page/plot.h"
#include "experiments/sections/sections.h"

namespace skitter::experiments {
namespace {

std::string plotOf(const GaitStudy& study, const char* title, const char* label, double GaitRow::*value) {
  Plot plot;
  plot.title = title;
  plot.x = {.label = "speed, leg lengths a second", .least = 0};
  plot.y = {.label = label, .least = 0};
  for (const Subject& subject : subjects) {
    Series series{nameOf(subject.controller), {}, subject.colour};
    for (const GaitRow& row : study.rows)
      if (row.controller == subject.controller && row.frequency > 0)
        series.points.emplace_back(row.speed, row.*value);
    plot.series.push_back(std::move(series));
  }
  return draw(plot);
}

// Swings as bars, a line a leg: the biologist's footfall diagram.
std::string footfalls(const GaitStudy& study) {
  const size_t ticks = std::min<size_t>(study.footfalls.size(), 180);
  const double wide = 860.0 / static_cast<double>(std::max<size_t>(1, ticks));
  Svg svg(930, 60 + 18 * static_cast<double>(study.legs.size()), "footfall diagram of the adaptive agent");
  svg.text({12, 20}, "adaptive at a leg length a second: legs in the air", Svg::Anchor::start, 13);
  for (size_t l = 0; l < study.legs.size(); ++l) {
    const double y = 34 + 18 * static_cast<double>(l);
    svg.text({40, y + 10}, study.legs[l], Svg::Anchor::end);
    svg.line({50, y + 14}, {910, y + 14}, colour::grid);
    for (size_t t = 0; t < ticks;) {
      size_t end = t;
      while (end < ticks && !study.footfalls[end][l]) ++end;
      if (end > t)
        svg.rectangle({50 + wide * static_cast<double>(t), y}, {wide * static_cast<double>(end - t), 12},
                      study.groups[l] == 0 ? colour::blue : colour::red);
      t = std::max(end, t + 1);
    }
  }
  const double y = 44 + 18 * static_cast<double>(study.legs.size());
  const double second = wide / study.dt;
  if (second < 860) {
    svg.line({50, y}, {50 + second, y}, colour::ink, 2);
    svg.text({50 + second + 8, y + 4}, "1 s");
  }
  return svg.str();
}

std::string agrees(bool yes) { return yes ? "agrees" : "differs"; }

Table literature(const GaitStudy& study, const GaitRow& walk) {
  const GaitStudy::Line line = study.dutyLine(Controller::adaptive);
  const std::string left = study.order(walk, 'L'), right = study.order(walk, 'R');
  // Legs that lift at once are in no order: such a walk does not contradict one, nor show it.
  const auto ordered = [](std::string order) {
    std::replace(order.begin(), order.end(), '=', '-');
    return order == "4-2-3-1";
  };
  const bool strict = left == "4-2-3-1" && right == "4-2-3-1";
  const std::string verdict =
      strict ? "agrees" : (ordered(left) && ordered(right) ? "does not contradict" : "differs");
  double bounce = 0;
  for (const GaitRow& row : study.rows)
    if (row.controller == Controller::adaptive) bounce = std::max(bounce, row.bounce);
  return {{"of spiders it is known", "source", "adaptive here", "comparison"},
          {{"duty factor 0.5 to 0.7 in walking", "recalled, not looked up",
            fmt::format("{:.2f} at {:.2f} leg lengths/s", walk.duty, walk.speed),
            agrees(walk.duty >= 0.5 && walk.duty <= 0.7)},
           {"duty factor falls linearly with speed", "Spagna et al. 2011",
            fmt::format("slope {:.3f} a leg length/s, r = {:.3f} over {} speeds", line.slope,
                        line.correlation, line.points),
            agrees(line.slope < 0 && line.correlation < -0.95)},
           {"two groups of four legs, in turn", "Barth, A Spider's World",
            fmt::format("groups {:.2f} of a cycle apart", walk.groupsApart),
            agrees(std::fabs(walk.groupsApart - 0.5) < 0.1)},
           {"legs of a group follow within 0.03 to 0.1 of a cycle", "recalled, not looked up",
            fmt::format("{:.3f} of a cycle from first to last", walk.lag),
            agrees(walk.lag >= 0.03 && walk.lag <= 0.3)},
           {"order of a side's legs mostly 4-2-3-1", "Barth, A Spider's World",
            fmt::format("left {}, right {} (= : at once)", left, right), verdict},
           {"no vertical bounce of the body", "Weihmann 2013",
            fmt::format("{:.2f} % of the leg length at most, over all speeds", 100 * bounce),
            agrees(bounce < 0.01)}}};
}

}  // namespace

void showGait(const GaitStudy& study, Report& report) {
  Page& page = report.page;
  page.section("spiders", "Beside real spiders");
  page.paragraph(
      "Agents on level ground at a range of speeds. Duty factor: the share of a cycle that a leg stands. "
      "Phases are "
      "those of lifting, in cycles of the first leg.");
  page.drawings({plotOf(study, "duty factor against speed", "duty factor", &GaitRow::duty),
                 plotOf(study, "stride frequency against speed", "cycles a second", &GaitRow::frequency),
                 plotOf(study, "stride length against speed", "leg lengths", &GaitRow::stride),
                 plotOf(study, "vertical bounce of the body", "leg lengths", &GaitRow::bounce)},
                "Spiders raise both stride frequency and stride length with speed, and lower the duty factor "
                "(Spagna et al. 2011).");
  if (!study.footfalls.empty())
    page.drawings({footfalls(study)}, "Footfall diagram: bars are legs in the air, a colour a group.");
  const GaitRow* walk = study.find(Controller::adaptive, 1);
  if (walk && walk->cycles > 0) {
    page.table(literature(study, *walk));
    Table phases{{"leg", "group", "lifts at (cycle)", "steadiness"}};
    for (size_t l = 0; l < study.legs.size(); ++l)
      phases.rows.push_back({study.legs[l], fmt::format("{}", study.groups[l]),
                             fmt::format("{:.3f}", walk->phases[l]),
                             fmt::format("{:.3f}", walk->steadiness[l])});
    page.heading("Phases of the adaptive agent at a leg length a second");
    page.table(phases);
  } else {
    page.paragraph("No whole cycle was seen at a leg length a second: no phases to compare.");
  }
  report.raw("gait.csv", study.table().csv());
}

}  // namespace skitter::experiments
