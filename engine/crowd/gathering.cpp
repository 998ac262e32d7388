#include "crowd/gathering.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

#include "crowd/record.h"

namespace skitter::crowd {
namespace {

// Bytes of those that the sample has.
uint64_t bytesOf(const Crowd::Impl& crowd, const Part& part, Record record, const AgentSample& sample) {
  if (!part.page->of(record) || !keeps(*part.kind, crowd.options, record)) return 0;
  const int perAgent = infoOf(record).per == Per::leg ? part.kind->legs : 1;
  return sampleOf(part.firstAgent, part.agents, sample).count * static_cast<uint64_t>(perAgent) *
         bytesOfRecord(*part.kind, record);
}

}  // namespace

void Gathering::add(const Crowd::Impl& crowd, std::span<const Part> parts, Record record,
                    const AgentSample& sample, std::vector<float>& records) {
  std::vector<uint64_t> bytes;
  for (const Part& part : parts) bytes.push_back(bytesOf(crowd, part, record, sample));
  records.resize(std::accumulate(bytes.begin(), bytes.end(), uint64_t{0}) / sizeof(float));
  std::span<std::byte> rest = std::as_writable_bytes(std::span(records));
  for (size_t p = 0; p < parts.size(); ++p) {
    if (bytes[p] == 0) continue;
    add(parts[p], record, sample, rest.first(bytes[p]));
    rest = rest.subspan(bytes[p]);
  }
}

void Gathering::add(const Part& part, Record record, const AgentSample& sample,
                    std::span<std::byte> records) {
  const gpu::Buffer& buffer = part.page->of(record);
  const uint64_t each = bytesOfRecord(*part.kind, record);
  const int legs = infoOf(record).per == Per::leg ? part.kind->legs : 0;  // 0: there is one record per agent
  const RunSample here = sampleOf(part.firstAgent, part.agents, sample);
  const uint32_t first = part.first + here.first;
  if (legs == 0 && sample.stride == 1) {
    downloads_.add(buffer, records, first * each);
    return;
  }
  std::vector<uint64_t> places;
  places.reserve(records.size() / each);
  for (uint32_t i = 0; i < here.count; ++i) {
    const auto agent = static_cast<int>(first + i * sample.stride);
    for (int leg = 0; leg < std::max(1, legs); ++leg)
      places.push_back(each * static_cast<uint64_t>(legs > 0 ? shared::legRecord(agent, leg, legs) : agent));
  }
  if (sample.stride > 1) {
    downloads_.addPieces(buffer, records, places, each);
    return;
  }
  const auto perAgent = static_cast<uint64_t>(legs);
  const uint64_t begin = first / shared::BLOCK * shared::BLOCK * perAgent * each;
  const uint64_t end = wholeBlocks(first + here.count) * perAgent * each;
  for (uint64_t& place : places) place -= begin;
  Blocks& blocks =
      blocks_.emplace_back(std::vector<std::byte>(end - begin), std::move(places), each, records);
  downloads_.add(buffer, blocks.bytes, begin);
}

void Gathering::finish() {
  downloads_.run();
  for (const Blocks& blocks : blocks_)
    for (size_t i = 0; i < blocks.places.size(); ++i)
      std::memcpy(blocks.records.data() + i * blocks.each, blocks.bytes.data() + blocks.places[i],
                  blocks.each);
  blocks_.clear();
}

}  // namespace skitter::crowd
