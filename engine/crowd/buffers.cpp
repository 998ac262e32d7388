#include "skitter/buffers.h"

#include "crowd/page.h"
#include "crowd/record.h"
#include "skitter/crowd.h"

namespace skitter {

std::vector<RecordBuffer> Crowd::buffers(uint32_t herd, Record record) const {
  const crowd::Kind& kind = impl_->kindOf(herd);
  std::vector<RecordBuffer> buffers;
  const crowd::Per per = crowd::infoOf(record).per;
  if (per == crowd::Per::watched || !crowd::keeps(kind, impl_->options, record)) return buffers;
  const int stride = crowd::strideOf(record, kind.legs, kind.bones, kind.clips.joints);
  const uint32_t legs = per == crowd::Per::leg ? static_cast<uint32_t>(kind.legs) : 0;
  for (const crowd::Part& part : crowd::partsOf(*impl_, herd)) {
    // Where the first record is, and the end of the last.
    uint64_t begin = part.first, end = part.first + part.agents;
    if (legs > 0) {
      begin = begin / shared::BLOCK * shared::BLOCK * legs;
      end = uint64_t{crowd::wholeBlocks(part.first + part.agents)} * legs;
    }
    const uint64_t bytes = 16 * static_cast<uint64_t>(stride);
    buffers.push_back({.buffer = part.page->of(record).handle(),
                       .offset = begin * bytes,
                       .bytes = (end - begin) * bytes,
                       .firstAgent = part.firstAgent,
                       .agents = part.agents,
                       .first = part.first,
                       .stride = static_cast<uint32_t>(stride),
                       .legs = legs});
  }
  return buffers;
}

}  // namespace skitter
