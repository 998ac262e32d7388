#include "assets/models/gltf_clips.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string_view>

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

// The keys of a sampler: their times and their values, tangents included.
struct Keys {
  std::vector<double> times, values;
  size_t width = 0;   // numbers a key
  size_t value = 0;   // where the value itself is among them
  size_t length = 0;  // numbers of the value
};

bool isFinite(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
}

// Keeps the keys that say something, in order of time. `part` is the sampler's name.
Keys mended(Source& source, const Keys& from, bool turns, bool isSpline, const std::string& part) {
  Keys to{.times = {}, .values = {}, .width = from.width, .value = from.value, .length = from.length};
  std::vector<size_t> order;
  size_t numberless = 0, zero = 0, scaled = 0, shared = 0;
  std::vector<double> values = from.values;
  for (size_t k = 0; k < from.times.size(); ++k) {
    const std::span<double> key(values.data() + k * from.width, from.width);
    if (!std::isfinite(from.times[k]) || !isFinite(key)) {
      ++numberless;
      continue;
    }
    double squares = 0;
    for (const double number : key.subspan(from.value, from.length)) squares += number * number;
    const double length = std::sqrt(squares);
    if (turns && length < 1e-6) {
      ++zero;
      continue;
    }
    order.push_back(k);
    const bool isOff = !(std::fabs(length - 1) <= 0.1);
    scaled += turns && isOff;
    // A spline's curve is scaled to 1 wherever it is sampled, so that only what is far off is changed here.
    if (turns && (!isSpline || isOff))
      for (double& number : key) number /= length;
  }
  const auto byTime = [&](size_t a, size_t b) { return from.times[a] < from.times[b]; };
  const bool isSorted = std::is_sorted(order.begin(), order.end(), byTime);
  if (!isSorted) std::stable_sort(order.begin(), order.end(), byTime);
  for (const size_t k : order) {
    if (!to.times.empty() && to.times.back() == from.times[k]) {  // as of two channels, the later one counts
      ++shared;
      to.times.pop_back();
      to.values.resize(to.values.size() - from.width);
    }
    to.times.push_back(from.times[k]);
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(k * from.width);
    to.values.insert(to.values.end(), at, at + static_cast<std::ptrdiff_t>(from.width));
  }
  const std::string clip = part.substr(0, part.find('.'));
  const auto note = [&](size_t count, const char* what) {
    if (count > 0) source.notes.add(clip + what, fmt::format("{} has {} keys {}", part, count, what));
  };
  note(numberless, "that hold what is no number: left out");
  note(zero, "of a rotation of length 0: left out");
  note(scaled, "of a rotation that has not the length 1: scaled to it");
  note(shared, "at the time of a later one: left out");
  if (!isSorted) source.notes.add(clip + "order", part + " has keys out of order: sorted by time");
  return to;
}

std::vector<double> timesOf(Source& source, const nlohmann::json& from, const std::string& part) {
  return readAccessor(source, accessorAt(source, from, "input", part), {TINYGLTF_TYPE_SCALAR}, false,
                      part + ".input", NotFinite::kept)
      .numbers;
}

Sampler sampler(Source& source, const nlohmann::json& from, Path path, const std::string& part) {
  Sampler sampler;
  sampler.path = path;
  const std::string interpolation = from.value("interpolation", std::string("LINEAR"));
  if (interpolation == "STEP") {
    sampler.interpolation = Interpolation::step;
  } else if (interpolation == "CUBICSPLINE") {
    sampler.interpolation = Interpolation::cubicSpline;
  } else if (interpolation != "LINEAR") {
    source.fail("{}.interpolation is {}, expected STEP, LINEAR or CUBICSPLINE", part,
                describeJson(from.at("interpolation")));
  }
  const bool turns = path == Path::rotation, isSpline = sampler.interpolation == Interpolation::cubicSpline;
  Keys keys;
  keys.times = timesOf(source, from, part);
  keys.values = readAccessor(source, accessorAt(source, from, "output", part),
                             {turns ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3}, false, part + ".output",
                             NotFinite::kept)
                    .numbers;
  keys.length = turns ? 4 : 3;
  keys.width = keys.length * (isSpline ? 3 : 1);
  keys.value = isSpline ? keys.length : 0;
  if (keys.values.size() != keys.width * keys.times.size()) {
    source.fail("{} has {} outputs for {} keys, expected {}", part, keys.values.size() / keys.length,
                keys.times.size(), keys.times.size() * keys.width / keys.length);
  }
  keys = mended(source, keys, turns, isSpline, part);
  sampler.times = std::move(keys.times);
  sampler.values = std::move(keys.values);
  return sampler;
}

