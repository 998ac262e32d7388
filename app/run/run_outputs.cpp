#include "app/run/run_outputs.h"

#include <fmt/format.h>

#include "skitter/error.h"

namespace skitter::app {
namespace {

constexpr double mostTraceBytes = 4.0 * (1ull << 30);

// The size of a trace. Throws Error(input) where so much was probably not meant.
double traceBytes(const RunOptions& options, const Crowd& crowd, const Heightfield& terrain, uint64_t ticks) {
  const double bytes = Trace::bytes(crowd, terrain, ticks);
  if (bytes > mostTraceBytes && !options.large)
    throw inputError(fmt::format("--trace {}: {} ticks would take {:.1f} GiB, more than 4 GiB need --large",
                                 options.trace, ticks, bytes / (1ull << 30)));
  return bytes;
}

}  // namespace

void RunOutputs::expect(Files& files, const OutTarget& target, const Crowd& crowd, const Heightfield& terrain,
                        std::optional<uint64_t> ticks) const {
  const uint64_t done = crowd.tick();
  files.expect("--out", pictureBytes(target, options_.size.width, options_.size.height,
                                     options_.framesWithoutWindow() - done / options_.ticksPerFrame));
  if (!options_.trace.empty())
    files.expect("--trace", traceBytes(options_, crowd, terrain, ticks.value() - done));
  if (ticks) files.expect("--footfalls", footfallBytes(crowd, options_.scene.dt, *ticks - done));
  // An older state stays until a newer one is whole.
  files.expect("--save", static_cast<double>(crowd.stateBytes()) * (options_.saveEvery ? 2 : 1));
  files.check();
}

void RunOutputs::open(const OutTarget& target, const Crowd& crowd, const Manifest& manifest) {
  if (!options_.trace.empty()) trace_.emplace(options_.trace, crowd, static_cast<float>(options_.scene.dt));
  if (!options_.footfalls.empty()) footfalls_.emplace(options_.footfalls, manifest);
  if (target.kind != OutTarget::Kind::none)
    pictures_.emplace(target, options_.size.width, options_.size.height, options_.videoFps(),
                      1 / (options_.secondsAFrame() * options_.slow.value_or(1)));
}

void RunOutputs::append(const Crowd& crowd) {
  if (trace_) trace_->append(crowd);
  if (footfalls_) footfalls_->append(crowd);
}

std::vector<std::string> RunOutputs::finish(const Crowd& crowd, const Heightfield& terrain, uint64_t ticks,
                                            const nlohmann::ordered_json& json, const Manifest& manifest) {
  std::vector<std::string> files;
  if (trace_) {
    const size_t replaced = trace_->finish(crowd, terrain, manifest);
    files.push_back(fmt::format("{}: {} ticks of {} herds{}", options_.trace, ticks, crowd.herdCount(),
                                replaced > 0 ? ", in place of an earlier trace" : ""));
  }
  if (footfalls_) {
    footfalls_->finish();
    files.push_back(fmt::format("{}: {} footfalls", options_.footfalls, footfalls_->count()));
  }
  if (!options_.json.empty()) {
    writeJson(options_.json, json, manifest);
    files.push_back(options_.json);
  }
  if (!pictures_) return files;
  const std::vector<std::string> drawn = pictures_->finish();
  files.insert(files.begin(), drawn.begin(), drawn.end());
  return files;
}

}  // namespace skitter::app
