#include "experiments/budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <thread>

#include "bench/ik/machine.h"
#include "bench/statistics.h"
#include "experiments/walk.h"
#include "skitter/renderer.h"

namespace skitter::experiments {
namespace {

// Times crowds of one controller, each size once.
class Timer {
 public:
  Timer(Device& device, const Heightfield& ground, const Settings& settings, const Subject& subject,
        bool drawn, Budget& budget)
      : device_(device),
        ground_(ground),
        settings_(settings),
        subject_(subject),
        drawn_(drawn),
        frame_(budget.frame),
        costs_(budget.costs) {}

  TickCost cost(uint32_t agents) {
    for (const TickCost& known : costs_)
      if (known.controller == subject_.controller && known.drawn == drawn_ && known.agents == agents)
        return known;
    costs_.push_back(measure(agents));
    return costs_.back();
  }

 private:
  TickCost measure(uint32_t agents) {
    const Scene scene = crossing(subject_.controller, agents, 1, settings_.seed);
    CrowdOptions options;
    options.measure = false;  // what is judged elsewhere is no part of animating
    if (drawn_) {
      options.levels = Levels{};
      options.pose = Renderer::needsPoses(scene);
    }
    Walk walk(device_, ground_, scene, settings_.dt, options);
    std::optional<Renderer> renderer;
    if (drawn_)
      renderer.emplace(device_, walk.crowd(), frame_.width, frame_.height,
                       RendererOptions{.scale = frame_.scale});
    const auto frame = [&] {
      return base::timed([&] {
        gpu::CommandRing& ring = walk.ring();
        const VkCommandBuffer cmd = ring.begin();
        const double seconds = static_cast<double>(walk.crowd().tick() + 1) * settings_.dt;
        const View view = viewOf(scene, walk.crowd(), seconds);
        walk.crowd().lookFrom(view.eye);
        walk.crowd().record(cmd, walk.dt());
        if (renderer) renderer->record(cmd, view);
        ring.wait(ring.submit());
      });
    };
    for (uint32_t i = 0; i < (drawn_ ? settings_.drawnSettle : settings_.budgetSettle); ++i) frame();
    std::vector<double> wall, cpu;
    const uint32_t count = std::max(1u, drawn_ ? settings_.drawnFrames : settings_.budgetTicks);
    for (uint32_t i = 0; i < count; ++i) {
      const base::Seconds spent = frame();
      wall.push_back(1e3 * spent.wall);
      cpu.push_back(1e3 * spent.cpu);
    }
    return {subject_.controller,
            drawn_,
            agents,
            renderer ? renderer->counts().agents : uint64_t{0},
            bench::quantile(wall, 0.5),
            bench::quantile(wall, 0.25),
            bench::quantile(wall, 0.75),
            bench::quantile(cpu, 0.5)};
  }

