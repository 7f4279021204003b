// Which frames of a flight one run makes: `--frames` selects, `--part` divides what is selected.
#pragma once

#include <cstdint>
#include <string>

#include "vpe/app/planet/shard_option.h"

namespace vpe::app {

// Frames first, first + step, ... up to last.
struct FrameRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
  std::int64_t step = 1;

  std::int64_t count() const { return (last - first) / step + 1; }
  std::int64_t frame(std::int64_t n) const { return first + n * step; }
};

// "A-B", "A-BxN" or "A", both ends included, of a flight of `count` frames; all of them for an empty text.
// Throws UsageError.
FrameRange parse_frames(const std::string& text, std::int64_t count);

}  // namespace vpe::app
