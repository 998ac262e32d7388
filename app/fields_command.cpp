#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "app/commands.h"
#include "app/common/files.h"
#include "app/common/manifest.h"
#include "app/common/progress.h"
#include "app/common/scene_options.h"
#include "app/common/signals.h"
#include "app/common/staged_folder.h"
#include "app/common/values.h"
#include "app/fields/field_map.h"
#include "app/fields/field_page.h"
#include "assets/files/partial_file.h"
#include "crowd/herd.h"
#include "crowd/radius.h"
#include "crowd/readback.h"
#include "crowd/ways/look.h"
#include "gpu/submit.h"
#include "skitter/colony.h"
#include "skitter/crowd.h"
#include "skitter/error.h"
#include "skitter/image.h"

namespace skitter::app {
namespace {

namespace fs = std::filesystem;

constexpr double mapBytes = 1 << 20;  // of a map, at most about so much
constexpr double mostSeconds = 86400;
constexpr uint64_t mostScoutIterations = 100000;

struct FieldsOptions {
  SceneOptions scene;
  std::string out;
  double at = 0;                        // seconds after the beginning
  std::optional<uint32_t> scouts = {};  // iterations of a colony for each goal
  bool force = false, quiet = false;

  uint64_t ticks() const { return static_cast<uint64_t>(std::llround(at / scene.dt)); }
};

bool isFieldFile(const fs::path& name) {
  return name == "index.html" || name == "fields.json" ||
         (name.extension() == ".png" && name.string().starts_with("herd"));
}

void checkHerds(const Scene& scene) {
  const auto isDrawn = [](const Herd* herd) { return herd->ways || herd->forage; };
  if (std::ranges::none_of(herdsOf(scene), isDrawn))
    throw inputError(fmt::format(
        "{}: no herd has ways or forage, expected one with \"ways\": {{}} or \"forage\": {{}} (docs/ways.md)",
        scene.name));
}

// The herds of a kind, and its agents that have a field's goal.
struct KindView {
  const crowd::Kind& kind;
  std::vector<uint32_t> herds;
  std::string name;  // of its files

  KindView(const Crowd::Impl& crowd, uint32_t k) : kind(crowd.kinds[k]) {
    for (const crowd::HerdRun& of : crowd::runsOf(crowd, k)) {
      if (herds.empty()) {
        name = fmt::format("herd{}", of.number);
        if (of.herd->runs.size() > 1) name += fmt::format("_size{}", of.run - of.herd->runs.data());
      }
      herds.push_back(of.number);
    }
  }
  std::string who() const {
    return fmt::format("{} {} ({}{})", herds.size() > 1 ? "herds" : "herd", fmt::join(herds, ", "),
                       kind.rig.name, kind.size == 1 ? "" : fmt::format(", size {:g}", kind.size));
  }
};

// Where the kind's agents are for whose goal record isMeant(goal) holds.
template <class IsMeant>
std::vector<glm::vec2> placesOf(const Crowd::Impl& crowd, const KindView& view, const IsMeant& isMeant) {
  constexpr std::array records = {Record::goal, Record::body};
  std::vector<glm::vec2> places;
  for (const uint32_t herd : view.herds) {
    const HerdState state = crowd::downloadRecords(crowd, herd, records);
    for (uint32_t agent = 0; agent < state.agents; ++agent) {
      const float* wanted = &state.goal[size_t{agent} * 4 * shared::GOAL_STRIDE];
      const float* body = &state.body[size_t{agent} * 4 * shared::BODY_STRIDE];
      if (&crowd.kindOf(herd, agent) == &view.kind && body[7] == 0 && isMeant(wanted))
        places.push_back(crowd::placeOf(body));
    }
  }
  return places;
}

std::vector<glm::vec2> startsOf(const Crowd::Impl& crowd, const KindView& view, const glm::vec2& goal) {
  return placesOf(crowd, view, [&](const float* wanted) {
    const bool isLed = wanted[6] == shared::GOAL_POINT || wanted[6] == shared::GOAL_SERIES;
    return isLed && glm::vec2(wanted[0], wanted[1]) == goal;
  });
}

// What a colony of scouts comes to that looks for a path to a goal's stop (docs/colony.md).
struct ScoutView {
  glm::vec2 nest{0};  // the middle of the cell in which the first agent with that goal is
  std::optional<ColonyPath> path;
  std::vector<float> pheromone;  // the most of each cell's moves, per cent of the most there is
};

glm::uvec2 columnAndRow(const CostGrid& grid, size_t cell) {
  return {static_cast<uint32_t>(cell % grid.columns), static_cast<uint32_t>(cell / grid.columns)};
}

// None where no agent with that goal can reach it.
std::optional<ScoutView> scoutsOf(Device& device, const crowd::WayFields& ways, const crowd::Stops& stops,
                                  std::span<const glm::vec2> starts, uint32_t iterations, uint64_t seed) {
  const CostGrid& grid = ways.grid();
  const size_t goal = crowd::cellAt(grid, stops.stop);
  const uint32_t region = ways.regions().of[goal];
  const auto first = std::ranges::find_if(starts, [&](const glm::vec2& start) {
    return region != crowd::Regions::none && ways.regions().of[crowd::cellAt(grid, start)] == region;
  });
  if (first == starts.end()) return {};
  const size_t nest = crowd::cellAt(grid, *first);
  Colony colony(device, grid, columnAndRow(grid, nest), columnAndRow(grid, goal), {.seed = seed});
  for (uint32_t done = 0; done < iterations && !stopRequested(); ++done) colony.search(1);
  ScoutView view{.nest = crowd::middleOf(grid, nest), .path = colony.best(), .pheromone = {}};
  const std::vector<uint32_t> moves = colony.downloadPheromone();
  for (size_t cell = 0; cell < grid.cost.size(); ++cell) {
    const auto most = std::ranges::max(std::span(moves).subspan(8 * cell, 8));
    view.pheromone.push_back(100 * static_cast<float>(most) * 0x1p-20f);
  }
  return view;
}

// All maps of a crowd: written into a folder, with the figures and the page that shows them.
class FieldReport {
 public:
  FieldReport(const FieldsOptions& options, const Scene& scene, Device& device, const Crowd& crowd,
              StagedFolder& out)
      : options_(options), scene_(scene), device_(device), asked_(crowd), crowd_(implOf(crowd)), out_(out) {}

