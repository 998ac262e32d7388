#include "evolve/map_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "assets/files/json.h"
#include "crowd/rig_records.h"
#include "skitter/error.h"

namespace skitter::evolve {
namespace {

constexpr int mapVersion = 1;

// Of all that trials know of the rig: FNV-1a.
uint64_t fingerprintOfRig(const Rig& rig) {
  uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&](float value) { hash = (hash ^ std::bit_cast<uint32_t>(value)) * 0x100000001b3u; };
  for (const float value : crowd::rigRecords(rig)) add(value);
  for (const float value : {rig.legLength, rig.bodyHeight, rig.bodyRadius}) add(value);
  return hash;
}

class MapReader {
 public:
  MapReader(const std::string& name, const nlohmann::json& json) : name_(name), json_(json) {
    if (!json.is_object()) fail("the file", json, "an object");
  }

  uint64_t whole(const char* key, uint64_t least, uint64_t most) const {
    return whole(member(key), key, least, most);
  }
  uint64_t whole(const nlohmann::json& json, const std::string& path, uint64_t least, uint64_t most) const {
    if (!json.is_number_unsigned() || json.get<uint64_t>() < least || json.get<uint64_t>() > most)
      fail(path, json, fmt::format("a whole number from {} to {}", least, most));
    return json.get<uint64_t>();
  }
  float number(const nlohmann::json& json, const std::string& path, double least, double most) const {
    const double value = json.is_number() ? json.get<double>() : NAN;
    if (!(value >= least && value <= most)) fail(path, json, fmt::format("{:g} to {:g}", least, most));
    return static_cast<float>(value);
  }
  const nlohmann::json& list(const nlohmann::json& json, const std::string& path, size_t count) const {
    if (!json.is_array() || json.size() != count) fail(path, json, fmt::format("an array of {}", count));
    return json;
  }
  const nlohmann::json& member(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) throw inputError(fmt::format("{}: {} is missing", name_, key));
    return *found;
  }
  [[noreturn]] void fail(const std::string& path, const nlohmann::json& found,
                         const std::string& expected) const {
    throw inputError(fmt::format("{}: {} is {}, expected {}", name_, path, describeJson(found), expected));
  }

 private:
  const std::string& name_;
  const nlohmann::json& json_;
};

// [pattern, cell, candidate, fitness, [genes], [shares]]
void readElite(const MapReader& reader, const nlohmann::json& json, const std::string& path, size_t genes,
               size_t legs, const std::vector<uint32_t>& patterns, SearchState& state) {
  reader.list(json, path, 6);
  const auto at = [&](size_t i) { return fmt::format("{}[{}]", path, i); };
  const auto idle = static_cast<uint32_t>(reader.whole(json[0], at(0), 0, UINT32_MAX));
  const auto pattern = std::ranges::find(patterns, idle);
  if (pattern == patterns.end()) reader.fail(at(0), json[0], "a pattern of the rig");
  const auto cell = static_cast<uint32_t>(reader.whole(json[1], at(1), 0, Archive::cellsOfPattern - 1));
  Elite elite;
  elite.candidate = reader.whole(json[2], at(2), 0, state.evaluations - 1);
  elite.fitness = reader.number(json[3], at(3), 0, 1);
  for (const nlohmann::json& gene : reader.list(json[4], at(4), genes))
    elite.genes.push_back(static_cast<uint16_t>(reader.whole(gene, at(4), 0, UINT16_MAX)));
  for (const nlohmann::json& share : reader.list(json[5], at(5), legs))
    elite.shares.push_back(reader.number(share, at(5), 0, 1));
  if (!state.archive.offer(static_cast<size_t>(pattern - patterns.begin()), cell, elite))
    reader.fail(path, json, "an elite with a fitness above 0, in a cell of its own");
}

}  // namespace

std::string writeMap(const Rig& rig, const std::vector<uint32_t>& patterns, const SearchState& state) {
  std::string text = fmt::format(
      "{{\"version\": {}, \"rig\": {}, \"seed\": {}, \"batch\": {}, \"dt\": {}, \"evaluations\": {},\n"
      "\"elites\": [",
      mapVersion, fingerprintOfRig(rig), state.seed, state.batch, state.dt, state.evaluations);
  const char* separator = "\n";
  for (size_t p = 0; p < patterns.size(); ++p) {
    for (uint32_t cell = 0; cell < Archive::cellsOfPattern; ++cell) {
      const std::optional<Elite>& elite = state.archive.at(p, cell);
      if (!elite) continue;
      text += fmt::format("{}[{},{},{},{},[{}],[{}]]", separator, patterns[p], cell, elite->candidate,
                          elite->fitness, fmt::join(elite->genes, ","), fmt::join(elite->shares, ","));
      separator = ",\n";
    }
  }
  return text + "\n]}\n";
}

SearchState readMap(const std::string& text, const std::string& name, const Rig& rig,
                    const std::vector<uint32_t>& patterns, size_t genes) {
  const nlohmann::json json = parseJson(text, name);
  const MapReader reader(name, json);
  if (reader.member("version") != mapVersion)
    reader.fail("version", reader.member("version"), fmt::format("{}", mapVersion));
  const uint64_t own = fingerprintOfRig(rig);
  if (reader.member("rig") != own)
    reader.fail("rig", reader.member("rig"), fmt::format("{}, the fingerprint of this rig", own));
  SearchState state;
  state.seed = reader.whole("seed", 0, UINT64_MAX);
  state.batch = static_cast<uint32_t>(reader.whole("batch", 1, EvolutionOptions::maxBatch));
  state.dt = reader.number(reader.member("dt"), "dt", double{EvolutionOptions::minDt},
                           double{EvolutionOptions::maxDt});
  state.evaluations = reader.whole("evaluations", 0, UINT64_MAX);
  if (state.evaluations % state.batch != 0)
    reader.fail("evaluations", reader.member("evaluations"), fmt::format("whole batches of {}", state.batch));
  state.archive = Archive(patterns.size());
  const nlohmann::json& elites = reader.member("elites");
  if (!elites.is_array()) reader.fail("elites", elites, "an array");
  if (!elites.empty() && state.evaluations == 0) reader.fail("elites", elites, "none before the first batch");
  for (size_t i = 0; i < elites.size(); ++i)
    readElite(reader, elites[i], fmt::format("elites[{}]", i), genes, rig.legs.size(), patterns, state);
  return state;
}

}  // namespace skitter::evolve
