#include "vpe/voxel/cast/sector_batch.h"

namespace vpe::voxel {

ColumnBatch sector_batch(const SectorPlan& plan, const ViewSector& sector, const SectorPlan::Window& window,
                         std::vector<float>& samples) {
  const std::size_t needed = static_cast<std::size_t>(sector.steps) * static_cast<std::size_t>(sector.lines);
  if (samples.size() < needed) samples.resize(needed);
  const int stop = sector.rising ? window.end_step : sector.steps - window.first_step;
  ColumnBatch batch;
  batch.rows.kind = RowKind::kSector;
  batch.rows.count = sector.steps;
  batch.columns = window.end_line - window.first_line;
  // Samples are stored by step.
  batch.stride = sector.rising ? sector.lines : -static_cast<std::ptrdiff_t>(sector.lines);
  batch.out = samples.data() + window.first_line +
              (sector.rising ? 0 : std::ptrdiff_t{sector.lines} * (sector.steps - 1));
  batch.set_column = [&plan, &sector, first = window.first_line, stop](int column, ColumnGroup& group, int lane,
                                                                       glm::dvec3& azimuth) {
    const SectorLine line = plan.line(sector, first + column);
    azimuth = line.azimuth;
    group.sector_a0[lane] = line.a0;
    group.sector_a1[lane] = line.a1;
    group.sector_b0[lane] = line.b0;
    group.sector_b1[lane] = line.b1;
    group.row[lane] = static_cast<float>(line.row_begin);
    group.row_end[lane] = static_cast<float>(line.row_end);
    group.row_stop[lane] = static_cast<float>(stop);
  };
  return batch;
}

}  // namespace vpe::voxel
