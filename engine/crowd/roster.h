#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "crowd/herd.h"
#include "crowd/kinds.h"
#include "skitter/scene.h"

namespace skitter::crowd {

// Which herds there are as they come and go, by number: what a crowd cannot have is refused before anything
// is made or freed. Herds are those of the scene or of the crowd, which outlives this and does not change
// meanwhile. `name` is whom a message is about.
class Roster {
 public:
  // As a crowd of the scene begins.
  Roster(const Scene& scene, const Kinds& kinds);
  // As it is now.
  explicit Roster(const Crowd::Impl& crowd);

  size_t numbers() const { return herds_.size(); }  // those of herds that are gone among them
  uint64_t places() const;                          // of all herds, empty ones among them
  // nullptr where no herd has that number.
  const skitter::Herd* find(uint32_t number) const;

  // The lowest number that no herd has, which the herd takes. Throws Error(input) where there would be too
  // many places, herds or kinds.
  uint32_t add(const skitter::Herd& herd, const std::string& name);
  // Of a herd that is there. Throws Error(input) where it shares pages and has no reserve.
  void remove(uint32_t number, const std::string& name);

 private:
  struct Entry {
    const skitter::Herd* herd = nullptr;  // none: it is gone
    std::vector<uint32_t> kinds = {};     // one a size
  };
  bool isShared(uint32_t kind) const;

  std::vector<Entry> herds_;
  uint32_t nextKind_ = 0;  // one that no herd has had
};

}  // namespace skitter::crowd
