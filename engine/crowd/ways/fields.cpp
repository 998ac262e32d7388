#include "crowd/ways/fields.h"

#include <algorithm>
#include <bit>
#include <cassert>
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
  gather_ =
      gpu::Kernel(context, {"way_gather",
                            embedded::way_gather_comp(),
                            {{BINDING_WAY_COST, store}, {BINDING_WAY_TIME, store}, {BINDING_WAY_OUT, store}},
                            sizeof(WayConstants)});
  setGrid(std::move(grid));
}

void WayFields::setGrid(CostGrid grid) {
  const bool isAlike = grid.columns == grid_.columns && grid.rows == grid_.rows;
  const std::vector<float> crossings = std::exchange(crossings_, crossingsOf(grid));
  grid_ = std::move(grid);
  regions_ = regionsOf(grid_);
  if (!isAlike) makeRoom(std::max(room_, 1u));
  gpu::upload(*context_, costs_, crossings_);
  std::vector<size_t> changed, anew;
  std::vector<float> before;
  for (size_t cell = 0; isAlike && cell < crossings_.size(); ++cell) {
    if (crossings[cell] == crossings_[cell]) continue;
    changed.push_back(cell);
    before.push_back(crossings[cell]);
  }
  // Updates go over the fields one after the other, and solving goes over all of them at once.
  size_t left = cells() / 2;
  for (size_t k = 0; k < fields_.size(); ++k) {
    Stops stops = stopsOf(grid_, regions_, fields_[k].target);
    const FieldChange change{.columns = grid_.columns,
                             .rows = grid_.rows,
                             .crossings = crossings_,
                             .changed = changed,
                             .before = before,
                             .stopsBefore = fields_[k].stops,
                             .stops = stops};
    std::optional<size_t> done;
    if (isAlike && changed.size() < left) done = update(k, change, left);
    if (!done) anew.push_back(k);
    left = done ? left - *done : 0;
    fields_[k].stops = std::move(stops);
  }
  solve(anew);
}

std::optional<size_t> WayFields::update(size_t field, const FieldChange& change, size_t most) const {
  std::vector<float> updated = times(fields_[field].target);
  const std::optional<FieldUpdate> done = updateField(change, most, updated);
  if (!done) return {};
  if (done->cells == 0) return 0;
  const size_t first = size_t{done->firstRow} * grid_.columns, count = size_t{done->rows} * grid_.columns;
  gpu::uploadBytes(*context_, times_, std::as_bytes(std::span(updated).subspan(first, count)),
                   (field * cells() + first) * sizeof(float));
  // Records have the times of the row beyond, too.
  const uint32_t below = done->firstRow > 0 ? 1 : 0;
  gather({&field, 1}, done->firstRow - below, done->rows + below);
  return done->cells;
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
    gpu::upload(*context_, costs_, crossings_);
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

std::vector<glm::vec4> WayFields::timesAround(const glm::vec2& target) const {
  std::vector<glm::vec4> of(cells());
  gpu::downloadBytes(*context_, records_, std::as_writable_bytes(std::span(of)),
                     (shared::WAY_TIMES + indexOf(target) * cells()) * vec4Bytes);
  return of;
}

size_t WayFields::indexOf(const glm::vec2& target) const {
  return static_cast<size_t>(std::ranges::find(fields_, target, &Field::target) - fields_.begin());
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
  gatherBindings_ = gather_.bind(
      context, {{BINDING_WAY_COST, &costs_}, {BINDING_WAY_TIME, &times_}, {BINDING_WAY_OUT, &records_}});
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
  solved_ += static_cast<uint32_t>(fields.size());
  for (const size_t field : fields) {
    std::vector<float> times(cells(), shared::WAY_FAR);
    for (const auto& [cell, time] : fields_[field].stops.cells) times[cell] = time;
    gpu::uploadBytes(context, times_, std::as_bytes(std::span(times)), field * times.size() * sizeof(float));
  }
  for (const uint32_t inside : {0u, 1u}) {
    const shared::WayConstants constants{
        .columns = grid_.columns, .rows = grid_.rows, .first = 0, .inside = inside, .from = 0, .beside = 0};
    std::vector<uint32_t> states(shared::MOST_WAYS, 0);
    for (const size_t field : fields) states[field] = 1;
    gpu::upload(context, states_, states);
    while (std::ranges::find(states, 1u) != states.end()) {
      gpu::submitAndWait(context, [&](vk::CommandBuffer cmd) {
        solve_.dispatch(cmd, solveBindings_, gpu::bytesOf(constants), static_cast<uint32_t>(fields_.size()));
        gpu::allToAll(cmd);
      });
      states = gpu::download<uint32_t>(context, states_);
    }
  }
  gather(fields, 0, grid_.rows);
  uploadHeads();
}

void WayFields::gather(std::span<const size_t> fields, uint32_t firstRow, uint32_t rows) const {
  gpu::submitAndWait(*context_, [&](vk::CommandBuffer cmd) {
    for (const size_t field : fields) {
      const bool leadsOut = fields_[field].target == glm::vec2(shared::WAY_OUT);
      const shared::WayConstants constants{.columns = grid_.columns,
                                           .rows = grid_.rows,
                                           .first = static_cast<uint32_t>(field),
                                           .inside = 0,
                                           .from = firstRow * grid_.columns,
                                           .beside = leadsOut ? 0 : shared::WAY_BESIDE * grid_.cell};
      gather_.dispatch(cmd, gatherBindings_, gpu::bytesOf(constants),
                       gpu::groupsFor(rows * grid_.columns, shared::WAY_GROUP));
    }
    gpu::allToAll(cmd);
  });
}

}  // namespace skitter::crowd
