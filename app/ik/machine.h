#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/clock.h"
#include "skitter/ik.h"

namespace skitter::app {

// What came of one solve of a lot of chains, and what that alone took.
struct IkLot {
  std::vector<glm::vec3> joints;     // one more than bones a chain, base first
  std::vector<glm::quat> rotations;  // one a bone, where asked for
  std::vector<ik::Report> reports;   // one a chain
  base::Seconds spent;
};

// Solves lots of equal chains, always as many.
class IkMachine {
 public:
  virtual ~IkMachine() = default;
  virtual std::string name() const = 0;
  virtual std::string driver() const { return {}; }  // of a device
  // Does once what only the first solve has to do; leaves every chain at rest.
  virtual void warmUp(std::span<const glm::vec3> targets) = 0;
  virtual IkLot solve(std::span<const glm::vec3> targets) = 0;
};

std::unique_ptr<IkMachine> makeDeviceMachine(const std::optional<std::string>& device, const ik::Chain& chain,
                                             uint32_t chains, const ik::Options& options);

// The reference in double precision, on all cores. It is made to be right and not to be fast.
std::unique_ptr<IkMachine> makeReferenceMachine(const ik::Chain& chain, uint32_t chains,
                                                const ik::Options& options);

}  // namespace skitter::app