// A channel drives a property of a node, or something that is not played.
struct Target {
  int node = -1;  // none: nothing in the file
  std::optional<Path> path;
  bool isMorph = false;
  std::string name;  // of what is not played
};

std::optional<Path> pathNamed(std::string_view name) {
  if (name == "translation") return Path::translation;
  if (name == "rotation") return Path::rotation;
  if (name == "scale") return Path::scale;
  return {};
}

// A pointer into the file, of which those to a node's properties are what channels say without it
// (KHR_animation_pointer): "/nodes/3/rotation".
Target pointed(const Source& source, const nlohmann::json& target) {
  const nlohmann::json pointer =
      target.value(nlohmann::json::json_pointer("/extensions/KHR_animation_pointer/pointer"), "");
  const std::string text = pointer.is_string() ? pointer.get<std::string>() : "";
  Target found{.node = -1, .path = {}, .isMorph = text.ends_with("/weights"), .name = describeJson(text)};
  const size_t slash = text.rfind('/');
  constexpr std::string_view start = "/nodes/";
  if (!text.starts_with(start) || slash <= start.size()) return found;
  size_t node = 0;
  const char* end = text.data() + slash;
  const auto parsed = std::from_chars(text.data() + start.size(), end, node);
  if (parsed.ec != std::errc() || parsed.ptr != end || node >= source.model.nodes.size()) return found;
  found.path = pathNamed(std::string_view(text).substr(slash + 1));
  if (found.path) found.node = static_cast<int>(node);
  return found;
}

Target targetOf(const Source& source, const nlohmann::json& target, const std::string& what) {
  const std::string path = target.at("path").get<std::string>();
  if (path == "pointer") return pointed(source, target);
  Target found{.node = -1, .path = pathNamed(path), .isMorph = path == "weights", .name = describeJson(path)};
  if (target.contains("node"))
    found.node = indexAt(source, target, "node", source.model.nodes.size(), what + " targets a node that");
  return found;
}

// The last time of a channel that is not played: it counts for how long the clip lasts. Its faults do not
// matter.
double lastTime(Source& source, const nlohmann::json& sampler, const std::string& part) {
  double last = 0;
  try {
    for (const double time : timesOf(source, sampler, part))
      if (std::isfinite(time)) last = std::max(last, time);
  } catch (const Error&) {
  } catch (const nlohmann::json::exception&) {
  }
  return last;
}

// Before 0 nothing is played, so that what begins there is moved to begin at 0, all of the clip alike.
void startAtZero(Source& source, Clip& clip, const std::string& what) {
  double first = 0;
  for (const Sampler& sampler : clip.samplers)
    if (!sampler.times.empty()) first = std::min(first, sampler.times.front());
  if (first == 0) return;
  for (Sampler& sampler : clip.samplers)
    for (double& time : sampler.times) time -= first;
  clip.seconds -= first;
  source.notes.lines.push_back(fmt::format("{} begins at {:.3g} s: moved to begin at 0", what, first));
}

class ClipReader {
 public:
  ClipReader(Source& source, const nlohmann::json& json, const std::string& what,
             const std::vector<Node>& nodes)
      : source_(source), samplers_(json.at("samplers")), what_(what), nodes_(nodes) {
    const auto name = json.find("name");
    if (name != json.end() && name->is_string()) clip_.name = name->get<std::string>();
  }

