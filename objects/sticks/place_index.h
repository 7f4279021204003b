// A table from places in a grid of voxels to numbers, which count up in the order in which places are added.
//
// Typical usage:
//   PlaceIndex index;
//   const std::uint32_t n = index.add(voxels.place(x, y, z));
//   if (n == sums.size()) sums.emplace_back();  // a new place
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace objects {

class PlaceIndex {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  std::size_t size() const { return places_.size(); }
  const std::vector<std::uint64_t>& places() const { return places_; }  // of numbers

  // Returns the number of a place, or kNone.
  std::uint32_t find(std::uint64_t place) const { return slots_.empty() ? kNone : slots_[slot_of(place)]; }

  // Returns the number of a place, the next one if it is new.
  std::uint32_t add(std::uint64_t place) {
    if (2 * places_.size() >= slots_.size()) grow();
    std::uint32_t& slot = slots_[slot_of(place)];
    if (slot == kNone) {
      slot = static_cast<std::uint32_t>(places_.size());
      places_.push_back(place);
    }
    return slot;
  }

 private:
  std::size_t slot_of(std::uint64_t place) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = (place * 0x9E3779B97F4A7C15ULL) >> (64 - std::countr_zero(slots_.size()));
    while (slots_[at] != kNone && places_[slots_[at]] != place) at = (at + 1) & mask;
    return at;
  }

  void grow() {
    slots_.assign(slots_.empty() ? 1024 : 2 * slots_.size(), kNone);
    for (std::uint32_t n = 0; n < places_.size(); ++n) slots_[slot_of(places_[n])] = n;
  }

  std::vector<std::uint32_t> slots_;  // a power of two of them
  std::vector<std::uint64_t> places_;
};

}  // namespace objects
