#include "crowd/herd.h"

#include <fmt/format.h>

#include <algorithm>

#include "skitter/error.h"

namespace skitter {
namespace crowd {

const Regait& Kind::regaitOf(const LegPattern& pattern) {
  const auto known = regaits.find(pattern);
  if (known != regaits.end()) return known->second;
  return regaits.emplace(pattern, regaitFor(rig, tuning, pattern)).first->second;
}

Load Kind::carriedBy(uint32_t agent) const {
  const auto load = loads.find(agent);
  return load == loads.end() ? Load{} : load->second;
}

void Kind::setLoad(uint32_t agent, const Load& load) {
  if (load.mass == 0)
    loads.erase(agent);
  else
    loads[agent] = load;
}

std::vector<float> Kind::hurtRecordOf(uint32_t agent) {
  const auto hurt = damages.find(agent);
  const Damage damage = hurt == damages.end() ? Damage{} : hurt->second;
  const LegPattern pattern = damage.pattern();
  return hurtRecord(damage, loaded(regaitOf(pattern), carriedBy(agent), rig, tuning, pattern));
}

const SizeRun& Herd::runOf(uint32_t agent) const {
  return *(std::ranges::upper_bound(runs, agent, {}, &SizeRun::firstOfHerd) - 1);
}

uint32_t HerdRun::agentCount() const {
  uint32_t count = 0;
  for (uint32_t agent = run->firstOfHerd; agent < run->firstOfHerd + run->agents; ++agent)
    count += herd->presence.has(agent);
  return count;
}

std::vector<HerdRun> allRuns(const Crowd::Impl& crowd) {
  std::vector<HerdRun> all;
  for (uint32_t h = 0; h < crowd.herds.size(); ++h) {
    if (crowd.herds[h].isGone()) continue;
    for (const SizeRun& run : crowd.herds[h].runs) all.push_back({h, &crowd.herds[h], &run});
  }
  return all;
}

std::vector<HerdRun> runsOf(const Crowd::Impl& crowd, uint32_t kind) {
  std::vector<HerdRun> runs;
  for (uint32_t h = 0; h < crowd.herds.size(); ++h) {
    const Herd& herd = crowd.herds[h];
    const auto run = std::ranges::find(herd.runs, kind, &SizeRun::kind);
    if (!herd.isGone() && run != herd.runs.end()) runs.push_back({h, &herd, &*run});
  }
  return runs;
}

}  // namespace crowd

const crowd::Herd& Crowd::Impl::herdAt(uint32_t herd) const {
  if (herd < herds.size()) return herds[herd];
  throw inputError(fmt::format("herd {}: expected one of the crowd's {} herds", herd, herds.size()));
}

const crowd::Herd& Crowd::Impl::presentHerdAt(uint32_t number) const {
  const crowd::Herd& herd = herdAt(number);
  if (!herd.isGone()) return herd;
  throw inputError(fmt::format("herd {}: was removed, expected one that is there", number));
}

void Crowd::Impl::expectHerd(const char* what, HerdId id) const {
  if (herdAt(id.index).generation != id.generation)
    throw inputError(fmt::format("{}: herd {} was removed, expected it to be there for as long as it is read",
                                 what, id.index));
}

const crowd::Kind& Crowd::Impl::kindOf(uint32_t herd, uint32_t agent) const {
  const crowd::Herd& of = herdAt(herd);
  if (agent < of.agents) return kinds[of.runOf(agent).kind];
  throw inputError(fmt::format("herd {}, agent {}: expected one of its {} places", herd, agent, of.agents));
}

}  // namespace skitter
