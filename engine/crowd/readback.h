#pragma once

#include <cstdint>
#include <span>

#include "crowd/herd.h"

namespace skitter::crowd {

// Of what Crowd::download gives, those records alone and how many agents there are. Waits for the device.
HerdState downloadRecords(const Crowd::Impl& crowd, uint32_t herd, std::span<const Record> records,
                          const AgentSample& sample = {});

}  // namespace skitter::crowd
