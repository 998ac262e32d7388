#pragma once

#include "gpu/context.h"

namespace skitter::bench {

// What a device can do at most, measured, so that a stage can be told how near it comes.
struct Peaks {
  double bytesPerSecond = 0;  // read and written, by copying what no cache holds: the better of a transfer
                              // and of a kernel that loads and stores as the stages do
  double operationsPerSecond = 0;  // single-precision multiplications and additions in independent chains
};

// Takes about a second and 512 MiB, less where the device has less. The best of several, by the wall clock
// or, of a software device, by CPU time with all threads at work.
Peaks measurePeaks(const gpu::Context&);

}  // namespace skitter::bench
