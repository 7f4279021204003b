// Batches of columns, cast by several threads, and the scratch memory of these threads.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): RangeCaster describes an image, or SectorCaster each sector
// of it, as a ColumnBatch. cast_columns() cuts batches into tasks of neighbouring columns. A task sends groups
// of up to kMaxLanes columns over the planet (column_walk.h) and writes their ranges.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "vpe/base/object_pool.h"
#include "vpe/base/parallel.h"
#include "vpe/voxel/cast/column_walk.h"

namespace vpe::voxel {

// Describes columns side by side that share their rows, and the memory that their ranges go to.
struct ColumnBatch {
  Rows rows;
  int columns = 0;
  float* out = nullptr;       // range of row 0, column 0
  std::ptrdiff_t stride = 0;  // floats from a row to the next
  bool stream = false;        // writes past the caches (copy_rows())
  // Sets the azimuth of a column (unit, body-fixed), its rows [row, row_end) and, for RowKind::kSector, its
  // slope coefficients; and row_stop, which is otherwise the number of rows. Only these rows are written, and the
  // same rows of the columns of its task. Any thread calls it.
  std::function<void(int column, ColumnGroup& group, int lane, glm::dvec3& azimuth)> set_column;
};

// Neighbouring columns of a task: whole cache lines of a row. Narrow vector units take fewer.
inline constexpr int kBatchTaskColumns = 96;
inline constexpr int kMostGroups = 12;
// Rows that are expanded before they are copied. Few, so that neighbouring groups write to the same pages of
// memory.
inline constexpr int kBlockRows = 32;

// Holds the working memory of one thread while an image is cast.
struct Scratch {
  struct alignas(64) LaneFloats {
    float lane[kMaxLanes];
  };

  Scratch(const HeightGridStore& store, double exaggeration, TileFallbacks* fallbacks)
      : tiles(store, exaggeration, fallbacks) {}

  // Provides buffers of at least `rows` rows for each of `group_count` groups. `group_count` must be the same
  // in every call.
  void prepare(int rows, int group_count);

  ThreadLocalTiles tiles;
  std::size_t prepared_rows = 0;
  std::vector<LaneFloats> buffers;  // zero between tasks
  std::array<ColumnGroup, kMostGroups> groups{};
  std::array<LaneFloats, static_cast<std::size_t>(kBatchTaskColumns / kMaxLanes) * kBlockRows>
      block{};  // expanded rows
};

// Lends scratch memory to the threads of one image.
using ScratchPool = base::ObjectPool<Scratch>;

// Returns a pool for an image of this exaggeration. `store` and `fallbacks` must outlive it. Scratch memory that
// an exception has interrupted is discarded.
ScratchPool make_scratch_pool(const HeightGridStore& store, double exaggeration,
                              TileFallbacks* fallbacks = nullptr);

// Casts all columns of all batches; columns of different batches run side by side. Throws paging::PlanetError
// for tiles that cannot be read.
void cast_columns(std::span<const ColumnBatch> batches, const ColumnWalk& walk, ScratchPool& scratches,
                  base::ThreadPool& pool);

}  // namespace vpe::voxel
