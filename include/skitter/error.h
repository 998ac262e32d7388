#pragma once

#include <stdexcept>
#include <string>

#include "skitter/export.h"

namespace skitter {

// Wrong input or a failing world. what() is one line that names the file or object, what was found and what
// was expected. Public functions throw nothing else but std::bad_alloc. Within the engine, a caller's bug is
// an assertion.
class SKITTER_API Error : public std::runtime_error {
 public:
  // The values are the exit codes of the `skitter` command.
  enum class Kind {
    check = 1,   // a check ran and failed
    input = 2,   // wrong usage, unreadable or malformed input, unwritable output
    device = 3,  // no usable Vulkan device, or the device failed
  };

  Error(Kind kind, const std::string& message) : std::runtime_error(inOneLine(message)), kind_(kind) {}
  Kind kind() const { return kind_; }
  // The message without the name of the file or object, where it begins with this one.
  std::string detail(const std::string& name) const {
    const std::string message = what(), start = inOneLine(name + ": ");
    return message.starts_with(start) ? message.substr(start.size()) : message;
  }

 private:
  // A name out of a file may hold anything.
  static std::string inOneLine(std::string message) {
    for (char& c : message) {
      if (static_cast<unsigned char>(c) < ' ') c = ' ';
    }
    return message;
  }

  Kind kind_;
};

inline Error inputError(const std::string& message) { return {Error::Kind::input, message}; }
inline Error deviceError(const std::string& message) { return {Error::Kind::device, message}; }

}  // namespace skitter
