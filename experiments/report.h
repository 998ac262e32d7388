#pragma once

#include <string>
#include <vector>

#include "experiments/conclusions.h"
#include "experiments/page/page.h"
#include "experiments/results.h"
#include "experiments/setup.h"

namespace skitter::experiments {

// A file of the report, whole, in memory.
struct ReportFile {
  std::string name, bytes;
};

// The page and the raw files that lie beside it.
struct Report {
  Page page;
  std::vector<ReportFile> files;

  // A table of figures beside the page, told of on it.
  void raw(const std::string& name, const std::string& csv) {
    files.push_back({name, csv});
    page.raw(name);
  }
};

// Raw files first, index.html last.
std::vector<ReportFile> reportOf(const Results& results, const Settings& settings, const Setup& setup);

}  // namespace skitter::experiments
