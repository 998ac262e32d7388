#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/kernel.h"
#include "shared/forage.h"
#include "skitter/crowd.h"
#include "skitter/forage.h"
#include "skitter/ways.h"

namespace skitter::crowd {

struct Kind;
struct Page;

// Whole numbers that foragers go by (docs/foraging.md).
struct ForageNumbers {
  uint32_t threshold, layHome, layOut;  // grains

  // 2^32 times the chance to leave the nest in a tick of `dt` seconds.
  static uint32_t leaveOf(const Forage& forage, double dt);
  // Ticks from one evaporation to the next, and 2^32 times the share that goes.
  static uint64_t everyOf(double dt);
  static uint32_t evaporationOf(const Forage& forage, double dt);
};
ForageNumbers numbersOf(const Forage& forage);

// The ground and pheromone of a colony on the device: of the herds of a kind that forage.
class Trails {
 public:
  // Without pheromone. The grid's cells are whole quanta, as cellOf makes them.
  // `levels`: agents have rates of their own.
  Trails(const gpu::Context& context, const Forage& forage, uint64_t seed, const CostGrid& grid, bool levels);

  // Metres a side of the cells over a terrain of that longer side.
  static float cellOf(const Forage& forage, float longestSide);

  // Other ground, with as many cells; the trail stays. Waits for the device.
  void setGrid(const CostGrid& grid);
  // Where a page's foragers lay. No tick pays for the translation to machine code after that.
  void bind(Page& page) const;
  // Their deeds in tick `tick` go into the trail, which evaporates, with barriers in front and behind.
  void record(vk::CommandBuffer cmd, std::span<const Page> pages, uint64_t tick, float dt) const;

  const Forage& forage() const { return forage_; }
  uint64_t seed() const { return seed_; }
  uint32_t revision() const { return revision_; }  // counts changes of the grid
  const CostGrid& grid() const { return grid_; }
  const gpu::Buffer& ground() const { return ground_; }  // BINDING_FORAGE_GROUND
  const gpu::Buffer& trail() const { return trail_; }    // BINDING_TRAIL
  uint64_t bytes() const { return trail_.size(); }
  uint64_t memoryBytes() const { return ground_.size() + trail_.size(); }
  // The ground, and the trail as the last tick left it. They wait for the device.
  std::vector<uint32_t> groundWords() const;
  std::vector<uint32_t> trailWords() const;

 private:
  const gpu::Context* context_;
  Forage forage_;
  uint64_t seed_;
  uint32_t revision_ = 0;
  CostGrid grid_;
  gpu::Buffer ground_, trail_;
  gpu::Kernel lay_, fade_;
  gpu::Bindings faded_;
};

// The trails of a kind whose herds forage, before its pages are made; else nothing.
void beginTrails(Crowd::Impl& crowd, uint32_t kind);
// Where the kind's pages lay, once they are made.
void bindTrails(const Crowd::Impl& crowd, Kind& kind);
// All kinds' trails, after navigate.
void recordTrails(const Crowd::Impl& crowd, vk::CommandBuffer cmd);
// The grounds of all trails, as the heights are now.
void renewTrails(Crowd::Impl& crowd);
bool forages(const Crowd::Impl& crowd);
// Bytes of the trail that a kind has or will have.
uint64_t bytesOfTrail(const Crowd::Impl& crowd, const Kind& kind);

}  // namespace skitter::crowd
