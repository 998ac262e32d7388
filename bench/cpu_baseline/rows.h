#pragma once

#include <cstddef>
#include <new>
#include <type_traits>
#include <vector>

namespace skitter::baseline {

// `rows` floats a chain, for many chains. Blocks of 16 chains follow each other; in a block the 16 values of
// a row lie side by side. So a register of chains is loaded at once, a block's rows share pages and streams,
// and no power of two between rows makes them fight for the same cache sets.
class Rows {
 public:
  static constexpr size_t kBlock = 16;
  static constexpr size_t kGroup =
      64;  // chains are padded to a multiple: the most that a solver takes at once

  Rows() = default;
  Rows(int rows, size_t chains) : rows_(rows), values_(rows * ((chains + kGroup - 1) / kGroup) * kGroup) {}

  int rows() const { return rows_; }
  float& at(int row, size_t chain) { return values_[index(row, chain)]; }
  float at(int row, size_t chain) const { return values_[index(row, chain)]; }

  // `chain` is the first chain, a multiple of V's width.
  template <class V>
  void load(V& values, int row, size_t chain) const {
    forEachPart(values, [&](auto& part, size_t offset) {
      part = *reinterpret_cast<const std::remove_reference_t<decltype(part)>*>(
          &values_[index(row, chain + offset)]);
    });
  }
  template <class V>
  void store(const V& values, int row, size_t chain) {
    forEachPart(values, [&](auto& part, size_t offset) {
      *reinterpret_cast<std::remove_cvref_t<decltype(part)>*>(&values_[index(row, chain + offset)]) = part;
    });
  }

 private:
  template <class T>
  struct CacheLines {
    using value_type = T;
    CacheLines() = default;
    template <class U>
    CacheLines(const CacheLines<U>&) {}
    T* allocate(size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(64))); }
    void deallocate(T* p, size_t) { ::operator delete(p, std::align_val_t(64)); }
    bool operator==(const CacheLines&) const { return true; }
  };

  size_t index(int row, size_t chain) const {
    return (chain / kBlock * rows_ + row) * kBlock + chain % kBlock;
  }
  static void forEachPart(auto& values, const auto& visit, size_t offset = 0) {
    if constexpr (
        requires { values.a.v; } || requires { values.a.a; }) {
      forEachPart(values.a, visit, offset);
      forEachPart(values.b, visit, offset + sizeof(values.a) / sizeof(float));
    } else {
      visit(values, offset);
    }
  }

  int rows_ = 0;
  std::vector<float, CacheLines<float>> values_;
};

}  // namespace skitter::baseline
