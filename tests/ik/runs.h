#pragma once

#include <functional>

#include "ik/chains.h"
#include "validation/check_ik_batch.h"

namespace skitter {
class Device;
}

// Batches run for the comparison with the reference.
namespace skitter::test {

// `chains` solves of `chain` from random legal poses, if options.start is previous, toward random targets:
// most where a legal pose has its tip, the others anywhere up to 1.2 of the reach. With options.bases, about
// random bases.
validation::IkRun randomRun(Device& device, const std::string& name, const ik::Chain& chain, size_t chains,
                            ik::Options options, uint64_t seed);

// As randomRun(), compared.
void expectParity(const validation::IkRun& run, double tieShare);

}  // namespace skitter::test
