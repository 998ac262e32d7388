#include <fmt/format.h>

#include "experiments/agents.h"
#include "experiments/page/plot.h"
#include "experiments/sections/sections.h"

namespace skitter::experiments {
namespace {

std::string costPlot(const Budget& budget, const Settings& settings, const char* title, const char* what) {
  Plot plot;
  plot.title = title;
  plot.x = {.label = "agents", .log = true};
  plot.y = {.label = what, .log = true};
  for (const Subject& subject : subjects) {
    Series series{nameOf(subject.controller), {}, subject.colour};
    for (const TickCost& cost : budget.costs)
      if (cost.controller == subject.controller) series.points.emplace_back(cost.agents, cost.milliseconds);
    plot.series.push_back(std::move(series));
  }
  for (const double level : settings.budgets) plot.levels.push_back({level, fmt::format("{:g} ms", level)});
  return draw(plot);
}

std::string agentsWithin(const AgentLimit* limit) {
  if (!limit) return "-";
  if (limit->next == 0) return fmt::format("{} and more", limit->agents);
  if (limit->drawn) return fmt::format("{} ({} in view)", limit->agents, limit->inView);
  return fmt::format("{}", limit->agents);
}

std::string spread(const AgentLimit* limit) {
  if (!limit || limit->agents == 0 || limit->next == 0) return "-";
  return fmt::format("{:.0f} to {:.0f}", limit->lower, limit->upper);
}

Table limitTable(const Budget& budget, const Settings& settings) {
  Table table{{"controller", "dissertation"}};
  for (const double level : settings.budgets) {
    table.head.push_back(fmt::format("agents within {:g} ms", level));
    table.head.push_back("spread");
    table.head.push_back("by CPU time");
  }
  for (const Subject& subject : subjects) {
    std::vector<std::string> row = {
        subject.title, subject.dissertationAgents > 0 ? fmt::format("{}", subject.dissertationAgents) : "-"};
    for (const double level : settings.budgets) {
      const AgentLimit* limit = nullptr;
      for (const AgentLimit& one : budget.limits)
        if (one.controller == subject.controller && one.budget == level) limit = &one;
      row.push_back(agentsWithin(limit));
      row.push_back(spread(limit));
      row.push_back(limit && limit->byCpu > 0 ? fmt::format("{:.0f}", limit->byCpu) : "-");
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table ownCounts(const Budget& simulated, const Budget& drawn) {
  Table table{{"controller", "agents", "simulation, ms", "with drawing, ms"}};
  for (const Subject& subject : subjects) {
    if (subject.dissertationAgents == 0) continue;
    std::vector<std::string> row = {nameOf(subject.controller),
                                    fmt::format("{}", subject.dissertationAgents)};
    for (const Budget* budget : {&simulated, &drawn}) {
      std::string cell = "-";
      for (const TickCost& cost : budget->costs)
        if (cost.controller == subject.controller &&
            cost.agents == static_cast<uint32_t>(subject.dissertationAgents))
          cell = figure(cost.milliseconds);
      row.push_back(cell);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string pictureOf(const FrameSize& frame) {
  std::string picture = fmt::format("{}x{}", frame.width, frame.height);
  if (frame.scale < 1)
    picture += fmt::format(", of which {:.0f} % of the pixels are shaded and the others interpolated",
                           100 * frame.scale * frame.scale);
  return picture;
}

}  // namespace

void showBudget(const Budget& simulated, const Budget& drawn, const Settings& settings, Report& report) {
  Page& page = report.page;
  page.section("figures-6-8", "Figures 6 to 8: how many agents");
  page.paragraph(
      "The dissertation counts the agents that run before performance problems are visible and gives no "
      "frame time "
      "for it: 20 pre-animated, 9 procedural, 4 adaptive. Here a problem is visible where a frame misses a "
      "display of "
      "60 Hz (16.7 ms) or, more leniently, of 30 Hz (33.3 ms).");
  page.paragraph(fmt::format(
      "Method: spiders cross rolling ground at a leg length a second. A crowd walks {} ticks ({} with "
      "drawing), then "
      "{} ({}) are timed, each recorded, submitted and waited for by itself; the median decides. Agents are "
      "doubled "
      "from {} ({}) until it passes the budget, then the bracket is halved until it is within {:.0f} % of "
      "the "
      "number. "
      "With drawing, who is far from the camera ticks less often (the default levels of rate). "
      "Spread: the number by the upper and by the lower quartiles of the ends of the bracket, in proportion. "
      "By CPU "
      "time, of a software device: the number whose CPU time fits the budget if all threads of the machine "
      "were free "
      "and shared the work evenly, which tells what others on the machine took.",
      settings.budgetSettle, settings.drawnSettle, settings.budgetTicks, settings.drawnFrames,
      settings.budgetFrom, settings.drawnFrom, 100 * settings.budgetPrecision));
  const std::string drawing = "simulation and drawing " + pictureOf(drawn.frame);
  page.drawings(
      {costPlot(simulated, settings, "simulation alone", "a tick, milliseconds (median)"),
       costPlot(drawn, settings, drawing.c_str(), "a frame, milliseconds (median)")},
      "Figures 6 to 8. Time against agents, all three agents of the dissertation and, beside them, the clip "
      "with planted feet and the key poses.");
  page.heading("Simulation alone");
  page.table(limitTable(simulated, settings));
  page.heading("With drawing " + pictureOf(drawn.frame));
  page.table(limitTable(drawn, settings));
  double empty = 1e9;
  for (const TickCost& cost : drawn.costs)
    if (cost.agents == 1) empty = std::min(empty, cost.milliseconds);
  if (empty < 1e9)
    page.paragraph(
        fmt::format("A frame with a single agent takes {} ms here: where that is beyond a budget, what does "
                    "not fit is the picture, not the agents.",
                    figure(empty)));
  page.heading("The dissertation's own numbers of agents, here");
  page.table(ownCounts(simulated, drawn));
  Table costs = simulated.costTable(), limits = simulated.limitTable();
  for (const auto& row : drawn.costTable().rows) costs.rows.push_back(row);
  for (const auto& row : drawn.limitTable().rows) limits.rows.push_back(row);
  report.raw("figures6-8-times.csv", costs.csv());
  report.raw("figures6-8-agents.csv", limits.csv());
}

}  // namespace skitter::experiments
