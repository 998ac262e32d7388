#include <fmt/format.h>

#include "experiments/page/plot.h"
#include "experiments/sections/sections.h"

namespace skitter::experiments {
namespace {

std::string plotOf(const DamageStudy& study, const char* title, const char* label, double LostLegs::*value) {
  Plot plot;
  plot.title = title;
  plot.x = {.label = "legs lost", .least = 0};
  plot.y = {.label = label, .least = 0};
  for (const auto& [name, rows, hue] : {std::tuple("evolved", &study.byTable, colour::blue),
                                        std::tuple("by rule", &study.byRule, colour::red)}) {
    Series series{name, {}, hue};
    for (const LostLegs& row : *rows) series.points.emplace_back(row.legs, row.*value);
    plot.series.push_back(std::move(series));
  }
  return draw(plot);
}

Table besideCully(const DamageStudy& study) {
  const std::vector<uint32_t> needed = study.trialsNeeded();
  std::string trials = "no creature had a gait to look for";
  if (!study.creatures.empty())
    trials = fmt::format("{} of {} creatures", needed.size(), study.creatures.size());
  if (!needed.empty())
    trials += fmt::format(" within {} trials, half of them within {}", needed.back(),
                          needed[(needed.size() - 1) / 2]);
  return {{"", "Cully et al. 2015", "here"},
          {{"creature", "a robot with six legs", "a spider with eight legs, without dynamics"},
           {"search", "40 million evaluations of 5 s, about two weeks",
            fmt::format("{} evaluations of {:.1f} s, in {:.3g} s", study.evaluations, study.trialSeconds,
                        study.searchSeconds)},
           {"map", "13,100 to 13,240 of 15,625 cells: how long each leg stands",
            fmt::format("{} of {} cells: 64 for each pattern of lost legs", study.filled, study.cells)},
           {"trial and error", "Gaussian process over the map, at most 20 trials", "the same rule"},
           {"to 90 % of the best gait known", "not told; it walks again within two minutes", trials}}};
}

}  // namespace

void showDamage(const DamageStudy& study, const Settings& settings, Report& report) {
  Page& page = report.page;
  page.section("damage", "Lost legs");
  page.paragraph(
      "The dissertation names adaptation to damage as future work, after Cully, Clune, Tarapore and Mouret "
      "(\"Robots that can adapt like animals\", Nature 521:503). Here a spider that loses legs regroups the "
      "others at once, by a rule or by gaits that a search has found for just these legs. One that does not "
      "know what it has lost can look for a gait by trial and error, as theirs does.");
  page.table(besideCully(study));
  page.drawings({plotOf(study, "speed kept", "share of an intact spider's", &LostLegs::kept),
                 plotOf(study, "time without static stability", "share", &LostLegs::unstable)},
                fmt::format("All patterns of one to four lost legs, {:g} s each on flat ground: the median "
                            "speed, and the mean time with a stability margin below 0. Evolved: the gaits "
                            "that ship with the spider.",
                            settings.damageSeconds));
  page.table(study.table());
  report.raw("damage.csv", study.table().csv());
}

}  // namespace skitter::experiments
