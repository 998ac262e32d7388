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

#include "app/commands.h"
#include "app/common/files.h"
#include "app/common/manifest.h"
#include "app/common/scene_options.h"
#include "app/common/signals.h"
#include "app/common/staged_folder.h"
#include "app/fields/field_map.h"
#include "app/fields/field_page.h"
#include "assets/files/partial_file.h"
#include "crowd/herd.h"
#include "crowd/radius.h"
#include "crowd/readback.h"
#include "crowd/ways/look.h"
#include "skitter/crowd.h"
#include "skitter/error.h"
#include "skitter/image.h"

namespace skitter::app {
namespace {

namespace fs = std::filesystem;

constexpr double mapBytes = 1 << 20;  // of a map, at most about so much

struct FieldsOptions {
  SceneOptions scene;
  std::string out;
  bool force = false;
};

bool isFieldFile(const fs::path& name) {
  return name == "index.html" || name == "fields.json" ||
         (name.extension() == ".png" && name.string().starts_with("herd"));
}

void checkWays(const Scene& scene) {
  if (std::ranges::none_of(scene.herds, [](const Herd& herd) { return herd.ways.has_value(); }))
    throw inputError(
        fmt::format("{}: no herd has ways, expected one with \"ways\": {{}} (docs/ways.md)", scene.name));
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

std::vector<glm::vec2> startsOf(const Crowd::Impl& crowd, const KindView& view, const glm::vec2& goal) {
  constexpr std::array records = {Record::goal, Record::body};
  std::vector<glm::vec2> starts;
  for (const uint32_t herd : view.herds) {
    const HerdState state = crowd::downloadRecords(crowd, herd, records);
    for (uint32_t agent = 0; agent < state.agents; ++agent) {
      const float* wanted = &state.goal[size_t{agent} * 4 * shared::GOAL_STRIDE];
      const float* body = &state.body[size_t{agent} * 4 * shared::BODY_STRIDE];
      const bool hasIt = &crowd.kindOf(herd, agent) == &view.kind && body[7] == 0 &&
                         wanted[6] == shared::GOAL_POINT && glm::vec2(wanted[0], wanted[1]) == goal;
      if (!hasIt) continue;
      starts.push_back(crowd::placeOf(body));
    }
  }
  return starts;
}

// All maps of a crowd: written into a folder, with the figures and the page that shows them.
class FieldReport {
 public:
  FieldReport(const Scene& scene, const Crowd& crowd, StagedFolder& out)
      : scene_(scene), crowd_(implOf(crowd)), out_(out) {}

  void add(const KindView& view) {
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
    const Ways& ways = *view.kind.wayNeeds;
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

  void finish(const Manifest& manifest) {
    writeJson(out_.add("fields.json"), {{"grids", grids_}}, manifest);
    writeText(out_.add("index.html"),
              fieldPage(fmt::format("Fields of {}", scene_.name),
                        fmt::format("{}. Seen from above: x to the right, z down.", describe(crowd_.terrain)),
                        page_));
  }

 private:
  std::string write(const std::string& name, const Drawing& drawing) {
    if (stopRequested()) throw Interrupted(StopDeadline::nothingWritten());
    writePng(out_.add(name), drawing.width(), drawing.height(), drawing.rgba());
    return name;
  }

  nlohmann::ordered_json add(const KindView& view, MapGround ground, const glm::vec2& target, size_t number) {
    const crowd::WayFields& ways = *view.kind.ways;
    const crowd::Stops& stops = ways.stopsAt(target);
    const std::vector<float> times = ways.times(target);
    const uint32_t region = ways.regions().of[crowd::cellAt(ways.grid(), stops.stop)];
    MapGoal goal{.goal = target,
                 .stop = stops.stop,
                 .times = times,
                 .reached = std::vector<bool>(times.size()),
                 .starts = startsOf(crowd_, view, target)};
    for (size_t cell = 0; cell < times.size(); ++cell)
      goal.reached[cell] = region != crowd::Regions::none && ways.regions().of[cell] == region;
    const auto cannot = static_cast<size_t>(std::ranges::count_if(goal.starts, [&](const glm::vec2& start) {
      const uint32_t of = ways.regions().of[crowd::cellAt(ways.grid(), start)];
      return of != crowd::Regions::none && of != stops.region;
    }));
    const TimeFigures figures = figuresOf(ground, goal);
    ground.title = fmt::format("Time to ({:g}, {:g}) for {}", target.x, target.y, view.who());
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
    return {{"target", {target.x, target.y}}, {"stop", {goal.stop.x, goal.stop.y}},
            {"agents", goal.starts.size()},   {"cannotReach", cannot},
            {"reached", figures.reached},     {"timeMean", figures.mean},
            {"timeMost", figures.most},       {"picture", picture}};
  }

  const Scene& scene_;
  const Crowd::Impl& crowd_;
  StagedFolder& out_;
  nlohmann::ordered_json grids_ = nlohmann::ordered_json::array();
  std::vector<PageFigure> page_;
};

int writeFields(const FieldsOptions& options) {
  Files files;
  files.fills("--out", options.out, isFieldFile, options.force);
  const Scene scene = options.scene.load();
  checkWays(scene);
  options.scene.declare(files, scene);
  files.expect("--out", mapBytes * static_cast<double>(2 * scene.herds.size()));
  files.check();
  std::optional<StopDeadline> deadline(std::in_place);
  const Heightfield terrain = scene.loadTerrain();
  DeviceRequest request;
  request.device = options.scene.device;
  Device device = Device::create(request);
  const Crowd crowd(device, terrain, scene, {.pose = false, .measure = false});
  files.check();
  deadline.reset();

  Manifest manifest{.scene = &scene, .terrain = &terrain};
  manifest.add(device.report());
  StagedFolder out(options.out);
  FieldReport report(scene, crowd, out);
  const Crowd::Impl& impl = implOf(crowd);
  for (uint32_t k = 0; k < impl.kinds.size(); ++k) {
    if (!impl.kinds[k].ways) continue;
    const KindView view(impl, k);
    report.add(view);
    fmt::print("{:<14} {} cells, {} goals\n", view.name, impl.kinds[k].ways->grid().cost.size(),
               impl.kinds[k].ways->goals().size());
  }
  report.finish(manifest);
  out.commit();
  fmt::print("written        {}\n", (fs::path(options.out) / "index.html").string());
  return 0;
}

}  // namespace

void addFields(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<FieldsOptions>();
  CLI::App* command = app.add_subcommand(
      "fields", "Draw the cost grids and the fields of a scene's herds that find their way");
  options->scene.addTo(*command, "the scene's");
  command->add_option("--out", options->out, "folder for the pictures, fields.json and index.html")
      ->type_name("DIR")
      ->required();
  command->add_flag("--force", options->force, "write into a folder that is not empty and no earlier run's");
  command->footer(
      "A cost grid for each kind of herds and size, and a field for each of its goals, as they are when the "
      "scene "
      "begins. docs/ways.md says what they are.\n"
      "\n"
      "Examples:\n"
      "  skitter fields assets/scenes/maze.json --out fields");
  command->callback([options, &chosen] { chosen = [options] { return writeFields(*options); }; });
}

}  // namespace skitter::app
