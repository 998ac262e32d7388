#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/common/manifest.h"
#include "app/run/footfall_log.h"
#include "app/run/pictures.h"
#include "app/run/run_options.h"
#include "app/run/trace.h"

namespace skitter::app {

// The files that a run writes, of which some grow while it goes on. None has its name before finish.
class RunOutputs {
 public:
  explicit RunOutputs(const RunOptions& options) : options_(options) {}

  // So much will be written. Throws Error(input) where so much was probably not meant, or has no room.
  void expect(Files& files, const OutTarget& target, const Crowd& crowd, const Heightfield& terrain,
              std::optional<uint64_t> ticks) const;
  void open(const OutTarget& target, const Crowd& crowd, const Manifest& manifest);

  void append(const Crowd& crowd);
  Pictures* pictures() { return pictures_ ? &*pictures_ : nullptr; }
  // The option that asks for a file of the whole run, so that it cannot begin anew; else empty.
  std::string unbroken() const { return trace_ ? "--trace" : (footfalls_ ? "--footfalls" : ""); }

  // Gives the files their names; returns what was written, for people. A video comes last, because it can
  // fail.
  std::vector<std::string> finish(const Crowd& crowd, const Heightfield& terrain, uint64_t ticks,
                                  const nlohmann::ordered_json& json, const Manifest& manifest);

 private:
  const RunOptions& options_;
  std::optional<Trace> trace_;
  std::optional<FootfallLog> footfalls_;
  std::optional<Pictures> pictures_;
};

}  // namespace skitter::app
