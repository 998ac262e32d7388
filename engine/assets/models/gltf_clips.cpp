#include "assets/models/gltf_clips.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "assets/files/json.h"
#include "assets/models/gltf_accessors.h"

namespace skitter::gltf {
namespace {

int indexAt(const Source& source, const nlohmann::json& json, const char* key, size_t count,
            const std::string& what) {
  const nlohmann::json& index = json.at(key);
  if (!index.is_number_unsigned() || index.get<uint64_t>() >= count) {
    source.fail("{} is {}, but there are {} of these", what, describeJson(index), count);
  }
  return index.get<int>();
}

int accessorAt(const Source& source, const nlohmann::json& sampler, const char* key,
               const std::string& part) {
  return indexAt(source, sampler, key, source.model.accessors.size(), part + "." + key);
}

Sampler sampler(Source& source, const nlohmann::json& from, const std::string& path,
                const std::string& part) {
  Sampler sampler;
  Values times = readAccessor(source, accessorAt(source, from, "input", part), {TINYGLTF_TYPE_SCALAR}, false,
                              part + ".input");
  for (size_t k = 0; k < times.count; ++k) {
    if (times.numbers[k] < 0 || (k > 0 && times.numbers[k] <= times.numbers[k - 1])) {
      source.fail("{} has the time {} at key {}, expected times that rise from 0", part, times.numbers[k], k);
    }
  }
  sampler.times = std::move(times.numbers);
  const std::string interpolation = from.value("interpolation", std::string("LINEAR"));
  if (interpolation == "STEP") {
    sampler.interpolation = Interpolation::step;
  } else if (interpolation == "CUBICSPLINE") {
    sampler.interpolation = Interpolation::cubicSpline;
  } else if (interpolation != "LINEAR") {
    source.fail("{}.interpolation is {}, expected STEP, LINEAR or CUBICSPLINE", part,
                describeJson(from.at("interpolation")));
  }
  const int output = accessorAt(source, from, "output", part);
  if (path == "weights") {
    readAccessor(source, output, {TINYGLTF_TYPE_SCALAR}, false, part + ".output");
    return sampler;
  }
  if (path == "rotation") {
    sampler.path = Path::rotation;
  } else if (path == "scale") {
    sampler.path = Path::scale;
  } else if (path != "translation") {
    source.fail("{} drives {}, expected translation, rotation, scale or weights", part, describeJson(path));
  }
  const bool turns = sampler.path == Path::rotation;
  Values values = readAccessor(source, output, {turns ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3}, false,
                               part + ".output");
  const size_t each = sampler.interpolation == Interpolation::cubicSpline ? 3 : 1;
  if (values.count != each * sampler.times.size()) {
    source.fail("{} has {} outputs for {} keys, expected {}", part, values.count, sampler.times.size(),
                each * sampler.times.size());
  }
  sampler.values = std::move(values.numbers);
  for (size_t k = 0; turns && k < sampler.times.size(); ++k) {
    double* key = sampler.values.data() + 4 * (each == 3 ? 3 * k + 1 : k);
    const double length = std::sqrt(key[0] * key[0] + key[1] * key[1] + key[2] * key[2] + key[3] * key[3]);
    if (!(std::fabs(length - 1) <= 0.1)) {
      source.fail("{} has a rotation of length {} at key {}, expected 1", part, length, k);
    }
    for (int i = 0; each == 1 && i < 4; ++i) key[i] /= length;
  }
  return sampler;
}

Clip clip(Source& source, const nlohmann::json& json, const std::string& what,
          const std::vector<Node>& nodes) {
  Clip clip;
  clip.name = json.value("name", std::string());
  const nlohmann::json& samplers = json.at("samplers");
  const nlohmann::json& channels = json.at("channels");
  clip.channelCount = channels.size();
  std::map<std::pair<size_t, std::string>, size_t> samplerOf;  // read once for each path that it drives
  std::map<std::pair<int, Path>, size_t> channelOf;
  std::vector<std::string> notes;
  size_t morphs = 0;
  for (const nlohmann::json& channel : channels) {
    const int index =
        indexAt(source, channel, "sampler", samplers.size(), what + " has a channel whose sampler");
    const nlohmann::json& target = channel.at("target");
    int node = -1;
    if (target.contains("node"))
      node = indexAt(source, target, "node", source.model.nodes.size(), what + " targets a node that");
    const std::string path = target.at("path").get<std::string>();
    const auto [known, isNew] =
        samplerOf.try_emplace({static_cast<size_t>(index), path}, clip.samplers.size());
    if (isNew) {
      const nlohmann::json& from = samplers.at(static_cast<size_t>(index));
      clip.samplers.push_back(sampler(source, from, path, fmt::format("{}.samplers[{}]", what, index)));
      clip.seconds = std::max(clip.seconds, clip.samplers.back().times.back());
    }
    if (path == "weights") {
      ++morphs;
      continue;
    }
    if (node == -1) continue;  // nothing in the file that it moves
    if (nodes[static_cast<size_t>(node)].hasMatrix) {
      notes.push_back(fmt::format("{} moves nodes[{}], which has a matrix: not moved", what, node));
      continue;
    }
    const auto [place, first] =
        channelOf.try_emplace({node, clip.samplers[known->second].path}, clip.moving.size());
    if (first) {
      clip.moving.push_back({node, known->second});
      continue;
    }
    clip.moving[place->second].sampler = known->second;
    notes.push_back(
        fmt::format("{} has two channels of the {} of nodes[{}]: the later counts", what, path, node));
  }
  if (morphs > 0) notes.push_back(fmt::format("{} has {} channels of morph weights: left out", what, morphs));
  // One line a clip: a file may have very many channels.
  if (notes.size() > 1) notes[0] += fmt::format(", and {} more like it", notes.size() - 1);
  if (!notes.empty()) source.notes.push_back(notes[0]);
  return clip;
}

}  // namespace

void readClips(Source& source, Document& document) {
  const auto animations = source.file.json.find("animations");
  if (animations == source.file.json.end()) return;
  if (!animations->is_array() || animations->size() > maxObjects) {
    source.fail("animations is {}, expected an array of up to {}", describeJson(*animations), maxObjects);
  }
  for (size_t i = 0; i < animations->size(); ++i) {
    const std::string what = fmt::format("animations[{}]", i);
    try {
      document.clips.push_back(clip(source, (*animations)[i], what, document.nodes));
    } catch (const Error& error) {
      source.notes.push_back(error.detail(source.name) + ": clip left out");
    } catch (const nlohmann::json::exception&) {
      source.notes.push_back(what + " is malformed: clip left out");
    }
  }
}

}  // namespace skitter::gltf
