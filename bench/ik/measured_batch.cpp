#include "bench/ik/measured_batch.h"

#include <algorithm>
#include <cmath>

#include "bench/ik/machine.h"
#include "validation/convert_ik.h"

namespace skitter::bench {
namespace {

constexpr double kLeastSeconds = 0.02;  // a repetition solves again and again for that long
constexpr double kLongSeconds = 2;      // what takes longer is not repeated

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

MeasuredBatch measureBatch(Device& device, const baseline::Chain& chain,
                           const std::vector<glm::vec3>& targets, const ik::Options& options,
                           int repetitions) {
  ik::Batch batch(device, deviceChain(chain), uint32_t(targets.size()), options);
  batch.setTargets(targets);
  const auto solve = [&](int times) {
    return base::timed([&] {
      for (int i = 0; i < times; ++i) batch.solve();
    });
  };
  const double first = solve(1).wall;
  MeasuredBatch measured;
  measured.quality.add(validation::judgeOf(deviceChain(chain)), targets, options.tolerance,
                       {batch.downloadJoints(), batch.downloadReports()});
  const int times = int(std::clamp(std::ceil(kLeastSeconds / std::max(first, 1e-6)), 1.0, 1000.0));
  if (first > kLongSeconds) repetitions = 1;
  std::vector<double> seconds, wall;
  for (int i = 0; i < repetitions; ++i) {
    const base::Seconds spent = solve(times);
    seconds.push_back((isCpu(device.report()) ? spent.cpu : spent.wall) / times);
    wall.push_back(spent.wall / times);
  }
  const auto [least, most] = std::minmax_element(seconds.begin(), seconds.end());
  measured.leastSeconds = *least;
  measured.mostSeconds = *most;
  measured.seconds = median(seconds);
  measured.wallSeconds = median(wall);
  return measured;
}

}  // namespace skitter::bench
