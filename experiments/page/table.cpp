#include "experiments/page/table.h"

#include <fmt/format.h>

#include <cmath>

namespace skitter::experiments {
namespace {

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\n") == std::string::npos) return cell;
  std::string made = "\"";
  for (const char c : cell) made += c == '"' ? std::string("\"\"") : std::string(1, c);
  return made + '"';
}

void appendRow(const std::vector<std::string>& cells, std::string& text) {
  for (size_t i = 0; i < cells.size(); ++i) text += (i > 0 ? "," : "") + quoted(cells[i]);
  text += '\n';
}

}  // namespace

std::string Table::csv() const {
  std::string text;
  appendRow(head, text);
  for (const std::vector<std::string>& row : rows) appendRow(row, text);
  return text;
}

std::string figure(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  if (value == 0) return "0";
  // Whole digits are all shown; 12300 is no better read as 1.23e+04.
  const double size = std::fabs(value);
  if (size >= 1e-4 && size < 1e7) {
    const int before = static_cast<int>(std::floor(std::log10(size))) + 1;
    return fmt::format("{:.{}f}", value, std::max(0, digits - before));
  }
  return fmt::format("{:.{}g}", value, digits);
}

}  // namespace skitter::experiments