  void add(const KindView& view) {
    if (view.kind.ways) addWays(view);
    if (view.kind.trails) addTrail(view);
  }

  void finish(const Manifest& manifest) {
    writeJson(out_.add("fields.json"),
              {{"tick", crowd_.tick}, {"seconds", seconds()}, {"grids", grids_}, {"trails", trails_}},
              manifest);
    writeText(out_.add("index.html"),
              fieldPage(fmt::format("Fields of {}", scene_.name),
                        fmt::format("{}, after {:g} s. Seen from above: x to the right, z down.",
                                    describe(crowd_.terrain), seconds()),
                        page_));
  }

 private:
  double seconds() const { return static_cast<double>(crowd_.tick) * options_.scene.dt; }

  void addWays(const KindView& view) {
    const CostGrid& grid = view.kind.ways->grid();
    MapGround ground{
        .terrain = crowd_.terrain,
        .obstacles = crowd_.scene.obstacles,
        .grid = grid,
        .title = fmt::format("Cost of the ground to {}", view.who()),
        .subtitle = fmt::format("{}: {} x {} cells of {:.3g} m; leg {:.3g} m, footprint {:.3g} m",
                                scene_.name, grid.columns, grid.rows, grid.cell, view.kind.rig.legLength,
                                crowd::footprintRadius(view.kind.rig))};
    const MapFigures figures = figuresOf(grid);
    const std::string picture = write(view.name + "_cost.png", drawCosts(ground));
    page_.push_back(
        {ground.title,
         picture,
         "map of the cost of the ground",
         "The paler a cell, the quicker its ground; dark red is slowest. Grey cells are impassable: too "
         "steep, too high a step, too close to an obstacle or to the edge.",
         {{"cells", fmt::format("{} x {}", grid.columns, grid.rows)},
          {"metres a cell", fmt::format("{:.4g}", grid.cell)},
          {"passable", fmt::format("{:.1f} %", 100 * figures.passable)},
          {"regions", fmt::format("{}", view.kind.ways->regions().count)},
          {"cost, mean", fmt::format("{:.3f}", figures.costMean)},
          {"cost, most", fmt::format("{:.3f}", figures.costMost)}}});
    const Ways& ways = view.kind.wayfaring->ways;
    nlohmann::ordered_json goals = nlohmann::ordered_json::array();
    for (const glm::vec2& goal : view.kind.ways->goals())
      goals.push_back(add(view, ground, goal, goals.size()));
    grids_.push_back({{"herds", view.herds},
                      {"rig", view.kind.rig.name},
                      {"size", view.kind.size},
                      {"legLength", view.kind.rig.legLength},
                      {"footprintRadius", crowd::footprintRadius(view.kind.rig)},
                      {"ways", {{"climb", ways.climb}, {"steepest", ways.steepest}, {"step", ways.step}}},
                      {"columns", grid.columns},
                      {"rows", grid.rows},
                      {"cell", grid.cell},
                      {"origin", {grid.origin.x, grid.origin.y}},
                      {"passable", figures.passable},
                      {"regions", view.kind.ways->regions().count},
                      {"costMean", figures.costMean},
                      {"costMost", figures.costMost},
                      {"picture", picture},
                      {"goals", goals}});
  }

