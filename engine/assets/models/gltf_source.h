#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "assets/models/gltf_file.h"
#include "assets/models/gltf_model.h"
#include "skitter/error.h"

namespace skitter::gltf {

// A file that is being read. tinygltf checks few of the references between objects, so its readers trust no
// index, size or number of it. All faults are Errors(input) that begin with the file's name.
struct Source {
  const tinygltf::Model& model;
  const File& file;
  const std::string& name;
  Notes notes = {};        // what was left out or mended
  size_t numbersRead = 0;  // of all accessors

  template <typename... Arguments>
  [[noreturn]] void fail(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
    throw inputError(name + ": " + fmt::format(format, std::forward<Arguments>(arguments)...));
  }
  // `what` is the index's name.
  void checkIndex(int index, size_t count, const std::string& what) const;
  // As many as expected or none.
  void checkFinite(const std::vector<double>& values, size_t expected, const std::string& what) const;
};

}  // namespace skitter::gltf
