#include "crowd/state_records.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "crowd/levels.h"
#include "crowd/page.h"
#include "crowd/record.h"
#include "crowd/watch.h"
#include "gpu/context.h"
#include "gpu/transfer.h"
#include "shared/levels.h"

namespace skitter::crowd {
namespace {

// How many of them a run of agents has.
uint64_t recordsOf(const Crowd::Impl& crowd, const Kind& kind, Record record, uint64_t agents) {
  switch (infoOf(record).per) {
    case Per::agent:
      break;
    case Per::leg:
      return agents * static_cast<uint64_t>(kind.legs);
    case Per::watched:
      return (agents + crowd.watchEvery - 1) / crowd.watchEvery;
  }
  return agents;
}

}  // namespace

uint64_t bytesOfRecords(const Crowd::Impl& crowd, const Kind& kind, Record record) {
  return recordsOf(crowd, kind, record, kind.agents) * bytesOfRecord(kind, record);
}

std::vector<StateChunk> recordChunks(const Crowd::Impl& crowd, const Kind& kind) {
  std::vector<StateChunk> chunks;
  for (const Record record : allRecords)
    if (keeps(kind, crowd.options, record))
      chunks.push_back({infoOf(record).name, bytesOfRecords(crowd, kind, record)});
  return chunks;
}

namespace {

// Copies each leg's record between a page, where agents are in blocks, and a chunk.
template <class Copy>
void eachLeg(const Page& page, int legs, uint64_t bytes, const Copy& copy) {
  uint64_t place = 0;
  for (int agent = 0; agent < static_cast<int>(page.agents); ++agent)
    for (int leg = 0; leg < legs; ++leg, place += bytes)
      copy(place, bytes * static_cast<uint64_t>(shared::legRecord(agent, leg, legs)));
}

// Calls each(bytes in the page, bytes in the chunk) for whom measure looks at in this tick. There is one of
// every `watchEvery` agents of the kind, and so they have their place in the chunk.
template <class Each>
void eachWatched(const Crowd::Impl& crowd, const Page& page, uint64_t bytes, const Each& each) {
  const Watch watch = watchAt(crowd.tick, crowd.watchEvery, page);
  for (uint64_t slot = 0; slot < watch.count; ++slot)
    each(slot * bytes, (page.firstAgent + watch.first + slot * crowd.watchEvery) / crowd.watchEvery * bytes);
}

uint64_t bytesInPage(const Page& page, const Kind& kind, Record record, uint64_t bytes) {
  return infoOf(record).per == Per::leg ? wholeBlocks(page.agents) * static_cast<uint64_t>(kind.legs) * bytes
                                        : page.agents * bytes;
}

}  // namespace

void writeRecords(const Crowd::Impl& crowd, const Kind& kind, Record record, StateWriter& writer) {
  const uint64_t bytes = bytesOfRecord(kind, record);
  std::vector<std::byte> there, here;
  if (infoOf(record).per == Per::watched) {
    here.resize(bytesOfRecords(crowd, kind, record));
    for (const Page& page : kind.pages) {
      there.resize(page.of(record).size());
      gpu::downloadBytes(*crowd.context, page.of(record), there);
      eachWatched(crowd, page, bytes,
                  [&](uint64_t in, uint64_t to) { std::memcpy(here.data() + to, there.data() + in, bytes); });
    }
    return writer.write(here);
  }
  for (const Page& page : kind.pages) {
    there.resize(bytesInPage(page, kind, record, bytes));
    gpu::downloadBytes(*crowd.context, page.of(record), there);
    if (infoOf(record).per == Per::agent) {
      writer.write(there);
      continue;
    }
    here.resize(page.agents * static_cast<uint64_t>(kind.legs) * bytes);
    eachLeg(page, kind.legs, bytes,
            [&](uint64_t to, uint64_t from) { std::memcpy(here.data() + to, there.data() + from, bytes); });
    writer.write(here);
  }
}

void readRecords(const Crowd::Impl& crowd, const Kind& kind, Record record, StateReader& reader) {
  const uint64_t bytes = bytesOfRecord(kind, record);
  std::vector<std::byte> there, here;
  if (infoOf(record).per == Per::watched) {
    here.resize(bytesOfRecords(crowd, kind, record));
    reader.read(here);
    for (const Page& page : kind.pages) {
      there.assign(page.of(record).size(), std::byte{0});
      eachWatched(crowd, page, bytes, [&](uint64_t in, uint64_t from) {
        std::memcpy(there.data() + in, here.data() + from, bytes);
      });
      gpu::uploadBytes(*crowd.context, page.of(record), there);
    }
    return;
  }
  for (const Page& page : kind.pages) {
    here.resize(recordsOf(crowd, kind, record, page.agents) * bytes);
    reader.read(here);
    if (infoOf(record).per == Per::agent) {
      gpu::uploadBytes(*crowd.context, page.of(record), here);
      continue;
    }
    there.assign(bytesInPage(page, kind, record, bytes), std::byte{0});
    eachLeg(page, kind.legs, bytes,
            [&](uint64_t from, uint64_t to) { std::memcpy(there.data() + to, here.data() + from, bytes); });
    gpu::uploadBytes(*crowd.context, page.of(record), there);
  }
}

std::vector<RawFootfall> footfallsOf(const Crowd::Impl& crowd, const Kind& kind) {
  std::vector<RawFootfall> all;
  if (crowd.options.footfalls == 0) return all;
  for (const Page& page : kind.pages) {
    const auto counters = gpu::download<uint32_t>(*crowd.context, page.counters);
    std::vector<RawFootfall> events(std::min(counters[shared::COUNTER_FOOTFALLS], page.footfallRoom));
    gpu::downloadBytes(*crowd.context, page.footfall, std::as_writable_bytes(std::span(events)));
    all.insert(all.end(), events.begin(), events.end());
  }
  // The device appends them in any order.
  std::ranges::sort(all, {}, [](const RawFootfall& event) { return std::pair(event.agent(), event.leg()); });
  return all;
}

void giveFootfalls(const Crowd::Impl& crowd, const Kind& kind, const std::vector<RawFootfall>& all) {
  if (crowd.options.footfalls == 0) return;
  for (const Page& page : kind.pages) {
    std::vector<RawFootfall> events;
    for (const RawFootfall& event : all)
      if (event.agent() >= static_cast<float>(page.firstAgent) &&
          event.agent() < static_cast<float>(page.firstAgent + page.agents))
        events.push_back(event);
    const std::array count = {static_cast<uint32_t>(std::min<uint64_t>(events.size(), page.footfallRoom))};
    events.resize(count[0]);
    gpu::uploadBytes(*crowd.context, page.footfall, std::as_bytes(std::span(events)));
    gpu::uploadBytes(*crowd.context, page.counters, std::as_bytes(std::span(count)),
                     bytesOfCounters(shared::COUNTER_FOOTFALLS));
  }
}

StateRates ratesOf(const Crowd::Impl& crowd) {
  const RateLevels& levels = *crowd.rates;
  StateRates rates;
  rates.distances = levels.levels.distances;
  rates.most = levels.levels.most;
  if (levels.camera) rates.camera.assign(levels.camera->begin(), levels.camera->end());
  rates.words = gpu::download<uint32_t>(*crowd.context, levels.words);
  rates.words.erase(rates.words.begin(), rates.words.begin() + shared::LEVELS_TICKS);
  return rates;
}

void giveRates(const StateRates& rates, Crowd::Impl& crowd) {
  RateLevels& levels = *crowd.rates;
  if (!rates.camera.empty()) std::ranges::copy(rates.camera, levels.camera.emplace().begin());
  gpu::uploadBytes(*crowd.context, levels.words, std::as_bytes(std::span(rates.words)),
                   shared::LEVELS_TICKS * sizeof(uint32_t));
}

void addCounts(const Crowd::Impl& crowd, uint32_t herd, StateHerd& sums) {
  for (const Part& part : partsOf(crowd, herd)) {
    const CounterRow row = rowOf(*crowd.context, part);
    for (size_t i = 0; i < row.size(); ++i) sums.counts[i] += row[i];
    if (!part.page->histogram) continue;
    decltype(sums.reachErrors) here;
    gpu::downloadBytes(*crowd.context, part.page->histogram, std::as_writable_bytes(std::span(here)),
                       part.row * sizeof here);
    for (size_t i = 0; i < here.size(); ++i) sums.reachErrors[i] += here[i];
  }
}

void giveCounts(const Crowd::Impl& crowd, uint32_t herd, const StateHerd& counts) {
  const std::vector<Part> parts = partsOf(crowd, herd);
  if (parts.empty()) return;
  const Part& part = parts.front();
  gpu::uploadBytes(*crowd.context, part.page->counters, std::as_bytes(std::span(counts.counts)),
                   bytesOfCounters(shared::counterRow(static_cast<int>(part.row))));
  if (part.page->histogram)
    gpu::uploadBytes(*crowd.context, part.page->histogram, std::as_bytes(std::span(counts.reachErrors)),
                     part.row * sizeof counts.reachErrors);
}

}  // namespace skitter::crowd