  void addTrail(const KindView& view) {
    const uint32_t herd = view.herds.front();
    const CostGrid& grid = view.kind.trails->grid();
    const Forage& forage = view.kind.trails->forage();
    const PheromoneGrid pheromone = asked_.pheromone(herd);
    const Foraging done = asked_.foraging(herd);
    MapTrail trail{.what = "units of pheromone",
                   .values = pheromone.units,
                   .nests = {forage.nest},
                   .agents = placesOf(crowd_, view, [](const float*) { return true; })};
    for (const FoodSource& source : forage.food) trail.food.push_back({source.centre, source.radius});
    const MapGround ground{.terrain = crowd_.terrain,
                           .obstacles = crowd_.scene.obstacles,
                           .grid = grid,
                           .title = fmt::format("Pheromone of {}", view.who()),
                           .subtitle = fmt::format("{}: {} x {} cells of {:.3g} m, after {:g} s", scene_.name,
                                                   grid.columns, grid.rows, grid.cell, seconds())};
    const TrailFigures figures = figuresOf(ground, trail);
    const std::string picture = write(view.name + "_trail.png", drawTrail(ground, trail));
    page_.push_back(
        {ground.title,
         picture,
         "map of the pheromone of foragers",
         "The darker a cell, the more pheromone is there; colours go by its root. The red ring is "
         "the nest, blue ones are food.",
         {{"loads carried home", fmt::format("{}", done.brought)},
          {"returns without one", fmt::format("{}", done.empty)},
          {"passable ground with pheromone", fmt::format("{:.1f} %", 100 * figures.marked)},
          {"most in a cell", fmt::format("{:.1f} units", figures.most)}}});
    trails_.push_back({{"herds", view.herds},
                       {"rig", view.kind.rig.name},
                       {"columns", grid.columns},
                       {"rows", grid.rows},
                       {"cell", grid.cell},
                       {"origin", {grid.origin.x, grid.origin.y}},
                       {"agents", trail.agents.size()},
                       {"brought", done.brought},
                       {"empty", done.empty},
                       {"taken", done.taken},
                       {"passed", done.passed},
                       {"marked", figures.marked},
                       {"unitsMost", figures.most},
                       {"unitsSum", figures.sum},
                       {"picture", picture}});
  }

  std::string write(const std::string& name, const Drawing& drawing) {
    if (stopRequested()) throw Interrupted(StopDeadline::nothingWritten());
    writePng(out_.add(name), drawing.width(), drawing.height(), drawing.rgba());
    return name;
  }