  Device& device_;
  const Heightfield& ground_;
  const Settings& settings_;
  const Subject& subject_;
  bool drawn_;
  FrameSize frame_;
  std::vector<TickCost>& costs_;
};

// Agents at which the budget is met between two sizes, if the time grows evenly between them.
double budgetCrossing(double budget, double fewAgents, double few, double manyAgents, double many) {
  if (!(many > few)) return fewAgents;
  return std::clamp(fewAgents + (budget - few) / (many - few) * (manyAgents - fewAgents), 0.0,
                    2 * manyAgents);
}

// Where the CPU time of the sizes measured crosses what all threads have to give in the budget; beyond the
// largest size, in proportion.
double byCpu(const std::vector<TickCost>& costs, Controller controller, double budget) {
  const double given = budget * std::thread::hardware_concurrency();
  std::vector<TickCost> sizes;
  for (const TickCost& cost : costs)
    if (cost.controller == controller) sizes.push_back(cost);
  std::sort(sizes.begin(), sizes.end(),
            [](const TickCost& a, const TickCost& b) { return a.agents < b.agents; });
  if (sizes.size() < 2 || sizes.front().cpuMilliseconds > given) return 0;
  const TickCost *below = &sizes.front(), *above = &sizes.back();
  for (const TickCost& cost : sizes) {
    if (cost.cpuMilliseconds <= given) below = &cost;
    if (cost.cpuMilliseconds > given && above->cpuMilliseconds > given && cost.agents < above->agents)
      above = &cost;
  }
  if (below->agents >= above->agents) below = &sizes.front();
  const double more = above->cpuMilliseconds - below->cpuMilliseconds;
  if (!(more > 0)) return below->agents;
  return below->agents + (given - below->cpuMilliseconds) / more * (above->agents - below->agents);
}

AgentLimit search(Timer& timer, const Settings& settings, uint32_t from, double budget,
                  const std::function<void()>& step) {
  const auto within = [&](uint32_t agents) {
    step();
    return timer.cost(agents).milliseconds <= budget;
  };
  AgentLimit found;
  found.budget = budget;
  // Where not even one fits, as with drawing on a slow device, nothing is to be searched.
  uint32_t few = within(1) ? 1 : 0, many = few > 0 ? std::max(2u, from) : 1;
  while (few > 0 && within(many)) {
    few = many;
    if (many >= settings.budgetMost) {
      found.agents = few;
      found.inView = timer.cost(few).inView;
      found.lower = found.upper = few;
      return found;
    }
    many = std::min(2 * many, settings.budgetMost);
  }
  while (many - few > std::max(1.0, settings.budgetPrecision * few)) {
    const uint32_t middle = few + (many - few) / 2;
    (within(middle) ? few : many) = middle;
  }
  const TickCost high = timer.cost(many), low = few > 0 ? timer.cost(few) : TickCost{};
  found.agents = few;
  found.inView = low.inView;
  found.next = many;
  found.lower = budgetCrossing(budget, few, low.upper, many, high.upper);
  found.upper = budgetCrossing(budget, few, low.lower, many, high.lower);
  return found;
}

}  // namespace

Budget measureBudget(Device& device, const Heightfield& ground, const Settings& settings, bool drawn,
                     Course& course) {
  Budget made;
  made.frame = bench::isCpu(device.report()) ? settings.softwareFrame : settings.frame;
  const double searches = static_cast<double>(subjects.size() * settings.budgets.size());
  double done = 0;
  for (const Subject& subject : subjects) {
    Timer timer(device, ground, settings, subject, drawn, made);
    // What the dissertation had: its number of agents of that kind.
    if (subject.dissertationAgents > 0 && settings.budgetFrom > 2)
      timer.cost(static_cast<uint32_t>(subject.dissertationAgents));
    for (const double budget : settings.budgets) {
      double steps = 0;
      AgentLimit limit =
          search(timer, settings, drawn ? settings.drawnFrom : settings.budgetFrom, budget, [&] {
            // How many steps it takes is not known before: each takes a share of what is left.
            course.at((done + 1 - std::pow(0.85, ++steps)) / searches);
          });
      limit.controller = subject.controller;
      limit.drawn = drawn;
      if (bench::isCpu(device.report())) limit.byCpu = byCpu(made.costs, subject.controller, budget);
      made.limits.push_back(limit);
      ++done;
    }
  }
  std::stable_sort(made.costs.begin(), made.costs.end(), [](const TickCost& a, const TickCost& b) {
    return a.controller == b.controller && a.agents < b.agents;
  });
  return made;
}

const AgentLimit* Budget::limit(Controller controller, bool drawn, double budget) const {
  for (const AgentLimit& limit : limits)
    if (limit.controller == controller && limit.drawn == drawn && limit.budget == budget) return &limit;
  return nullptr;
}

Table Budget::costTable() const {
  Table table{{"controller", "drawn", "agents", "in_view", "median_ms", "lower_quartile_ms",
               "upper_quartile_ms", "median_cpu_ms"}};
  for (const TickCost& cost : costs)
    table.rows.push_back({nameOf(cost.controller), cost.drawn ? "1" : "0", fmt::format("{}", cost.agents),
                          fmt::format("{}", cost.inView), fmt::format("{:.4f}", cost.milliseconds),
                          fmt::format("{:.4f}", cost.lower), fmt::format("{:.4f}", cost.upper),
                          fmt::format("{:.4f}", cost.cpuMilliseconds)});
  return table;
}

Table Budget::limitTable() const {
  Table table{{"controller", "drawn", "budget_ms", "agents", "in_view", "next", "by_upper_quartiles",
               "by_lower_quartiles", "by_cpu"}};
  for (const AgentLimit& limit : limits)
    table.rows.push_back({nameOf(limit.controller), limit.drawn ? "1" : "0",
                          fmt::format("{:g}", limit.budget), fmt::format("{}", limit.agents),
                          fmt::format("{}", limit.inView), fmt::format("{}", limit.next),
                          fmt::format("{:.0f}", limit.lower), fmt::format("{:.0f}", limit.upper),
                          fmt::format("{:.0f}", limit.byCpu)});
  return table;
}

}  // namespace skitter::experiments
