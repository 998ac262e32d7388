#include "skitter/clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "assets/clips/clip_bake.h"
#include "assets/clips/clip_size.h"
#include "assets/clips/clip_skin.h"
#include "assets/clips/clip_stance.h"
#include "assets/models/reading_notes.h"
#include "assets/rigs/placement.h"
#include "assets/rigs/rig_source.h"
#include "base/spelling.h"
#include "embedded/spider_glb.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr double allowedError = 1e-4;  // of the skin's size

void checkRig(const RigSource& source, const ClipSet& set, const Rig& rig) {
  const auto same = [](const ClipLeg& leg, const Leg& of) {
    return leg.starts.size() == of.bones.size() + 1;
  };
  if (!std::equal(set.legs.begin(), set.legs.end(), rig.legs.begin(), rig.legs.end(), same)) {
    throw inputError(
        fmt::format("{}: the rig given is not of this file: it has {} legs, expected {} with as many bones",
                    source.name, rig.legs.size(), set.legs.size()));
  }
}

class SetBaker {
 public:
  SetBaker(const RigSource& source, const Rig& rig) : source_(source), rig_(rig) {
    set_.name = source.model.name;
    // Without legs nothing says where the creature stands: the model stays where it is.
    const RigSetup asItComes;
    const RigSetup& setup = source.setup.legs.empty() ? asItComes : source.setup;
    skin_ = bindSkin(source, placeModel(source.model, setup, source.name, source.path), set_);
    checkRig(source, set_, rig);
  }

  ClipSet bake(std::span<const ClipCut> cuts) {
    const std::vector<gltf::Clip>& clips = source_.document.clips;
    for (size_t i = 0; i < clips.size(); ++i) {
      const std::string what = fmt::format("clip {} \"{}\"", i, clips[i].name);
      clips_.push_back(inRestSize(source_.document, clips[i], skin_, what, set_.notes));
      try {
        add({clips_[i], 0, clips_[i].seconds}, clips_[i].name, what);
      } catch (const Error& error) {
        set_.notes.push_back(fmt::format("{}: left out", error.what()));
      }
    }
    // A cut is asked for by name, so that one that cannot be had is an error.
    for (const ClipCut& cut : cuts)
      add(find(cut), cut.name, fmt::format("{}: cut \"{}\"", source_.name, cut.name));
    return std::move(set_);
  }

 private:
  void add(const BakeRange& range, const std::string& name, const std::string& what) {
    Clip clip = bakeClip(source_.document, range, skin_, set_.legs, allowedError * set_.size, what, budget_);
    clip.name = name;
    findStance(clip, set_.legs.size(), static_cast<double>(rig_.legLength));
    set_.clips.push_back(std::move(clip));
  }

  BakeRange find(const ClipCut& cut) const {
    const auto found = std::find_if(clips_.begin(), clips_.end(),
                                    [&](const gltf::Clip& clip) { return clip.name == cut.clip; });
    if (found == clips_.end()) {
      throw inputError(fmt::format("{}: cut \"{}\" is of a clip \"{}\", which there is not", source_.name,
                                   cut.name, cut.clip));
    }
    if (!(cut.from >= 0 && cut.to > cut.from && cut.to <= found->seconds)) {
      throw inputError(fmt::format("{}: cut \"{}\" is from {} to {} s of a clip of {} s", source_.name,
                                   cut.name, cut.from, cut.to, found->seconds));
    }
    return {*found, cut.from, cut.to};
  }

  const RigSource& source_;
  const Rig& rig_;
  ClipSet set_;
  ClipSkin skin_;
  std::vector<gltf::Clip> clips_;  // in the size at rest
  BakeBudget budget_;
};

ClipSet bake(const RigSource& source, const Rig& rig, std::span<const ClipCut> cuts) {
  try {
    ClipSet set = SetBaker(source, rig).bake(cuts);
    noteReading(source.model.name, set.notes);
    return set;
  } catch (const std::bad_alloc&) {
    throw inputError(fmt::format("{}: its clips do not fit into memory", source.name));
  }
}

}  // namespace

const Clip& ClipSet::clip(const std::string& clipName) const {
  const auto found =
      std::find_if(clips.begin(), clips.end(), [&](const Clip& clip) { return clip.name == clipName; });
  if (found != clips.end()) return *found;
  std::vector<std::string> names;
  for (const Clip& clip : clips) names.push_back(clip.name);
  throw inputError(
      fmt::format("{}: no clip is named \"{}\"{}", name, clipName,
                  names.empty() ? ", and there is none" : base::expectedOneOf(clipName, names, "\"")));
}

ClipSet loadClips(const std::filesystem::path& file, const Rig& rig, std::span<const ClipCut> cuts) {
  return bake(loadRigSource(file, NoLegs::proposed), rig, cuts);
}

ClipSet spiderClips() { return bake(parseRigSource(embedded::spider_glb(), "spider.glb"), spiderRig(), {}); }

}  // namespace skitter
