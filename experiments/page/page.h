#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "experiments/page/table.h"

namespace skitter::experiments {

// One self-contained HTML page: style, drawings and pictures are all inside it.
class Page {
 public:
  Page(std::string title, std::string subtitle);

  // Begins a section; `id` is what links and tests know it by.
  void section(const std::string& id, const std::string& heading);
  void heading(const std::string& text);  // within a section
  void paragraph(const std::string& text);
  void warning(const std::string& text);
  void facts(const std::vector<std::pair<std::string, std::string>>& rows);  // name and value
  void table(const Table& table);
  // Drawings side by side as far as there is room, with one caption. SVG as it is.
  void drawings(const std::vector<std::string>& svgs, const std::string& caption);
  void picture(std::span<const std::byte> png, const std::string& alternative, const std::string& caption);
  // The raw figures of what stands above: a file that lies beside the page.
  void raw(const std::string& file);

  std::string html() const;

 private:
  std::string title_, subtitle_, contents_, body_;
  bool open_ = false;
};

std::string base64(std::span<const std::byte> bytes);

}  // namespace skitter::experiments
