// Values at crossings of the lines of a face's grid.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace paging {

// Crossing of two lines of a face's grid.
struct Crossing {
  std::int64_t i = 0;
  std::int64_t j = 0;
  bool operator==(const Crossing&) const = default;
};

// Maps crossings to values: an array where they lie side by side, as those of a finest tile do, else a hash table.
//
// Typical usage:
//   CrossingMap<double> heights(crossings, 1);  // and those beside them
//   if (double* height = heights.add({3, 4})) *height = 17;
//   const double* found = heights.find({3, 4});
template <class Value>
class CrossingMap {
 public:
  CrossingMap() = default;

  // Makes an empty map for crossings within `margin` lines of the given ones.
  CrossingMap(std::span<const Crossing> crossings, std::int64_t margin) {
    if (crossings.empty()) return;
    Crossing low{std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::max()};
    Crossing high{std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::min()};
    for (const Crossing& c : crossings) {
      low = {std::min(low.i, c.i), std::min(low.j, c.j)};
      high = {std::max(high.i, c.i), std::max(high.j, c.j)};
    }
    low_ = {low.i - margin, low.j - margin};
    columns_ = high.i - low.i + 1 + 2 * margin;
    const std::int64_t rows = high.j - low.j + 1 + 2 * margin;
    constexpr std::int64_t kMostCells = 1 << 20;
    constexpr std::int64_t kCellsEach = 16;
    constexpr std::int64_t kFewCells = 4096;
    is_dense_ = columns_ <= kMostCells && rows <= kMostCells &&
                columns_ * rows <=
                    std::min<std::int64_t>(
                        kMostCells, kFewCells + kCellsEach * static_cast<std::int64_t>(crossings.size()));
    if (!is_dense_) return;
    values_.resize(static_cast<std::size_t>(columns_ * rows));
    is_there_.resize(values_.size());
  }

  // Returns the new value, or null if there is one already.
  Value* add(const Crossing& at) {
    if (!is_dense_) {
      const auto [entry, is_new] = table_.try_emplace(at);
      return is_new ? &entry->second : nullptr;
    }
    const std::size_t n = cell(at);
    if (is_there_[n] != 0) return nullptr;
    is_there_[n] = 1;
    return &values_[n];
  }

  // Returns the value, or null if there is none.
  const Value* find(const Crossing& at) const {
    if (!is_dense_) {
      const auto entry = table_.find(at);
      return entry == table_.end() ? nullptr : &entry->second;
    }
    const std::size_t n = cell(at);
    return is_there_[n] != 0 ? &values_[n] : nullptr;
  }
  Value* find(const Crossing& at) { return const_cast<Value*>(std::as_const(*this).find(at)); }

 private:
  struct Hash {
    std::size_t operator()(const Crossing& c) const {
      return static_cast<std::size_t>(static_cast<std::uint64_t>(c.i) * 0x9e3779b97f4a7c15ULL +
                                      static_cast<std::uint64_t>(c.j));
    }
  };

  std::size_t cell(const Crossing& at) const {
    return static_cast<std::size_t>((at.j - low_.j) * columns_ + at.i - low_.i);
  }

  bool is_dense_ = false;
  Crossing low_;
  std::int64_t columns_ = 0;
  std::vector<Value> values_;
  std::vector<char> is_there_;
  std::unordered_map<Crossing, Value, Hash> table_;
};

}  // namespace paging