  // A channel that is at fault is left out; where no other moves anything, their clip.
  Clip read(const nlohmann::json& channels) {
    std::vector<std::string> faults;
    for (const nlohmann::json& channel : channels) {
      try {
        add(channel);
      } catch (const Error& error) {
        faults.push_back(error.detail(source_.name));
      }
    }
    if (!faults.empty() && clip_.moving.empty()) throw inputError(faults[0]);
    for (const std::string& fault : faults) source_.notes.add(what_ + " fault", fault + ": channel left out");
    clip_.channelCount = channels.size();
    if (morphs_ > 0)
      source_.notes.lines.push_back(
          fmt::format("{} has {} channels of morph weights: left out", what_, morphs_));
    startAtZero(source_, clip_, what_);
    return std::move(clip_);
  }

 private:
  template <typename... Arguments>
  void note(const char* kind, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    source_.notes.add(what_ + kind, what_ + fmt::format(format, std::forward<Arguments>(arguments)...));
  }

  void add(const nlohmann::json& channel) {
    const int index =
        indexAt(source_, channel, "sampler", samplers_.size(), what_ + " has a channel whose sampler");
    const nlohmann::json& from = samplers_.at(static_cast<size_t>(index));
    const std::string part = fmt::format("{}.samplers[{}]", what_, index);
    const Target target = targetOf(source_, channel.at("target"), what_);
    if (!target.path) {
      clip_.seconds = std::max(clip_.seconds, lastTime(source_, from, part));
      morphs_ += target.isMorph;
      if (!target.isMorph) note("drives", " drives {}, which is not played: channel left out", target.name);
      return;
    }
    const size_t read = samplerOf(index, *target.path, from, part);
    if (clip_.samplers[read].times.empty()) {
      note("keys", ".samplers[{}] has no keys: its channels are left out", index);
      return;
    }
    if (target.node == -1) return;  // nothing in the file that it moves
    if (nodes_[static_cast<size_t>(target.node)].hasMatrix) {
      note("matrix", " moves nodes[{}], which has a matrix: not moved", target.node);
      return;
    }
    const auto [place, first] = channelOf_.try_emplace({target.node, *target.path}, clip_.moving.size());
    if (first) {
      clip_.moving.push_back({target.node, read});
      return;
    }
    clip_.moving[place->second].sampler = read;
    constexpr const char* names[] = {"translation", "rotation", "scale"};
    note("twice", " has two channels of the {} of nodes[{}]: the later counts",
         names[static_cast<size_t>(*target.path)], target.node);
  }

  // Among the clip's, read once for each path that it drives.
  size_t samplerOf(int index, Path path, const nlohmann::json& from, const std::string& part) {
    if (const auto known = read_.find({index, path}); known != read_.end()) return known->second;
    Sampler read = sampler(source_, from, path, part);
    if (!read.times.empty()) clip_.seconds = std::max(clip_.seconds, read.times.back());
    clip_.samplers.push_back(std::move(read));
    return read_[{index, path}] = clip_.samplers.size() - 1;
  }

  Source& source_;
  const nlohmann::json& samplers_;
  const std::string& what_;
  const std::vector<Node>& nodes_;
  Clip clip_;
  std::map<std::pair<int, Path>, size_t> read_;
  std::map<std::pair<int, Path>, size_t> channelOf_;
  size_t morphs_ = 0;
};

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
      const nlohmann::json& json = (*animations)[i];
      document.clips.push_back(ClipReader(source, json, what, document.nodes).read(json.at("channels")));
    } catch (const Error& error) {
      source.notes.lines.push_back(error.detail(source.name) + ": clip left out");
    } catch (const nlohmann::json::exception&) {
      source.notes.lines.push_back(what + " is malformed: clip left out");
    }
  }
}

}  // namespace skitter::gltf
