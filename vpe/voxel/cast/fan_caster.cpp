#include "vpe/voxel/cast/fan_caster.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "vpe/voxel/cast/facet_finder.h"
#include "vpe/voxel/cast/fixed_step_marcher.h"
#include "vpe/voxel/cast/view_fan.h"

namespace vpe::voxel {

namespace {

// A single ray takes longer than this many samples.
constexpr std::int64_t kMostSamples = 16;
constexpr int kFanTaskRows = 32;
constexpr int kFanTaskColumns = 128;

// Makes the rays of a round view (core::pixel_ray()) from its columns and rows.
class RoundRays {
 public:
  explicit RoundRays(const core::View& view) : view_(view), part_(core::drawn_part(view)) {
    const double middle = 0.5 * view.width + view.principal_offset_px.x;
    for (int x = 0; x < part_.width; ++x) {
      const double from_middle = std::remainder(part_.x + x + 0.5 - middle, view.width);
      const mars::SinCos azimuth = mars::sin_cos_deg(from_middle * 360.0 / view.width);
      sine_.push_back(azimuth.sin);
      cosine_.push_back(azimuth.cos);
    }
  }

  // Returns the rays of pixels [begin, end) of a row of the drawn part. This must outlive them.
  RoundRow row(int y, int begin, int end, double radius_m) const {
    const double up_px = 0.5 * view_.height + view_.principal_offset_px.y - (part_.y + y + 0.5);
    double level = 0;
    double rise = 0;
    if (view_.projection == core::Projection::kCylinder) {
      rise = up_px / core::focal_px(view_);
      level = 1 / std::hypot(1.0, rise);
      rise *= level;
    } else {
      const mars::SinCos elevation = mars::sin_cos_deg(up_px * view_.fov_deg / view_.height);
      level = elevation.cos;
      rise = elevation.sin;
    }
    const mars::Axes& axes = view_.camera.axes;
    return {view_.camera.position_m, radius_m,           sine_.data() + begin,
            cosine_.data() + begin,  level * axes.right, level * axes.forward,
            rise * axes.up,          end - begin};
  }

 private:
  const core::View& view_;
  core::SubRectangle part_;
  std::vector<double> sine_, cosine_;
};

// Casts a pixel by itself: exactly, or over the walk's height grids in fixed steps.
double cast_open_pixel(const ColumnWalk& walk, FacetFinder& finder, const SingleRays* single_rays,
                       const RoundRow& row, const OpenPixel& open) {
  const glm::dvec3 ray = row.direction(open.pixel);
  if (single_rays != nullptr) {
    const std::optional<double> range = single_rays->cast_near(row.camera_m, ray, open.near_m, open.far_m);
    if (range) return *range;
  }
  const auto near_m = static_cast<double>(open.near_m);
  const double begin_m = std::isfinite(near_m) ? (1.0 - kAroundRange) * near_m : 0.0;
  const double range_m = march(row.camera_m, ray, begin_m, walk.highest_m(), finder, row.radius_m);
  // Below the ground already.
  if (range_m == begin_m) return march(row.camera_m, ray, 0, walk.highest_m(), finder, row.radius_m);
  return range_m;
}

}  // namespace

bool cast_by_fan(const core::View& view, const ColumnWalk& walk, ScratchPool& scratches,
                 const SingleRays* single_rays, base::ThreadPool& pool, SectorSamples& samples,
                 std::span<float> range_m) {
  const core::SubRectangle part = core::drawn_part(view);
  const ViewFan fan(view, walk.camera().up);
  if (fan.sample_count() > kMostSamples * part.width * part.height) return false;
  const std::size_t needed = static_cast<std::size_t>(fan.rows()) * static_cast<std::size_t>(fan.columns());
  if (samples.empty()) samples.resize(1);
  if (samples[0].size() < needed) samples[0].resize(needed);
  const ColumnBatch batch = fan.batch(samples[0].data());
  cast_columns({&batch, 1}, walk, scratches, pool);
  const FanSamples cast = fan.samples(samples[0].data());
  const RoundRays rays(view);
  const int tasks = (part.height + kFanTaskRows - 1) / kFanTaskRows;
  pool.run(static_cast<std::size_t>(tasks), [&](std::size_t task) {
    const ScratchPool::Lease scratch = scratches.acquire();
    FacetFinder finder(walk, scratch->tiles);
    FacetFinder exact_finder(walk, scratch->tiles);
    std::vector<OpenPixel> open;
    const int first = static_cast<int>(task) * kFanTaskRows;
    const int last = std::min(first + kFanTaskRows, part.height);
    // In blocks, so that neighbouring rows find their samples and height grids in the caches.
    for (int begin = 0; begin < part.width; begin += kFanTaskColumns) {
      const int end = std::min(begin + kFanTaskColumns, part.width);
      for (int y = first; y < last; ++y) {
        const RoundRow row = rays.row(y, begin, end, walk.camera().radius_m);
        float* const out =
            range_m.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(part.width) + begin;
        open.clear();
        refine_round_row(row, cast, finder, exact_finder, out, open);
        for (const OpenPixel& pixel : open)
          out[pixel.pixel] = static_cast<float>(cast_open_pixel(walk, finder, single_rays, row, pixel));
      }
    }
  });
  return true;
}

}  // namespace vpe::voxel
