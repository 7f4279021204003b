#include "vpe/voxel/cast/column_batch.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>

namespace vpe::voxel {

namespace {

// Returns how many columns lie before a row's first whole cache line, where all rows begin alike and are written past the
// caches. Lines that are written in two parts take several times as long.
int unaligned_columns(const ColumnBatch& batch) {
  constexpr std::size_t kLine = 64;
  if (!batch.stream || static_cast<std::size_t>(std::abs(batch.stride)) * sizeof(float) % kLine != 0) return 0;
  const std::size_t past = reinterpret_cast<std::uintptr_t>(batch.out) % kLine;
  return static_cast<int>((kLine - past) % kLine / sizeof(float));
}

}  // namespace

void Scratch::prepare(int rows, int group_count) {
  const auto count = static_cast<std::size_t>(rows);
  if (count <= prepared_rows) return;
  prepared_rows = count;
  const auto used = static_cast<std::size_t>(group_count);
  // Where half of the lanes are used, a row's start and gain are one cache line.
  const bool is_half = column_lanes() <= kMaxLanes / 2;
  const std::size_t per_group = is_half ? count + 1 : 2 * (count + 1);
  buffers.assign(per_group * used, LaneFloats{});
  for (std::size_t g = 0; g < used; ++g) {
    groups[g].start = buffers[g * per_group].lane;
    groups[g].gain = groups[g].start + kMaxLanes / 2;
    if (!is_half) groups[g].gain = buffers[g * per_group + count + 1].lane;
    if (value_step() == 2) groups[g].gain = groups[g].start + 1;
  }
}

ScratchPool make_scratch_pool(const HeightGridStore& store, double exaggeration, TileFallbacks* fallbacks) {
  return ScratchPool(
      [&store, exaggeration, fallbacks] { return std::make_unique<Scratch>(store, exaggeration, fallbacks); },
      {.discard_on_exception = true});
}

void cast_columns(std::span<const ColumnBatch> batches, const ColumnWalk& walk, ScratchPool& scratches,
                  base::ThreadPool& pool) {
  const int lanes = column_lanes();
  const int task_columns = std::min(kBatchTaskColumns, lanes * kMostGroups);
  struct Task {
    const ColumnBatch* batch;
    int begin;
    int columns;
  };
  std::vector<Task> tasks;
  int most_rows = 0;
  for (const ColumnBatch& batch : batches) {
    most_rows = std::max(most_rows, batch.rows.count);
    const int first = std::min(unaligned_columns(batch), batch.columns);
    if (first > 0) tasks.push_back({&batch, 0, first});
    for (int begin = first; begin < batch.columns; begin += task_columns)
      tasks.push_back({&batch, begin, std::min(task_columns, batch.columns - begin)});
  }
  pool.run(tasks.size(), [&](std::size_t t) {
    const ScratchPool::Lease scratch = scratches.acquire();
    scratch->prepare(most_rows, task_columns / lanes);
    const ColumnBatch& batch = *tasks[t].batch;
    const int begin = tasks[t].begin;
    const int columns = tasks[t].columns;
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
        group.row_stop[lane] = static_cast<float>(batch.rows.count);
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
    const int begin_row = static_cast<int>(lowest);
    const int end_row = static_cast<int>(highest);
    float ground = lowest;  // all rows from here on are sky
    for (int g = 0; g < groups; ++g) {
      const ColumnGroup& group = scratch->groups[static_cast<std::size_t>(g)];
      ground = std::max(ground, *std::max_element(group.row, group.row + group.columns));
    }
    const int sky_row = std::clamp(static_cast<int>(ground), begin_row, end_row);
    std::fill_n(scratch->block[0].lane, task_columns, std::numeric_limits<float>::infinity());
    copy_rows(scratch->block[0].lane, 0, batch.out + sky_row * batch.stride + begin, batch.stride, columns,
              end_row - sky_row, batch.stream);
    for (int end = sky_row; end > begin_row; end -= kBlockRows) {
      const int row = std::max(begin_row, end - kBlockRows);
      const int rows = end - row;
      for (int g = 0; g < groups; ++g)
        expand_rows(batch.rows, scratch->groups[static_cast<std::size_t>(g)], row, row + rows,
                    scratch->block[0].lane + g * lanes, task_columns);
      copy_rows(scratch->block[0].lane, task_columns, batch.out + row * batch.stride + begin, batch.stride,
                columns, rows, batch.stream);
    }
  });
}

}  // namespace vpe::voxel
