// Range images of S, cast column by column.
#pragma once

#include <memory>
#include <span>

#include "paging/planet/planet_file.h"
#include "paging/surface/surface.h"
#include "vpe/base/parallel.h"
#include "vpe/core/view.h"
#include "vpe/voxel/cast/height_grid_store.h"
#include "vpe/voxel/cast/sector_caster.h"

namespace vpe::voxel {

struct RangeOptions {
  double exaggeration = 1;
  // 0: S itself. Else tiles are cast as coarse as their posts are at most this far apart in the image; posts
  // of coarser tiles lie on S.
  double cell_px = 0;
  enum class Method {
    kColumns,
    kEach,   // every ray by itself, down the pyramids of S
    kPlain,  // every ray by itself in even steps (vpe/voxel/cast/fixed_step_marcher.h)
  };
  Method method = Method::kColumns;  // the others are what columns are measured against
};

class RangeCaster {
 public:
  RangeCaster(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes);

  // Ranges from the camera to S as exaggerated, metres, infinity for the sky, of the view's drawn part, row by row
  // from the top. Columns for perspective views and for round ones whose camera is level, else a ray a pixel; an
  // camera below S sees 0. With cell_px 0 as Surface::cast() says but for rounding: relative error below
  // range_error(view) / sine of incidence. Does not depend on the number of threads, nor on what was cast
  // before. Throws paging::PlanetError for tiles that cannot be read.
  // Returns the tiles that columns went over and the bound of their error; nothing of single rays.
  // One caller at a time for each SectorCaster, whose memory a cast uses; without one, one caller at a time.
  ColumnWalk::Used cast(const core::View& view, const RangeOptions& options, base::ThreadPool& pool,
                        std::span<float> range_m) {
    return cast(view, options, pool, range_m, sectors_);
  }
  ColumnWalk::Used cast(const core::View& view, const RangeOptions& options, base::ThreadPool& pool,
                        std::span<float> range_m, SectorCaster& sectors) const;
  static constexpr double kRangeError = 1e-6;
  // In fields of view wider than kWide_deg, whose lowest rows look almost straight down, and of ground whose relief
  // as exaggerated is more than a tenth of the radius.
  static constexpr double kWideRangeError = 5e-6;
  static constexpr double kWide_deg = 150;
  // Without exaggerated relief.
  static double range_error(const core::View& view) {
    return view.fov_deg > kWide_deg ? kWideRangeError : kRangeError;
  }

  const paging::Surface& surface() const { return surface_; }
  const HeightGridStore& store() const { return store_; }
  std::size_t bytes_resident() const {
    return surface_.bytes_resident() + store_.bytes_resident() + sectors_.bytes();
  }

 private:
  void cast_upright(const core::View& view, const ColumnWalk& walk, ScratchPool& scratches,
                    base::ThreadPool& pool, std::span<float> range_m) const;
  void cast_each(const core::View& view, double exaggeration, base::ThreadPool& pool,
                 std::span<float> range_m) const;

  paging::Surface surface_;
  HeightGridStore store_;
  SectorCaster sectors_;
};

}  // namespace vpe::voxel
