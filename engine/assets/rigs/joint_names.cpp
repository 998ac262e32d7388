#include "assets/rigs/joint_names.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace skitter {
namespace {

constexpr const char* arms[] = {"arm*",      "upperarm*", "lowerarm*", "forearm*", "hand*",
                                "shoulder*", "wrist*",    "fist*",     "elbow*",   "clavicle*"};
constexpr const char* fingers[] = {"finger*", "thumb*", "index*", "pinky*"};
constexpr const char* held[] = {"weapon*", "gun*",  "sword*", "staff*", "axe*",    "shield*",
                                "spear*",  "knife", "bow",    "club",   "hammer*", "rifle*"};
constexpr const char* loose[] = {"tail*",  "antenna*", "wing*",  "fin",     "fins", "hair*",
                                 "cape*",  "cloth*",   "skirt*", "tongue*", "jaw*", "pincer*",
                                 "mouth*", "ear",      "ears",   "flag*"};
constexpr const char* helpers[] = {"ik",     "pole",  "target", "ctrl", "control",
                                   "helper", "twist", "mch",    "roll", "poletarget"};

}  // namespace

const Words armWords = arms, fingerWords = fingers, heldWords = held, looseWords = loose,
            helperWords = helpers;

std::vector<std::string> wordsOf(const std::string& name) {
  const auto is = [](int (*kind)(int), char c) { return kind(static_cast<unsigned char>(c)) != 0; };
  std::vector<std::string> words;
  for (size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (!is(std::isalnum, c)) continue;
    const char before = i > 0 ? name[i - 1] : ' ';
    // A word begins after anything else, where a capital follows a small letter, and where letters and digits
    // meet; of capitals in a row the last begins the next word if a small letter follows.
    const bool begins = !is(std::isalnum, before) || (is(std::isupper, c) && is(std::islower, before)) ||
                        is(std::isdigit, c) != is(std::isdigit, before) ||
                        (is(std::isupper, c) && is(std::isupper, before) && i + 1 < name.size() &&
                         is(std::islower, name[i + 1]));
    if (begins) words.emplace_back();
    words.back().push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  }
  return words;
}

std::vector<std::string> wordsOf(const Model& model, const std::vector<int>& nodes) {
  std::vector<std::string> all;
  for (const int node : nodes) {
    for (std::string& word : wordsOf(model.nodes[static_cast<size_t>(node)].name))
      all.push_back(std::move(word));
  }
  return all;
}

bool hasWord(const std::vector<std::string>& words, Words wanted) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return std::any_of(wanted.begin(), wanted.end(), [&](const char* entry) {
      const std::string_view text(entry);
      return text.back() == '*' ? word.starts_with(text.substr(0, text.size() - 1)) : word == text;
    });
  });
}

int sideOf(const std::vector<std::string>& words) {
  constexpr const char* left[] = {"l", "left*"};
  constexpr const char* right[] = {"r", "right*"};
  return static_cast<int>(hasWord(words, left)) - static_cast<int>(hasWord(words, right));
}

}  // namespace skitter
