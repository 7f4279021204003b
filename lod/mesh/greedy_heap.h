// A priority queue of the worst post of each triangle. Internal to lod.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lod {

// A post with its distance from the triangle over it; error 0: none.
struct WorstPost {
  double geometric_error_m = 0;
  std::uint32_t post = 0;
};

struct QueuedPost {
  double geometric_error_m = 0;
  std::uint32_t post = 0;
  int face = 0;
};

// A binary heap with at most one entry for each face, ordered by error, then by lowest post.
class PostQueue {
 public:
  void clear() {
    heap_.clear();
    place_.clear();
  }
  bool empty() const { return heap_.empty(); }
  const QueuedPost& top() const { return heap_.front(); }

  // Replaces the face's entry, or removes it if the error is within the tolerance.
  void set(int face, const WorstPost& worst, double tolerance_m) {
    const auto f = static_cast<std::size_t>(face);
    if (f >= place_.size()) place_.resize(f + 1, kNone);
    std::size_t at = place_[f];
    if (worst.geometric_error_m > tolerance_m) {
      const QueuedPost entry{worst.geometric_error_m, worst.post, face};
      if (at == kNone) {
        at = heap_.size();
        heap_.push_back(entry);
      }
      settle(at, entry);
    } else if (at != kNone) {
      place_[f] = kNone;
      const QueuedPost last = heap_.back();
      heap_.pop_back();
      if (at < heap_.size()) settle(at, last);
    }
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  static bool before(const QueuedPost& a, const QueuedPost& b) {
    return (a.geometric_error_m > b.geometric_error_m) |
           ((a.geometric_error_m == b.geometric_error_m) & (a.post < b.post));
  }

  void put(std::size_t at, const QueuedPost& entry) {
    heap_[at] = entry;
    place_[static_cast<std::size_t>(entry.face)] = static_cast<std::uint32_t>(at);
  }

  // Writes the entry into the free slot `at` and restores the heap.
  void settle(std::size_t at, const QueuedPost& entry) {
    while (at > 0 && before(entry, heap_[(at - 1) / 2])) {
      put(at, heap_[(at - 1) / 2]);
      at = (at - 1) / 2;
    }
    for (std::size_t below = 2 * at + 1; below < heap_.size(); below = 2 * at + 1) {
      const std::size_t other = std::min(below + 1, heap_.size() - 1);
      below += static_cast<std::size_t>(before(heap_[other], heap_[below]));
      if (!before(heap_[below], entry)) break;
      put(at, heap_[below]);
      at = below;
    }
    put(at, entry);
  }

  std::vector<QueuedPost> heap_;
  std::vector<std::uint32_t> place_;
};

}  // namespace lod
