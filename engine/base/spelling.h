#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace skitter::base {

// Letters to insert, drop, replace or swap with the next one, so that one word becomes the other (optimal
// string alignment).
inline size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1] ? 1 : 0)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

// The end of a message that says that `word` is none of `names`: "; did you mean agents? Expected one of
// keys, agents", or ", expected one of keys, agents" where no name is near. A name is near where at most a
// third of the longer word's letters differ. `quote` stands before and behind each name.
inline std::string expectedOneOf(std::string_view word, std::span<const std::string> names,
                                 std::string_view quote = "") {
  std::string list, nearest;
  size_t least = SIZE_MAX;
  for (const std::string& name : names) {
    list += fmt::format("{}{}{}{}", list.empty() ? "" : ", ", quote, name, quote);
    // Words that differ this much in length are not compared: a key in a file may be of any length.
    const size_t longer = std::max(word.size(), name.size()), shorter = std::min(word.size(), name.size());
    if (3 * (longer - shorter) > longer) continue;
    const size_t distance = editDistance(word, name);
    if (distance >= least || 3 * distance > longer) continue;
    least = distance;
    nearest = name;
  }
  if (nearest.empty()) return fmt::format(", expected one of {}", list);
  return fmt::format("; did you mean {}? Expected one of {}", nearest, list);
}

}  // namespace skitter::base
