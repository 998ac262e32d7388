#include "laws/tally.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace skitter::laws {
namespace {

// Whether the agent is a new one.
bool mark(std::vector<bool>& has, uint32_t agent) {
  if (has.size() <= agent) has.resize(size_t{agent} + 1);
  const bool isNew = !has[agent];
  has[agent] = true;
  return isNew;
}

// One sample alone is not a percentile.
bool exceeds(uint64_t beyond, uint64_t samples, double share) {
  return static_cast<double>(beyond) > std::ceil(share * static_cast<double>(samples));
}

// The value that a share of all goes beyond: of the least or of the greatest ones.
double valueOf(std::vector<float> values, double share, bool ofLeast) {
  if (values.empty()) return 0;
  const auto skipped = static_cast<size_t>(std::ceil(share * static_cast<double>(values.size())));
  const size_t last = values.size() - 1, rank = std::min(skipped, last);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(ofLeast ? rank : last - rank);
  std::nth_element(values.begin(), at, values.end());
  return double{*at};
}

}  // namespace

Tally::Tally(uint32_t herd, std::string rig, std::string controller)
    : herd_(herd), rig_(std::move(rig)), controller_(std::move(controller)) {}

void Tally::note(Side& side, uint32_t agent, uint64_t tick, double value, bool isWorse) {
  if (side.beyond == 0 || tick < side.firstTick) side.firstTick = tick;
  if (side.beyond == 0 || isWorse) side.worst = value;
  ++side.beyond;
  side.agents += mark(side.hasAgent, agent);
}

// A value that is no number breaks every bound.
void Tally::add(Law law, uint32_t agent, uint64_t tick, double value) {
  Row& row = rows_[static_cast<size_t>(law)];
  const Bound bound = boundOf(law, controller_);
  ++row.samples;
  row.judged += mark(row.hasAgent, agent);
  keep(row, value);
  if (value < bound.least)
    note(row.under, agent, tick, value, value < row.under.worst);
  else if (!(value <= bound.most))
    note(row.over, agent, tick, value, !(value <= row.over.worst));
}

void Tally::keep(Row& row, double value) {
  if (row.samples % row.every != 0) return;
  if (row.values.size() == mostKept) {
    for (size_t i = 0; 2 * i < mostKept; ++i) row.values[i] = row.values[2 * i];
    row.values.resize(mostKept / 2);
    row.every *= 2;
  }
  row.values.push_back(static_cast<float>(value));
}

Figure Tally::figureOf(Law law) const {
  const Row& row = rows_[static_cast<size_t>(law)];
  const LawInfo& info = infoOf(law);
  const Bound bound = boundOf(law, controller_);
  const bool isUnder = row.under.beyond > row.over.beyond;
  const bool isOfLeast = isUnder || (row.over.beyond == 0 && bound.most == unbounded);
  const Side& side = isUnder ? row.under : row.over;
  Figure figure{.law = law,
                .herd = herd_,
                .bound = bound,
                .samples = row.samples,
                .beyond = side.beyond,
                .agents = side.agents,
                .judged = row.judged,
                .firstTick = side.firstTick,
                .worst = side.beyond > 0 ? side.worst : valueOf(row.values, 0, isOfLeast),
                .value = valueOf(row.values, info.share, isOfLeast),
                .isKept = !exceeds(side.beyond, row.samples, info.share)};
  if (!figure.isKept)
    figure.text = fmt::format(
        "herd {} ({}): {} of {} agents {}, the first at tick {}; {} {:.3g} {}, expected at {} {:g}", herd_,
        rig_, figure.agents, figure.judged, isUnder ? info.under : info.over, figure.firstTick, info.name,
        figure.worst, info.unit, isUnder ? "least" : "most", isUnder ? bound.least : bound.most);
  return figure;
}

std::vector<Figure> Tally::figures() const {
  std::vector<Figure> figures;
  for (const LawInfo& info : lawTable)
    if (rows_[static_cast<size_t>(info.law)].samples > 0) figures.push_back(figureOf(info.law));
  return figures;
}

std::vector<Figure> Tally::broken() const {
  std::vector<Figure> broken = figures();
  std::erase_if(broken, [](const Figure& figure) { return figure.isKept; });
  return broken;
}

}  // namespace skitter::laws
