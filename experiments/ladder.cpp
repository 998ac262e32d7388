#include "experiments/ladder.h"

#include <fmt/format.h>

#include <algorithm>

#include "crowd/herd.h"
#include "experiments/walk.h"
#include "validation/convert.h"

namespace skitter::experiments {
namespace {

// How unlike a plane the candidates' heights are: a leg that has something to choose from is worth a picture.
double variety(const reference::FootholdResult& result) {
  double least = result.candidates.front().point.y, most = least;
  size_t fitting = 0;
  for (const reference::Candidate& candidate : result.candidates) {
    least = std::min(least, candidate.point.y);
    most = std::max(most, candidate.point.y);
    fitting += candidate.fits ? 1 : 0;
  }
  const bool chooses = fitting > 4 && fitting < result.candidates.size();
  constexpr int predicted = 11;  // (3, 0): taken without a look at the others
  return (most - least) * (chooses ? 1 : 0.1) * (result.chosen == predicted ? 0.3 : 1) *
         (result.lastResort ? 0.01 : 1);
}

struct Setting {
  reference::Tuning tuning;
  reference::Heights heights;
  reference::Creature creature;
};

// Looks at every leg that lifted in tick n and keeps the best.
void look(const Setting& setting, const Rig& rig, uint64_t n, const HerdState& before, const HerdState& after,
          Ladder& best) {
  const auto legs = static_cast<size_t>(rig.legCount());
  for (size_t agent = 0; agent < after.agents; ++agent) {
    const reference::Gait gait = validation::gaitOf(after, agent);
    const reference::AgentBody body = validation::bodyOf(after, agent);
    for (size_t l = 0; l < legs; ++l) {
      if ((gait.lift >> l & 1u) == 0) continue;
      const size_t leg = agent * legs + l;
      reference::FootholdResult result =
          reference::foothold(setting.tuning, setting.heights, setting.creature.limbs[l], body, gait,
                              validation::stepOf(before, leg), true, static_cast<double>(n));
      if (best.found && variety(result) <= variety(best.result)) continue;
      const glm::dvec2 world = body.world();
      const glm::dvec3 at(world.x, body.y, world.y);
      const reference::Step step = validation::stepOf(after, leg);
      best.found = true;
      best.leg = rig.legs[l].name;
      best.legLength = rig.legLength;
      best.body = at;
      best.root = at + body.orientation * result.root;
      best.target = at + body.orientation * result.target;
      best.liftOff = at + result.step.relative(result.step.liftOff, body);
      best.landing = at + step.relative(step.landing, body);
      best.apart = glm::distance(best.landing, at + result.step.relative(result.step.landing, body));
      best.points.clear();
      for (const reference::Candidate& candidate : result.candidates)
        best.points.push_back(at + candidate.point);
      best.result = std::move(result);
    }
  }
}

// A grid over what the candidates, the root and the target span, and a margin.
std::vector<std::vector<glm::dvec3>> groundAbout(const Heightfield& field, const Ladder& ladder) {
  constexpr int lines = 16;
  glm::dvec3 least = ladder.root, most = ladder.root;
  for (const glm::dvec3& p : ladder.points) least = glm::min(least, p), most = glm::max(most, p);
  const double margin = 0.15 * ladder.legLength;
  std::vector<std::vector<glm::dvec3>> rows;
  for (int j = 0; j <= lines; ++j) {
    std::vector<glm::dvec3>& row = rows.emplace_back();
    for (int i = 0; i <= lines; ++i) {
      const double x = glm::mix(least.x - margin, most.x + margin, static_cast<double>(i) / lines);
      const double z = glm::mix(least.z - margin, most.z + margin, static_cast<double>(j) / lines);
      row.emplace_back(x, field.at(static_cast<float>(x), static_cast<float>(z)), z);
    }
  }
  return rows;
}

}  // namespace

Ladder measureLadder(Device& device, const Heightfield& ground, const Settings& settings, Course& course) {
  Walk walk(device, ground, crossing(Controller::adaptive, settings.gaitAgents, 1, settings.seed),
            settings.dt);
  walk.ticks(settings.settleTicks);
  const crowd::Kind& kind = implOf(walk.crowd()).kindOf(0);
  const Setting setting{validation::tuningOf(kind.parameters), validation::heightsOf(ground, kind.parameters),
                        validation::creatureOf(kind.rigRecords, kind.legs, kind.bones, kind.groups)};
  Ladder best;
  HerdState before = walk.crowd().download(0);
  for (uint32_t i = 0; i < settings.arcTicks; ++i) {
    course.at(static_cast<double>(i) / settings.arcTicks);
    walk.tick();
    HerdState after = walk.crowd().download(0);
    look(setting, walk.rig(), walk.crowd().tick(), before, after, best);
    before = std::move(after);
  }
  if (best.found) best.ground = groundAbout(ground, best);
  return best;
}

Table Ladder::table() const {
  Table table{{"candidate", "rung", "x", "y", "z", "fits", "score", "chosen"}};
  size_t i = 0;
  for (int rung = 1; rung <= 4 && i < points.size(); ++rung) {
    for (int j = -rung; j <= rung && i < points.size(); ++j, ++i) {
      const reference::Candidate& candidate = result.candidates[i];
      table.rows.push_back({fmt::format("{}", i), fmt::format("{}", rung), fmt::format("{:.4f}", points[i].x),
                            fmt::format("{:.4f}", points[i].y), fmt::format("{:.4f}", points[i].z),
                            candidate.fits ? "1" : "0", fmt::format("{:.5f}", candidate.score),
                            static_cast<int>(i) == result.chosen ? "1" : "0"});
    }
  }
  return table;
}

}  // namespace skitter::experiments
