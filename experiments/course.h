#pragma once

#include <exception>
#include <functional>

namespace skitter::experiments {

// Thrown out of an experiment when the caller wants no more of it.
struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};

// How far all experiments together are, and whether to go on. Each is given a share of the whole.
class Course {
 public:
  Course(std::function<void(double)> show, std::function<bool()> stopped)
      : show_(std::move(show)), stopped_(std::move(stopped)) {}

  // The next experiment, which takes `share` of the whole.
  void begin(double share) {
    start_ += share_;
    share_ = share;
    at(0);
  }
  // `done` of the present one. Throws Interrupted.
  void at(double done) {
    if (stopped_()) throw Interrupted();
    show_(start_ + share_ * done);
  }

 private:
  std::function<void(double)> show_;
  std::function<bool()> stopped_;
  double start_ = 0, share_ = 0;
};

}  // namespace skitter::experiments
