#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "assets/rigs/joint_names.h"
#include "skitter/clip.h"

namespace skitter {
namespace {

// Beginnings of words in names of clips: "die" is in "Spider_Dies".
constexpr std::string_view actions[] = {
    "attack", "bite",  "charge", "claw",   "damage", "dead",  "death", "defeat", "die",  "dodge", "dying",
    "eat",    "fall",  "fight",  "flinch", "hit",    "hurt",  "jump",  "kick",   "land", "leap",  "peck",
    "punch",  "react", "roar",   "roll",   "shoot",  "spawn", "sting", "strike", "stun", "throw"};
constexpr std::string_view slow[] = {"walk", "crawl", "creep", "sneak", "stroll", "march", "forward"};
constexpr std::string_view quick[] = {"trot", "jog", "run", "pace", "scuttle"};
constexpr std::string_view fast[] = {"gallop", "sprint", "canter", "dash"};
constexpr std::string_view rests[] = {"idle", "stand", "rest"};

template <typename Words>
bool says(const std::string& name, const Words& wanted) {
  const std::vector<std::string> words = wordsOf(name);
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return std::any_of(std::begin(wanted), std::end(wanted),
                       [&](std::string_view begin) { return word.starts_with(begin); });
  });
}

// How fast a clip's name says that it is; 0: it says nothing.
int paceOf(const Clip& clip) {
  if (says(clip.name, fast)) return 3;
  if (says(clip.name, quick)) return 2;
  return says(clip.name, slow) ? 1 : 0;
}

}  // namespace

std::vector<const Clip*> ClipSet::locomotion() const {
  const Clip* standing = nullptr;
  std::vector<const Clip*> moving;
  for (const Clip& clip : clips) {
    if (clip.speed < 0 || says(clip.name, actions)) continue;
    if (clip.speed > 0) {
      moving.push_back(&clip);
    } else if (!standing || (says(clip.name, rests) && !says(standing->name, rests))) {
      standing = &clip;
    }
  }
  std::stable_sort(moving.begin(), moving.end(),
                   [](const Clip* a, const Clip* b) { return paceOf(*a) < paceOf(*b); });
  // Clips that are named as a gait leave no room for others. A speed is measured by the feet that stand,
  // which tells little where most are in the air: a gallop is no slower than a walk.
  std::vector<const Clip*> chosen;
  const bool named = !moving.empty() && paceOf(*moving.back()) > 0;
  for (const Clip* clip : moving) {
    const bool isSlower = std::any_of(chosen.begin(), chosen.end(), [&](const Clip* other) {
      return paceOf(*other) < paceOf(*clip) && other->speed >= clip->speed;
    });
    if (!isSlower && (paceOf(*clip) > 0 || !named)) chosen.push_back(clip);
  }
  if (standing) chosen.push_back(standing);
  return chosen;
}

}  // namespace skitter
