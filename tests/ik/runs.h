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
// The second of two solves, toward targets that moved little since the first, if at all.
validation::IkRun pacedRun(Device& device, const std::string& name, const ik::Chain& chain, size_t chains,
                           ik::Options options, uint64_t seed);

// Solves from rest toward the targets.
validation::IkRun runToward(Device& device, const std::string& name, const ik::Chain& chain,
                            const ik::Options& options, const std::vector<glm::vec3>& targets);

// Compares a run.
void expectParity(const validation::IkRun& run, double tieShare);

}  // namespace skitter::test
