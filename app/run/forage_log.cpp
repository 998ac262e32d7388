#include "app/run/forage_log.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "crowd/herd.h"

namespace skitter::app {
namespace {

// The part of those who passed a branch that passed the first one, which a scene has for the shorter way.
nlohmann::ordered_json shareOfFirst(const std::vector<uint64_t>& passed) {
  const uint64_t sum = std::accumulate(passed.begin(), passed.end(), uint64_t{0});
  if (sum == 0) return nullptr;
  return static_cast<double>(passed.front()) / static_cast<double>(sum);
}

nlohmann::ordered_json jsonOf(const ForageFigures::Window& window) {
  return {{"until", window.until},
          {"brought", window.brought},
          {"empty", window.empty},
          {"passed", window.passed},
          {"shareOfFirst", shareOfFirst(window.passed)}};
}

bool isThere(const Crowd& crowd, uint32_t herd) {
  return herd < crowd.herdCount() && !implOf(crowd).herds[herd].isGone();
}

}  // namespace

nlohmann::ordered_json jsonOf(const std::vector<ForageFigures>& herds) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const ForageFigures& herd : herds) {
    nlohmann::ordered_json windows = nlohmann::ordered_json::array();
    for (const ForageFigures::Window& window : herd.windows) windows.push_back(jsonOf(window));
    all.push_back({{"herd", herd.herd},
                   {"brought", herd.done.brought},
                   {"trips", herd.done.brought + herd.done.empty},
                   {"taken", herd.done.taken},
                   {"passed", herd.done.passed},
                   {"shareOfFirst", shareOfFirst(herd.done.passed)},
                   {"windows", windows}});
  }
  return all;
}

ForageLog::ForageLog(const Crowd& crowd) {
  for (uint32_t h = 0; h < crowd.herdCount(); ++h)
    if (isThere(crowd, h) && implOf(crowd).herds[h].from.forage)
      herds_.push_back({.herd = h, .done = crowd.foraging(h), .windows = {}});
}

void ForageLog::append(const Crowd& crowd, double dt) {
  const auto windowOf = [&](uint64_t tick) {
    return std::floor(static_cast<double>(tick) * dt / windowSeconds);
  };
  if (!herds_.empty() && crowd.tick() > 0 && windowOf(crowd.tick()) > windowOf(crowd.tick() - 1))
    endWindow(crowd, static_cast<double>(crowd.tick()) * dt);
}

std::vector<ForageFigures> ForageLog::figures(const Crowd& crowd, double dt) {
  const double now = static_cast<double>(crowd.tick()) * dt;
  const auto hasEnded = [&](const ForageFigures& herd) {
    return !herd.windows.empty() && herd.windows.back().until >= now;
  };
  if (!std::ranges::all_of(herds_, hasEnded)) endWindow(crowd, now);
  return herds_;
}

void ForageLog::endWindow(const Crowd& crowd, double until) {
  for (ForageFigures& herd : herds_) {
    if (!isThere(crowd, herd.herd)) continue;
    const Foraging now = crowd.foraging(herd.herd);
    if (now.passed.size() != herd.done.passed.size()) continue;  // another herd has the number
    ForageFigures::Window window{
        .until = until, .brought = now.brought - herd.done.brought, .empty = now.empty - herd.done.empty};
    for (size_t b = 0; b < now.passed.size(); ++b)
      window.passed.push_back(now.passed[b] - herd.done.passed[b]);
    herd.windows.push_back(std::move(window));
    herd.done = now;
  }
}

}  // namespace skitter::app
