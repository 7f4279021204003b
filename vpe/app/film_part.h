// Which frames of a flight one run makes: `--frames` selects, `--part` divides what is selected.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

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

// Part `number` (from 1) of `of`.
struct Part {
  std::int64_t number = 1;
  std::int64_t of = 1;

  // Which of `count` items are this part's: a block [begin, end); the blocks of all parts follow each other.
  std::int64_t begin(std::int64_t count) const;
  std::int64_t end(std::int64_t count) const;
};

// Value of an environment variable, null when it is not set.
using Environment = std::function<const char*(const char* name)>;

// "k/n", or "auto": from the variables of a SLURM array (SLURM_ARRAY_TASK_ID, _COUNT; _MIN, 0 when not set;
// _STEP, 1 when not set), else of Open MPI (OMPI_COMM_WORLD_RANK, _SIZE), of PMI (PMI_RANK, PMI_SIZE), of srun
// (SLURM_PROCID, SLURM_NTASKS), the first that is set. Throws UsageError.
Part parse_part(const std::string& text, const Environment& environment);

}  // namespace vpe::app
