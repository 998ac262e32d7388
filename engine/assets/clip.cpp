#include "skitter/clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "clip_bake.h"
#include "clip_skin.h"
#include "clip_stance.h"
#include "embedded/spider_glb.h"
#include "placement.h"
#include "rig_source.h"
#include "skitter/error.h"

namespace skitter {
namespace {

constexpr double allowedError = 1e-4;  // of the skin's size

void checkRig(const RigSource& source, const ClipSet& set, const Rig& rig) {
  const auto same = [](const ClipLeg& leg, const Leg& of) { return leg.starts.size() == of.bones.size() + 1; };
  if (!std::equal(set.legs.begin(), set.legs.end(), rig.legs.begin(), rig.legs.end(), same)) {
    throw inputError(fmt::format("{}: the rig given is not of this file: it has {} legs, expected {} with as many bones",
                                 source.name, rig.legs.size(), set.legs.size()));
  }
}

ClipSet bakeAll(const RigSource& source, const Rig& rig) {
  ClipSet set;
  set.name = source.model.name;
  // Without legs nothing says where the creature stands: the model stays where it is.
  const RigSetup asItComes;
  const RigSetup& setup = source.setup.legs.empty() ? asItComes : source.setup;
  const Placement placement = placeModel(source.model, setup, source.name, source.path);
  const ClipSkin skin = bindSkin(source, placement, set);
  checkRig(source, set, rig);
  BakeBudget budget;
  for (size_t i = 0; i < source.document.clips.size(); ++i) {
    const gltf::Clip& from = source.document.clips[i];
    try {
      Clip clip = bakeClip(source.document, from, skin, set.legs, allowedError * set.size,
                           fmt::format("clip {} \"{}\"", i, from.name), budget);
      findStance(clip, set.legs.size(), static_cast<double>(rig.legLength));
      set.clips.push_back(std::move(clip));
    } catch (const Error& error) {
      set.notes.push_back(fmt::format("{}: left out", error.what()));
    }
  }
  return set;
}

ClipSet bake(const RigSource& source, const Rig& rig) {
  try {
    return bakeAll(source, rig);
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
  for (const Clip& clip : clips) names.push_back(fmt::format("\"{}\"", clip.name));
  throw inputError(fmt::format("{}: no clip is named \"{}\", {}", name, clipName,
                               names.empty() ? "and there is none" : fmt::format("expected one of {}", fmt::join(names, ", "))));
}

ClipSet loadClips(const std::filesystem::path& file, const Rig& rig) {
  return bake(loadRigSource(file, NoLegs::proposed), rig);
}

ClipSet spiderClips() {
  return bake(parseRigSource(embedded::spider_glb(), "spider.glb"), spiderRig());
}

}  // namespace skitter