  nlohmann::ordered_json add(const KindView& view, MapGround ground, const glm::vec2& target, size_t number) {
    const crowd::WayFields& ways = *view.kind.ways;
    const crowd::Stops& stops = ways.stopsAt(target);
    const std::vector<glm::vec4> times = ways.timesAround(target);
    const bool isWayOut = target == glm::vec2(shared::WAY_OUT);
    const uint32_t region = ways.regions().of[crowd::cellAt(ways.grid(), stops.stop)];
    MapGoal goal{.goal = target,
                 .stop = stops.stop,
                 .times = times,
                 .reached = std::vector<bool>(times.size()),
                 .starts = startsOf(crowd_, view, target)};
    for (size_t cell = 0; cell < times.size(); ++cell) {
      const uint32_t of = ways.regions().of[cell];
      goal.reached[cell] = of != crowd::Regions::none && (isWayOut || of == region);
    }
    const auto cannot = static_cast<size_t>(std::ranges::count_if(goal.starts, [&](const glm::vec2& start) {
      const uint32_t of = ways.regions().of[crowd::cellAt(ways.grid(), start)];
      return !isWayOut && of != crowd::Regions::none && of != stops.region;
    }));
    const TimeFigures figures = figuresOf(ground, goal);
    ground.title = isWayOut ? fmt::format("Time out of threats and obstacles for {}", view.who())
                            : fmt::format("Time to ({:g}, {:g}) for {}", target.x, target.y, view.who());
    const std::string picture =
        write(fmt::format("{}_goal{}.png", view.name, number), drawTimes(ground, goal));
    page_.push_back({ground.title,
                     picture,
                     "map of the time to the goal and of the flow",
                     "Colours are the time that the quickest way to the goal takes at 1 m/s, over flat "
                     "ground as long as in "
                     "metres. White lines are equal times; arrows point down the way. The orange lines are "
                     "ways of some agents.",
                     {{"agents with this goal", fmt::format("{}", goal.starts.size())},
                      {"of these cannot reach it", fmt::format("{}", cannot)},
                      {"stop", fmt::format("({:.4g}, {:.4g})", goal.stop.x, goal.stop.y)},
                      {"passable ground that leads there", fmt::format("{:.1f} %", 100 * figures.reached)},
                      {"time, mean", fmt::format("{:.1f} s", figures.mean)},
                      {"time, most", fmt::format("{:.1f} s", figures.most)}}});
    return {{"target", {target.x, target.y}},
            {"stop", {goal.stop.x, goal.stop.y}},
            {"agents", goal.starts.size()},
            {"cannotReach", cannot},
            {"reached", figures.reached},
            {"timeMean", figures.mean},
            {"timeMost", figures.most},
            {"picture", picture},
            {"scouts", addScouts(view, ground, stops, goal.starts, number)}};
  }

  // Null where nobody asked for scouts, or nobody can reach the goal.
  nlohmann::ordered_json addScouts(const KindView& view, MapGround ground, const crowd::Stops& stops,
                                   std::span<const glm::vec2> starts, size_t number) {
    if (!options_.scouts || stops.stop == glm::vec2(shared::WAY_OUT)) return nullptr;
    const auto found = scoutsOf(device_, *view.kind.ways, stops, starts, *options_.scouts, scene_.seed);
    if (!found) return nullptr;
    MapTrail trail{.what = "per cent of the most pheromone",
                   .values = found->pheromone,
                   .nests = {{.centre = found->nest, .radius = ground.grid.cell}},
                   .food = {{.centre = stops.stop, .radius = ground.grid.cell}}};
    if (found->path) trail.path = found->path->points;
    ground.title = fmt::format("Pheromone of scouts to ({:g}, {:g})", stops.stop.x, stops.stop.y);
    const TrailFigures figures = figuresOf(ground, trail);
    const std::string picture =
        write(fmt::format("{}_goal{}_scouts.png", view.name, number), drawTrail(ground, trail));
    page_.push_back(
        {ground.title,
         picture,
         "map of the pheromone of scouts",
         "What a colony of scouts has laid that looks for a path from the first agent to its goal: "
         "the most of a cell's eight moves. The red ring is where they begin, the blue one where "
         "they want to go.",
         {{"iterations", fmt::format("{}", *options_.scouts)},
          {"length of the best path", found->path
                                          ? fmt::format("{:.1f} m of flat ground", found->path->length)
                                          : std::string("none was found")},
          {"most in a cell", fmt::format("{:.1f} %", figures.most)}}});
    nlohmann::ordered_json length = nullptr, iteration = nullptr;
    if (found->path) length = found->path->length;
    if (found->path) iteration = found->path->iteration;
    return {{"iterations", *options_.scouts},
            {"nest", {found->nest.x, found->nest.y}},
            {"length", length},
            {"iteration", iteration},
            {"picture", picture}};
  }

