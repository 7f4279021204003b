// Range pictures of S, cast column by column.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "paging/planet_file.h"
#include "paging/surface.h"
#include "vpe/core/parallel.h"
#include "vpe/core/view.h"
#include "vpe/voxel/columns.h"
#include "vpe/voxel/lattice_store.h"

namespace vpe::voxel {

class FanPlan;

// One caller at a time.
class RangeCaster {
 public:
  RangeCaster(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes);
  ~RangeCaster();

  // Ranges from the eye to S as exaggerated, metres, infinity for the sky, of the view's drawn part, row by row
  // from the top. Columns where the picture's own columns are vertical planes (round pictures of a level eye),
  // else a ray a pixel. Does not depend on the number of threads nor on what was cast before. Throws
  // paging::PlanetError for tiles that cannot be read.
  void cast(const core::View& view, double exaggeration, core::ThreadPool& pool, std::span<float> range_m);

  const paging::Surface& surface() const { return surface_; }
  std::size_t bytes_resident() const { return surface_.bytes_resident() + store_.bytes_resident(); }

 private:
  struct Desk;
  struct Sheet;

  void cast_sheets(std::span<const Sheet> sheets, const ColumnEye& eye, double exaggeration,
                   core::ThreadPool& pool);
  void cast_upright(const core::View& view, const ColumnEye& eye, double exaggeration, core::ThreadPool& pool,
                    std::span<float> range_m);
  void cast_fans(const core::View& view, const ColumnEye& eye, double exaggeration, core::ThreadPool& pool,
                 std::span<float> range_m);
  void find_hints(const FanPlan& plan, const core::SubRectangle& part, int row, float* a, float* b,
                  float* share) const;
  void resample(const core::View& view, const FanPlan& plan, const ColumnEye& eye, double exaggeration,
                core::ThreadPool& pool, std::span<float> range_m);
  void cast_each(const core::View& view, double exaggeration, core::ThreadPool& pool, std::span<float> range_m);

  paging::Surface surface_;
  LatticeStore store_;
  std::mutex desks_mutex_;
  std::vector<std::unique_ptr<Desk>> desks_;
  std::vector<std::vector<float>> fans_;  // ranges of the last picture's fans
};

}  // namespace vpe::voxel
