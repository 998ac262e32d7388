#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "crowd/ways/field_update.h"
#include "crowd/ways/stops.h"
#include "gpu/buffer.h"
#include "gpu/kernel.h"
#include "shared/ways.h"
#include "skitter/ways.h"

namespace skitter::crowd {

// A cost grid and the fields of some goals on the device (docs/ways.md). What changes them waits for the
// device.
class WayFields {
 public:
  // Without goals.
  WayFields(const gpu::Context& context, CostGrid grid);

  // Fields follow where costs have changed; where that is too much, they are solved anew, with the same bits.
  void setGrid(CostGrid grid);
  // Solves fields of `targets`, of which none has one and all are finite: at most shared::MOST_WAYS less
  // those in `kept`. Fields of goals that are not in `kept` may be dropped.
  void add(std::span<const glm::vec2> targets, std::span<const glm::vec2> kept);
  // The field of a goal becomes that of another; where `from` has none, nothing happens.
  void move(const glm::vec2& from, const glm::vec2& to);
  // Places of goals in series, at most shared::MOST_PLACES.
  void setPlaces(std::vector<glm::vec4> places);
  const std::vector<glm::vec4>& places() const { return places_; }
  // Those that add() did not drop.
  std::vector<glm::vec2> goals() const;
  bool has(const glm::vec2& target) const;

  const CostGrid& grid() const { return grid_; }
  const Regions& regions() const { return regions_; }
  // Stops of a goal that has a field.
  const Stops& stopsAt(const glm::vec2& target) const;
  // BINDING_WAY; another buffer whenever moves() is another number.
  const gpu::Buffer& records() const { return records_; }
  // Counts changes of any kind.
  uint32_t revision() const { return revision_; }
  uint32_t moves() const { return moves_; }
  uint64_t memoryBytes() const { return costs_.size() + times_.size() + states_.size() + records_.size(); }
  // Counts fields that were solved, and not updated.
  uint32_t solved() const { return solved_; }
  // Times at the middles of the cells, of a goal that has a field.
  std::vector<float> times(const glm::vec2& target) const;
  // For each cell those of the four middles from it on, as agents between them go by (WAY_TIMES).
  std::vector<glm::vec4> timesAround(const glm::vec2& target) const;

 private:
  struct Field {
    glm::vec2 target;
    Stops stops;
  };
  size_t cells() const { return grid_.cost.size(); }
  size_t indexOf(const glm::vec2& target) const;
  void makeRoom(uint32_t fields);
  void uploadHeads() const;
  // How many of its times were looked at anew; none where that would be more than `most`.
  std::optional<size_t> update(size_t field, const FieldChange& change, size_t most) const;
  void solve(std::span<const size_t> fields);
  void gather(std::span<const size_t> fields, uint32_t firstRow, uint32_t rows) const;

  const gpu::Context* context_;
  CostGrid grid_;
  Regions regions_;
  std::vector<Field> fields_;
  std::vector<glm::vec4> places_;  // as WAY_PLACES
  std::vector<float> crossings_;   // of the grid's cells
  uint32_t room_ = 0, revision_ = 0, moves_ = 0, solved_ = 0;
  gpu::Buffer costs_, times_, states_, records_;
  gpu::Kernel solve_, gather_;
  gpu::Bindings solveBindings_, gatherBindings_;
};

}  // namespace skitter::crowd
