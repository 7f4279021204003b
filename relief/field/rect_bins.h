// Rectangles sorted into the bins of a grid: which of many overlap with one.
#pragma once

#include <cstdint>
#include <vector>

#include "relief/shape.h"

namespace relief {

// Holds rectangles, which may be infinite. Immutable; every const function may be called from any number of threads at
// once.
class RectBins {
 public:
  RectBins() = default;
  explicit RectBins(std::vector<Rect> rects);

  // Calls visit(n) for every rectangle n that overlaps with `rect`, in ascending order. A small `rect` costs as much as there
  // are rectangles near it, and those that cover much of all.
  template <class Visit>
  void visit(const Rect& rect, const Visit& visit_one) const {
    std::vector<std::uint32_t> gathered;
    for (const std::uint32_t n : candidates(rect, gathered))
      if (overlap(rects_[n], rect)) visit_one(static_cast<std::size_t>(n));
  }

 private:
  struct Span {
    int first = 0;
    int last = -1;
  };
  Span columns(const Rect& rect) const;
  Span rows(const Rect& rect) const;
  // Returns a list in ascending order that holds all that overlap: one of a bin, or `gathered`.
  const std::vector<std::uint32_t>& candidates(const Rect& rect, std::vector<std::uint32_t>& gathered) const;

  std::vector<Rect> rects_;
  int side_ = 0;  // bins on a side
  Rect area_;
  std::vector<std::vector<std::uint32_t>> bins_;
  std::vector<std::uint32_t> wide_;  // in too many bins to be put into them
  std::vector<std::uint32_t> all_;
};

}  // namespace relief
