#include "vpe/voxel/cast/column_batch.h"

#include <algorithm>
#include <array>
#include <exception>

namespace vpe::voxel {

namespace {

// Neighbouring columns that one thread casts in turn: whole cache lines of a row. Narrow vectors take fewer.
constexpr int kTaskColumns = 96;
constexpr int kMostGroups = 12;
// Rows that are expanded before they are copied: few, so that neighbouring groups write to the same pages of
// memory.
constexpr int kBlockRows = 32;

struct alignas(64) LaneFloats {
  float lane[kMaxLanes];
};

}  // namespace

struct Scratch {
  Scratch(const HeightGridStore& store, double exaggeration) : tiles(store, exaggeration) {}

  // Buffers for so many rows of each of `group_count` groups, the same number every time.
  void prepare(int rows, int group_count) {
    const auto count = static_cast<std::size_t>(rows);
    if (count <= prepared) return;
    prepared = count;
    const auto used = static_cast<std::size_t>(group_count);
    buffers.assign(2 * used * count, LaneFloats{});
    for (std::size_t g = 0; g < used; ++g) {
      groups[g].start = buffers[2 * g * count].lane;
      groups[g].gain = buffers[(2 * g + 1) * count].lane;
    }
  }

  ThreadLocalTiles tiles;
  std::size_t prepared = 0;
  std::vector<LaneFloats> buffers;  // zero between tasks
  std::array<ColumnGroup, kMostGroups> groups{};
  std::array<LaneFloats, static_cast<std::size_t>(kTaskColumns / kMaxLanes) * kBlockRows>
      block{};  // of expanded rows
};

ScratchPool::ScratchPool(const HeightGridStore& store, double exaggeration)
    : store_(store), exaggeration_(exaggeration) {}
ScratchPool::~ScratchPool() = default;

ScratchPool::Use::Use(ScratchPool& scratches) : scratches_(scratches), thrown_(std::uncaught_exceptions()) {
  const std::lock_guard lock(scratches_.mutex_);
  if (scratches_.free_.empty()) {
    scratch_ = std::make_unique<Scratch>(scratches_.store_, scratches_.exaggeration_);
  } else {
    scratch_ = std::move(scratches_.free_.back());
    scratches_.free_.pop_back();
  }
}

ScratchPool::Use::~Use() {
  if (std::uncaught_exceptions() != thrown_) return;
  const std::lock_guard lock(scratches_.mutex_);
  scratches_.free_.push_back(std::move(scratch_));
}

ThreadLocalTiles& ScratchPool::Use::tiles() const { return scratch_->tiles; }

void cast_columns(std::span<const ColumnBatch> batches, const ColumnWalk& walk, ScratchPool& scratches,
                  base::ThreadPool& pool) {
  const int lanes = column_lanes();
  const int task_columns = std::min(kTaskColumns, lanes * kMostGroups);
  struct Task {
    const ColumnBatch* batch;
    int begin;
  };
  std::vector<Task> tasks;
  int most_rows = 0;
  for (const ColumnBatch& batch : batches) {
    most_rows = std::max(most_rows, batch.rows.count);
    for (int begin = 0; begin < batch.columns; begin += task_columns) tasks.push_back({&batch, begin});
  }
  pool.run(tasks.size(), [&](std::size_t t) {
    const ScratchPool::Use use(scratches);
    Scratch* const scratch = &use.scratch();
    scratch->prepare(most_rows, task_columns / lanes);
    const ColumnBatch& batch = *tasks[t].batch;
    const int begin = tasks[t].begin;
    const int columns = std::min(task_columns, batch.columns - begin);
    int groups = 0;
    float lowest = static_cast<float>(batch.rows.count);
    float highest = 0;
    for (int first = 0; first < columns; first += lanes, ++groups) {
      ColumnGroup& group = scratch->groups[static_cast<std::size_t>(groups)];
      group.columns = std::min(lanes, columns - first);
      std::array<glm::dvec3, kMaxLanes> azimuth{};
      for (int lane = 0; lane < kMaxLanes; ++lane) {
        group.row[lane] = 0;
        group.row_end[lane] = 0;
        group.run_start[lane] = 1;
        group.run_gain[lane] = 0;
        group.run_slope[lane] = 0;
        if (lane >= group.columns) continue;
        batch.set_column(begin + first + lane, group, lane, azimuth[static_cast<std::size_t>(lane)]);
        lowest = std::min(lowest, group.row[lane]);
        highest = std::max(highest, group.row_end[lane]);
      }
      walk.cast(azimuth.data(), batch.rows, scratch->tiles, group);
    }
    const int end = static_cast<int>(highest);
    for (int row = static_cast<int>(lowest); row < end; row += kBlockRows) {
      const int rows = std::min(kBlockRows, end - row);
      for (int g = 0; g < groups; ++g)
        expand_rows(batch.rows, scratch->groups[static_cast<std::size_t>(g)], row, row + rows,
                    scratch->block[0].lane + g * lanes, task_columns);
      copy_rows(scratch->block[0].lane, task_columns, batch.out + row * batch.stride + begin, batch.stride,
                columns, rows, batch.stream);
    }
  });
}

}  // namespace vpe::voxel
