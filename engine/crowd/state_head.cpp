#include "crowd/state_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "assets/heights/heightfield_limits.h"
#include "crowd/record.h"
#include "crowd/state_file.h"
#include "shared/levels.h"
#include "skitter/error.h"

namespace skitter::crowd {
namespace {

using Json = nlohmann::json;

// A key that is missing where the list is empty, as in states of earlier versions.
template <class Value>
struct IfAny {
  std::vector<Value>& list;
};

// eachKey(object, visit) calls visit(key, member) for both directions. Bindings name all members, so that a
// new one does not compile until it is looked at here.
template <class Visit>
void eachKey(StateChunk& chunk, const Visit& visit) {
  auto& [name, bytes] = chunk;
  visit("name", name);
  visit("bytes", bytes);
}
template <class Visit>
void eachKey(StateChange& change, const Visit& visit) {
  auto& [agent, goal, speed, leaves, record, stands, hurt, load, push] = change;
  visit("agent", agent);
  visit("goal", goal);
  visit("speed", speed);
  visit("leaves", leaves);
  visit("record", record);
  visit("stands", stands);
  IfAny legs{hurt};
  visit("hurt", legs);
  IfAny loads{load};
  visit("load", loads);
  IfAny pushes{push};
  visit("push", pushes);
}
template <class Visit>
void eachKey(StateKind& kind, const Visit& visit) {
  auto& [rig, agents, firstAgents, changes, legs, bones, joints, hash, chunks] = kind;
  visit("rig", rig);
  visit("agents", agents);
  visit("firstAgents", firstAgents);
  visit("changes", changes);
  visit("legs", legs);
  visit("bones", bones);
  visit("joints", joints);
  visit("hash", hash);
  visit("chunks", chunks);
}
template <class Visit>
void eachKey(SizeRun& run, const Visit& visit) {
  auto& [kind, place, firstAgent, firstOfHerd, agents] = run;
  visit("kind", kind);
  visit("place", place);
  visit("firstAgent", firstAgent);
  visit("firstOfHerd", firstOfHerd);
  visit("agents", agents);
}
template <class Visit>
void eachKey(StateHerd& herd, const Visit& visit) {
  auto& [runs, generation, lastGeneration, since, counts, reachErrors] = herd;
  visit("runs", runs);
  visit("generation", generation);
  visit("lastGeneration", lastGeneration);
  visit("since", since);
  visit("counts", counts);
  visit("reachErrors", reachErrors);
}
template <class Visit>
void eachKey(StateComing& coming, const Visit& visit) {
  auto& [event, hashes] = coming;
  visit("event", event);
  visit("hashes", hashes);
}
template <class Visit>
void eachKey(StateThreat& threat, const Visit& visit) {
  auto& [kind, disc] = threat;
  visit("kind", kind);
  visit("disc", disc);
}
template <class Visit>
void eachKey(StateSeries& series, const Visit& visit) {
  auto& [kind, first, places, goal, disc, named, loop, leader, agent] = series;
  visit("kind", kind);
  visit("first", first);
  visit("places", places);
  visit("goal", goal);
  visit("disc", disc);
  visit("named", named);
  visit("loop", loop);
  visit("leader", leader);
  visit("agent", agent);
}
template <class Visit>
void eachKey(StateRates& rates, const Visit& visit) {
  auto& [distances, most, camera, words] = rates;
  visit("distances", distances);
  visit("most", most);
  visit("camera", camera);
  visit("words", words);
}
template <class Visit>
void eachKey(CrowdOptions& options, const Visit& visit) {
  auto& [pose, measure, watchEvery, feet, footfalls, sleep, crowding, fuse, timestamps, pageAgents, shaders,
         rigs, levels] = options;
  visit("pose", pose);
  visit("measure", measure);
  visit("watchEvery", watchEvery);
  visit("feet", feet);
  visit("footfalls", footfalls);
  visit("sleep", sleep);
  visit("fuse", fuse);
  // The counts of crowding are not saved. timestamps and pageAgents are the device's matter, and shaders
  // are experiments. A program that made rigs has them. Levels are in StateHead::rates.
}
template <class Visit>
void eachKey(Heightfield& terrain, const Visit& visit) {
  auto& [name, columns, rows, spacingX, spacingZ, heights, filledVoids] = terrain;
  visit("name", name);
  visit("columns", columns);
  visit("rows", rows);
  visit("spacingX", spacingX);
  visit("spacingZ", spacingZ);
  visit("filledVoids", filledVoids);
}

template <class Value>
Json written(Value& value);
template <class Value>
void read(const Json& json, Value& value);

template <class Value>
Json written(std::vector<Value>& values) {
  Json json = Json::array();
  for (Value& value : values) json.push_back(written(value));
  return json;
}
template <class Value>
void read(const Json& json, std::vector<Value>& values) {
  for (const Json& each : json) read(each, values.emplace_back());
}

template <class Value>
void putKey(Json& json, const char* key, Value& value) {
  json[key] = written(value);
}
template <class Value>
void putKey(Json& json, const char* key, IfAny<Value>& value) {
  if (!value.list.empty()) json[key] = written(value.list);
}
template <class Value>
void takeKey(const Json& json, const char* key, Value& value) {
  read(json.at(key), value);
}
template <class Value>
void takeKey(const Json& json, const char* key, IfAny<Value>& value) {
  if (json.contains(key)) read(json.at(key), value.list);
}

constexpr auto noVisit = [](const char*, const auto&) {};

template <class Value>
Json written(Value& value) {
  if constexpr (requires { eachKey(value, noVisit); }) {
    Json json = Json::object();
    eachKey(value, [&](const char* key, auto& member) { putKey(json, key, member); });
    return json;
  } else {
    return value;
  }
}
template <class Value>
void read(const Json& json, Value& value) {
  if constexpr (requires { eachKey(value, noVisit); })
    eachKey(value, [&](const char* key, auto& member) { takeKey(json, key, member); });
  else
    json.get_to(value);
}

template <class Visit>
void eachKey(StateHead& head, const Visit& visit) {
  visit("tick", head.tick);
  visit("dt", head.dt);
  visit("watchUntil", head.watchUntil);
  visit("options", head.options);
  visit("terrain", head.terrain);
  visit("rigsAreCallers", head.rigsAreCallers);
  visit("agentsInTick", head.agentsInTick);
  visit("kinds", head.kinds);
  visit("herds", head.herds);
  visit("coming", head.coming);
}

Json noteOf(const std::string& note) {
  if (note.empty()) return {};
  try {
    return Json::parse(note);
  } catch (const Json::exception&) {
    throw inputError("the note of a state is not JSON");
  }
}

void checkHerds(const StateHead& head, const std::string& name) {
  const auto isOfItsKind = [&](const SizeRun& run) {
    if (run.kind >= head.kinds.size()) return false;
    const StateKind& kind = head.kinds[run.kind];
    return run.place < kind.firstAgents.size() && kind.firstAgents[run.place] == run.firstAgent &&
           uint64_t{run.firstAgent} + run.agents <= kind.agents;
  };
  const auto fits = [&](const StateHerd& herd) {
    return herd.generation % 2 == 1 || std::ranges::all_of(herd.runs, isOfItsKind);
  };
  if (head.herds.size() != head.scene.herds.size() || !std::ranges::all_of(head.herds, fits))
    throw inputError(fmt::format("{}: its herds are others than those of its scene", name));
}

void checkRates(const StateRates& rates, const std::string& name) {
  constexpr size_t words = shared::LEVELS_WORDS - shared::LEVELS_TICKS;
  if (rates.words.size() != words || (!rates.camera.empty() && rates.camera.size() != 3))
    throw inputError(
        fmt::format("{}: its rates have {} words and {} coordinates of a camera, expected {} and 0 or 3",
                    name, rates.words.size(), rates.camera.size(), words));
}

void checkSides(const Heightfield& terrain, const std::string& name) {
  for (const uint32_t side : {terrain.columns, terrain.rows})
    if (side < minSamples || side > maxSamples)
      throw inputError(fmt::format("{}: its terrain has {} x {} samples, expected {} to {} a side", name,
                                   terrain.columns, terrain.rows, minSamples, maxSamples));
}

}  // namespace

std::optional<Record> StateChunk::record() const {
  for (const Record record : allRecords)
    if (name == infoOf(record).name) return record;
  return {};
}

Json jsonOf(const StateHead& head) {
  StateHead copy = head;  // a list of keys is for both directions, so it cannot take what is const
  Json json = Json::object();
  eachKey(copy, [&](const char* key, auto& member) { json[key] = written(member); });
  json["scene"] = Json::parse(sceneJson(head.scene));
  json["note"] = noteOf(head.note);
  if (head.begun > 0) json["begun"] = head.begun;
  if (!head.threats.empty()) json["threats"] = written(copy.threats);
  if (!head.series.empty()) json["series"] = written(copy.series);
  if (head.rates) json["rates"] = written(*copy.rates);
  json["terrain"]["hash"] = fmt::format("{:08x}", checksum(std::as_bytes(std::span(head.terrain.heights))));
  return json;
}

StateHead headOf(const Json& json, const std::string& name) try {
  StateHead head;
  eachKey(head, [&](const char* key, auto& member) { read(json.at(key), member); });
  head.scene = parseScene(json.at("scene").dump(), name, "/");
  if (const Json& note = json.at("note"); !note.is_null()) head.note = note.dump();
  head.begun = json.value("begun", uint64_t{0});
  if (json.contains("threats")) read(json.at("threats"), head.threats);
  if (json.contains("series")) read(json.at("series"), head.series);
  if (json.contains("rates")) {
    read(json.at("rates"), head.rates.emplace());
    checkRates(*head.rates, name);
    head.options.levels = Levels{.distances = head.rates->distances, .most = head.rates->most};
  }
  checkSides(head.terrain, name);
  checkHerds(head, name);
  for (const StateKind& kind : head.kinds)
    for (const StateChunk& chunk : kind.chunks)
      if (!chunk.record() && chunk.name != StateChunk::footfalls && chunk.name != StateChunk::generations &&
          chunk.name != StateChunk::trail)
        throw inputError(fmt::format("{}: {} is no known record", name, chunk.name));
  return head;
} catch (const Json::exception& fault) {
  throw inputError(fmt::format("{}: its head is none of a state: {}", name, fault.what()));
}

}  // namespace skitter::crowd
