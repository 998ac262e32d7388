#pragma once

#include <string>
#include <vector>

namespace skitter::experiments {

// Figures in rows: a CSV file, and a table of the page. Cells are written out; whatever holds a comma or a
// quote is quoted.
struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows = {};

  std::string csv() const;
};

// A number in few digits, as a reader wants it: 3 significant ones unless told. A number that is none, or not
// finite, is a dash.
std::string figure(double value, int digits = 3);

}  // namespace skitter::experiments
