#include "crowd/roster.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "crowd/spawn.h"
#include "skitter/error.h"

namespace skitter::crowd {

Roster::Roster(const Scene& scene, const Kinds& kinds) : herds_(scene.herds.size()) {
  for (size_t h = 0; h < scene.herds.size(); ++h) herds_[h].herd = &scene.herds[h];
  for (const SizedHerd& sized : kinds.herds) herds_[sized.herd].kinds.push_back(sized.kind);
  nextKind_ = static_cast<uint32_t>(kinds.firstHerds.size());
}

Roster::Roster(const Crowd::Impl& crowd)
    : herds_(crowd.herds.size()), nextKind_(static_cast<uint32_t>(crowd.kinds.size())) {
  for (size_t h = 0; h < herds_.size(); ++h) {
    if (crowd.herds[h].isGone()) continue;
    herds_[h].herd = &crowd.herds[h].from;
    for (const SizeRun& run : crowd.herds[h].runs) herds_[h].kinds.push_back(run.kind);
  }
}

const skitter::Herd* Roster::find(uint32_t number) const {
  return number < herds_.size() ? herds_[number].herd : nullptr;
}

uint64_t Roster::places() const {
  uint64_t count = 0;
  for (const Entry& each : herds_)
    if (each.herd != nullptr) count += uint64_t{each.herd->agents} + each.herd->reserve;
  return count;
}

uint32_t Roster::add(const skitter::Herd& herd, const std::string& name) {
  const uint64_t held = places();
  size_t live = 0;
  std::set<uint32_t> kinds;
  for (const Entry& each : herds_) {
    if (each.herd == nullptr) continue;
    ++live;
    kinds.insert(each.kinds.begin(), each.kinds.end());
  }
  const uint64_t asked = uint64_t{herd.agents} + herd.reserve;
  if (held + asked > Scene::maxAgents)
    throw inputError(fmt::format("{}: {} agents and reserve beside {} places, expected at most {} in all",
                                 name, asked, held, Scene::maxAgents));
  if (live >= Scene::maxHerds)
    throw inputError(
        fmt::format("{}: one herd beside {}, expected at most {} in all", name, live, Scene::maxHerds));
  const size_t own = sizesOf(herd).size();
  if (kinds.size() + own > mostKinds)
    throw inputError(fmt::format("{}: {} kinds of its own, one a size, beside {}, expected at most {} in all",
                                 name, own, kinds.size(), mostKinds));

  Entry made{.herd = &herd};
  while (made.kinds.size() < own) made.kinds.push_back(nextKind_++);
  const auto free = std::ranges::find_if(herds_, [](const Entry& each) { return each.herd == nullptr; });
  const auto number = static_cast<uint32_t>(free - herds_.begin());
  if (free == herds_.end())
    herds_.push_back(std::move(made));
  else
    *free = std::move(made);
  return number;
}

bool Roster::isShared(uint32_t kind) const {
  return std::ranges::count_if(herds_, [&](const Entry& each) {
           return std::ranges::find(each.kinds, kind) != each.kinds.end();
         }) > 1;
}

void Roster::remove(uint32_t number, const std::string& name) {
  Entry& entry = herds_.at(number);
  if (entry.herd->reserve == 0 &&
      std::ranges::any_of(entry.kinds, [&](uint32_t kind) { return isShared(kind); }))
    throw inputError(fmt::format(
        "{}: shares pages with other herds, expected a herd of another kind or one with a reserve", name));
  entry = {};
}

}  // namespace skitter::crowd
