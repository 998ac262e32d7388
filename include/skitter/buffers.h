#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>

#include "skitter/records.h"

namespace skitter {

// A herd's records in one page, for shaders and copies of the caller's (skitter/records.h has the layouts,
// for C++, C and GLSL alike).
//
// Owned by the crowd, which keeps it as long as it has the herd: the handle stays the same, whatever is
// recorded. Usage is STORAGE_BUFFER, TRANSFER_SRC and TRANSFER_DST. Equal herds share pages, so other herds'
// records may lie before and after.
//
// Crowd::record() waits for vertex, fragment, compute and transfer work recorded before it, and makes the
// records visible to such work recorded after it. So the caller's reads need no barrier of their own.
struct RecordBuffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  // The bytes that hold the herd's records. Leg records come in blocks of BLOCK agents, so the first and the
  // last block may hold other agents' too.
  VkDeviceSize offset = 0, bytes = 0;
  uint32_t firstAgent = 0, agents = 0;  // of the herd, in this page
  uint32_t first = 0;                   // firstAgent's index in the page
  uint32_t stride = 0;                  // vec4 per record
  uint32_t legs = 0;                    // of an agent, for leg records; 0: the records are one per agent

  // The vec4 of the buffer with which a record begins; `agent` is of the herd and in this page.
  uint32_t recordAt(uint32_t agent, uint32_t leg = 0) const {
    const auto place = static_cast<int>(first + agent - firstAgent);
    const int record =
        legs == 0 ? place : shared::legRecord(place, static_cast<int>(leg), static_cast<int>(legs));
    return static_cast<uint32_t>(record) * stride;
  }
};

}  // namespace skitter
