#include "crowd/ways/fields.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include "embedded/way_gather_comp.h"
#include "embedded/way_solve_comp.h"
#include "gpu/barrier.h"
#include "gpu/context.h"
#include "gpu/submit.h"
#include "gpu/transfer.h"

namespace skitter::crowd {
namespace {

constexpr uint64_t vec4Bytes = 16;

bool contains(std::span<const glm::vec2> list, const glm::vec2& target) {
  return std::ranges::find(list, target) != list.end();
}

}  // namespace

WayFields::WayFields(const gpu::Context& context, CostGrid grid) : context_(&context) {
  using namespace shared;
  using enum gpu::BindingKind;
  solve_ = gpu::Kernel(context,
                       {"way_solve",
                        embedded::way_solve_comp(),
                        {{BINDING_WAY_COST, store}, {BINDING_WAY_TIME, store}, {BINDING_WAY_STATE, store}},
                        sizeof(WayConstants)});
  gather_ = gpu::Kernel(context, {"way_gather",
                                  embedded::way_gather_comp(),
                                  {{BINDING_WAY_TIME, store}, {BINDING_WAY_OUT, store}},
                                  sizeof(WayConstants)});
  setGrid(std::move(grid));
}

void WayFields::setGrid(CostGrid grid) {
  const bool isAsLarge = grid.cost.size() == grid_.cost.size();
  grid_ = std::move(grid);
  regions_ = regionsOf(grid_);
  if (!isAsLarge) makeRoom(std::max(room_, 1u));
  uploadCosts();
  for (Field& field : fields_) field.stops = stopsOf(grid_, regions_, field.target);
  std::vector<size_t> all(fields_.size());
  std::iota(all.begin(), all.end(), size_t{0});
  solve(all);
}

void WayFields::add(std::span<const glm::vec2> targets, std::span<const glm::vec2> kept) {
  std::vector<size_t> fresh;
  for (const glm::vec2& target : targets) {
    Field field{target, stopsOf(grid_, regions_, target)};
    if (fields_.size() < shared::MOST_WAYS) {
      fresh.push_back(fields_.size());
      fields_.push_back(std::move(field));
      continue;
    }
    const auto unused = std::ranges::find_if(fields_, [&](const Field& each) {
      return !contains(kept, each.target) && !contains(targets, each.target);
    });
    assert(unused != fields_.end());
    fresh.push_back(static_cast<size_t>(unused - fields_.begin()));
    *unused = std::move(field);
  }
  if (fields_.size() > room_) {
    makeRoom(std::bit_ceil(static_cast<uint32_t>(fields_.size())));
    uploadCosts();
    fresh.resize(fields_.size());
    std::iota(fresh.begin(), fresh.end(), size_t{0});
  }
  solve(fresh);
}

void WayFields::move(const glm::vec2& from, const glm::vec2& to) {
  const size_t field = indexOf(from);
  if (field == fields_.size()) return;
  fields_[field] = {to, stopsOf(grid_, regions_, to)};
  solve({&field, 1});
}

void WayFields::setPlaces(std::vector<glm::vec4> places) {
  places_ = std::move(places);
  ++revision_;
  uploadHeads();
}

std::vector<glm::vec2> WayFields::goals() const {
  std::vector<glm::vec2> all;
  for (const Field& field : fields_) all.push_back(field.target);
  return all;
}

bool WayFields::has(const glm::vec2& target) const { return indexOf(target) < fields_.size(); }

const Stops& WayFields::stopsAt(const glm::vec2& target) const { return fields_.at(indexOf(target)).stops; }

std::vector<float> WayFields::times(const glm::vec2& target) const {
  std::vector<float> of(cells());
  gpu::downloadBytes(*context_, times_, std::as_writable_bytes(std::span(of)),
                     indexOf(target) * cells() * sizeof(float));
  return of;
}

size_t WayFields::indexOf(const glm::vec2& target) const {
  return static_cast<size_t>(std::ranges::find(fields_, target, &Field::target) - fields_.begin());
}

shared::WayConstants WayFields::constantsOf(size_t first, bool inside) const {
  return {.columns = grid_.columns,
          .rows = grid_.rows,
          .first = static_cast<uint32_t>(first),
          .inside = inside ? 1u : 0u};
}

void WayFields::makeRoom(uint32_t fields) {
  using namespace shared;
  const gpu::Context& context = *context_;
  room_ = fields;
  ++moves_;
  costs_ = gpu::Buffer(context, cells() * sizeof(float), "way costs");
  times_ = gpu::Buffer(context, room_ * cells() * sizeof(float), "way times");
  states_ = gpu::Buffer(context, MOST_WAYS * sizeof(uint32_t), "way states");
  records_ = gpu::Buffer(context, (WAY_TIMES + room_ * cells()) * vec4Bytes, "ways");
  gpu::clear(context, records_);
  solveBindings_ = solve_.bind(
      context, {{BINDING_WAY_COST, &costs_}, {BINDING_WAY_TIME, &times_}, {BINDING_WAY_STATE, &states_}});
  gatherBindings_ = gather_.bind(context, {{BINDING_WAY_TIME, &times_}, {BINDING_WAY_OUT, &records_}});
}

void WayFields::uploadCosts() const {
  std::vector<float> costs = grid_.cost;
  for (float& cost : costs) cost = grid_.cell * (std::isfinite(cost) ? cost : -shared::WAY_INSIDE_COST);
  gpu::upload(*context_, costs_, costs);
}

void WayFields::uploadHeads() const {
  std::vector<glm::vec4> heads(shared::WAY_TIMES, glm::vec4(0));
  heads[0] = {static_cast<float>(fields_.size()), static_cast<float>(grid_.columns),
              static_cast<float>(grid_.rows), grid_.cell};
  heads[1] = {grid_.origin, 0, 0};
  for (size_t k = 0; k < fields_.size(); ++k)
    heads[shared::WAY_HEADS + k] = {fields_[k].target, fields_[k].stops.stop};
  std::ranges::copy(places_, heads.begin() + shared::WAY_PLACES);
  gpu::upload(*context_, records_, heads);
}

void WayFields::solve(std::span<const size_t> fields) {
  const gpu::Context& context = *context_;
  ++revision_;
  for (const size_t field : fields) {
    std::vector<float> times(cells(), shared::WAY_FAR);
    for (const auto& [cell, time] : fields_[field].stops.cells) times[cell] = time;
    gpu::uploadBytes(context, times_, std::as_bytes(std::span(times)), field * times.size() * sizeof(float));
  }
  for (const bool inside : {false, true}) {
    std::vector<uint32_t> states(shared::MOST_WAYS, 0);
    for (const size_t field : fields) states[field] = 1;
    gpu::upload(context, states_, states);
    while (std::ranges::find(states, 1u) != states.end()) {
      gpu::submitAndWait(context, [&](vk::CommandBuffer cmd) {
        solve_.dispatch(cmd, solveBindings_, gpu::bytesOf(constantsOf(0, inside)),
                        static_cast<uint32_t>(fields_.size()));
        gpu::allToAll(cmd);
      });
      states = gpu::download<uint32_t>(context, states_);
    }
  }
  gpu::submitAndWait(context, [&](vk::CommandBuffer cmd) {
    for (const size_t field : fields)
      gather_.dispatch(cmd, gatherBindings_, gpu::bytesOf(constantsOf(field, false)),
                       gpu::groupsFor(static_cast<uint32_t>(cells()), shared::WAY_GROUP));
    gpu::allToAll(cmd);
  });
  uploadHeads();
}

}  // namespace skitter::crowd