  const FieldsOptions& options_;
  const Scene& scene_;
  Device& device_;
  const Crowd& asked_;
  const Crowd::Impl& crowd_;
  StagedFolder& out_;
  nlohmann::ordered_json grids_ = nlohmann::ordered_json::array(), trails_ = grids_;
  std::vector<PageFigure> page_;
};

// Runs the scene up to the time that is drawn.
void runTo(Device& device, Crowd& crowd, const FieldsOptions& options) {
  const uint64_t ticks = options.ticks();
  if (ticks == 0) return;
  Progress progress("ticks", ticks, options.quiet);
  gpu::CommandRing ring(device.context());
  while (crowd.tick() < ticks) {
    if (stopRequested()) throw Interrupted(interruptedAfter(crowd.tick(), ticks, "ticks"));
    const StopDeadline deadline;
    crowd.record(ring.begin(), static_cast<float>(options.scene.dt));
    ring.wait(ring.submit());
    progress.update(crowd.tick());
  }
}

int writeFields(const FieldsOptions& options) {
  Files files;
  files.fills("--out", options.out, isFieldFile, options.force);
  const Scene scene = options.scene.load();
  checkHerds(scene);
  options.scene.declare(files, scene);
  files.expect("--out", mapBytes * static_cast<double>((options.scouts ? 3 : 2) * herdsOf(scene).size()));
  files.check();
  std::optional<StopDeadline> deadline(std::in_place);
  const Heightfield terrain = scene.loadTerrain();
  Device device = Device::create({.device = options.scene.device});
  Crowd crowd(device, terrain, scene, {.pose = false, .measure = false});
  files.check();
  deadline.reset();
  runTo(device, crowd, options);

  Manifest manifest{.scene = &scene, .terrain = &terrain, .dt = options.scene.dt};
  manifest.add(device.report());
  StagedFolder out(options.out);
  FieldReport report(options, scene, device, crowd, out);
  const Crowd::Impl& impl = implOf(std::as_const(crowd));
  for (uint32_t k = 0; k < impl.kinds.size(); ++k) {
    const crowd::Kind& kind = impl.kinds[k];
    if (!kind.ways && !kind.trails) continue;
    const KindView view(impl, k);
    report.add(view);
    if (kind.ways)
      fmt::print("{:<14} {} cells, {} goals\n", view.name, kind.ways->grid().cost.size(),
                 kind.ways->goals().size());
    if (kind.trails) fmt::print("{:<14} {} cells with a trail\n", view.name, kind.trails->grid().cost.size());
  }
  report.finish(manifest);
  out.commit();
  fmt::print("written        {}\n", (fs::path(options.out) / "index.html").string());
  return 0;
}

}  // namespace

void addFields(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<FieldsOptions>();
  CLI::App* command =
      app.add_subcommand("fields", "Draw the cost grids, the fields and the pheromone of a scene's herds");
  options->scene.addTo(*command, "the scene's");
  command->add_option("--out", options->out, "folder for the pictures, fields.json and index.html")
      ->type_name("DIR")
      ->required();
  command
      ->add_option_function<std::string>(
          "--at",
          [options](const std::string& text) { options->at = parseNumber("--at", text, 0, mostSeconds); },
          "run the scene so long before it is drawn [0]")
      ->type_name("SECONDS");
  command
      ->add_option_function<std::string>(
          "--scouts",
          [options](const std::string& text) {
            options->scouts = static_cast<uint32_t>(parseWhole("--scouts", text, 1, mostScoutIterations));
          },
          "also let a colony of scouts search for a path to each goal, in so many iterations, and draw what "
          "they lay (docs/colony.md)")
      ->type_name("N");
  command->add_flag("--force", options->force, "write into a folder that is not empty and no earlier run's");
  command->add_flag("--quiet", options->quiet, "no progress on stderr");
  command->footer(
      "A cost grid for each kind of herds and size, a field for each of its goals, and the pheromone of "
      "those "
      "who\n"
      "forage. docs/ways.md and docs/foraging.md say what they are.\n"
      "\n"
      "Examples:\n"
      "  skitter fields assets/scenes/maze.json --out fields --scouts 100\n"
      "  skitter fields assets/scenes/foraging.json --out fields --at 120");
  command->callback([options, &chosen] { chosen = [options] { return writeFields(*options); }; });
}

}  // namespace skitter::app
