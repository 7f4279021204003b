// Sheets of columns, cast by several threads.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/voxel/cast/column_walk.h"

namespace vpe::voxel {

// Columns side by side that share their rows, and where their ranges go.
struct ColumnBatch {
  Rows rows;
  int columns = 0;
  float* out = nullptr;       // of row 0, column 0
  std::ptrdiff_t stride = 0;  // floats from a row to the next
  bool stream = false;        // see copy_rows()
  // Sets a column's azimuth, its rows [row, row_end), and its part of a fan. Only these rows are written, and
  // those of the columns beside it.
  std::function<void(int column, ColumnGroup& group, int lane, glm::dvec3& azimuth)> set_column;
};

// What a thread works with while an image is cast.
struct Scratch;

class ScratchPool {
 public:
  ScratchPool(const HeightGridStore& store, double exaggeration);
  ~ScratchPool();
  ScratchPool(const ScratchPool&) = delete;
  ScratchPool& operator=(const ScratchPool&) = delete;

  // A desk for as long as this lives. Not handed on when it is left by an exception.
  class Use {
   public:
    explicit Use(ScratchPool& scratches);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    ThreadLocalTiles& tiles() const;
    Scratch& scratch() const { return *scratch_; }

   private:
    ScratchPool& scratches_;
    int thrown_;
    std::unique_ptr<Scratch> scratch_;
  };

 private:
  const HeightGridStore& store_;
  double exaggeration_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Scratch>> free_;
};

// Columns of different sheets are cast side by side. Throws paging::PlanetError for tiles that cannot be read.
void cast_columns(std::span<const ColumnBatch> batches, const ColumnWalk& walk, ScratchPool& scratches,
                  base::ThreadPool& pool);

}  // namespace vpe::voxel
