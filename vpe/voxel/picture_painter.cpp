#include "vpe/voxel/picture_painter.h"

#include <atomic>
#include <glm/geometric.hpp>
#include <mutex>
#include <vector>

#include "vpe/voxel/paint_job.h"

namespace vpe::voxel {

namespace {

// Of the budget: what threads hold on to while they paint. The caches have the rest, and in it mostly what
// every picture takes again: heights are looked at only when tiles are new.
constexpr double kHeldShare = 0.15;
constexpr paging::PaintShares kShares{.surface = 0.1, .heights = 0.2, .normals = 0.45, .images = 0.25};

// Rows a thread takes at a time.
constexpr int kBand = 16;

std::size_t share(double part, std::size_t budget) {
  return static_cast<std::size_t>(part * static_cast<double>(budget));
}

// Squares at hand, given to whoever paints a band and taken back after it.
class TilesOfThreads {
 public:
  template <typename Make>
  std::unique_ptr<PaintTiles> take(Make&& make) {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        auto tiles = std::move(idle_.back());
        idle_.pop_back();
        return tiles;
      }
    }
    return make();
  }
  void give(std::unique_ptr<PaintTiles> tiles) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(tiles));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<PaintTiles>> idle_;
};

}  // namespace

PicturePainter::PicturePainter(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes)
    : planet_(std::move(planet)),
      budget_(budget_bytes),
      painter_(planet_, share(1 - kHeldShare, budget_bytes), kShares) {}

void PicturePainter::set_look(const core::DrawRequest& request) {
  const core::Appearance& appearance = request.settings;
  const bool has_image = planet_->meta().finest_image_level >= 0;
  if (!paging::needs_scale(appearance, has_image)) {
    scale_ = nullptr;
  } else if (!scale_ || scale_of_ != appearance) {
    scale_ = std::make_shared<const core::ColourScale>(appearance);
    table_ = scale_table(*scale_);
    scale_of_ = appearance;
  }
  look_ = paging::shade_params(appearance, request.sun, has_image, scale_);
}

std::int64_t PicturePainter::paint(const core::DrawRequest& request, std::span<const float> range_m,
                                   std::span<mars::Rgb> colour, std::span<float> inverse_depth,
                                   core::ThreadPool& pool) {
  set_look(request);
  const glm::ivec2 size = core::drawn_size(request.view);
  PaintJob job;
  job.request = &request;
  job.painter = &painter_;
  job.look = &look_;
  job.scale = look_.scale ? &table_ : nullptr;
  job.rays = ray_rows(request.view);
  job.radius_m = planet_->radius_m();
  job.focal_px = core::focal_px(request.view);
  job.root_range_m = lod::nominal_side_m(0, job.radius_m) / planet_->meta().tile.intervals() * job.focal_px;
  job.posts_side = planet_->meta().tile.posts();
  job.by_point = look_.flat || look_.surfacing == paging::Surfacing::kImageAtPosts;
  job.eye_radius_m = glm::length(request.view.eye.eye_m);
  if (job.eye_radius_m > 0.0) job.up = request.view.eye.eye_m / job.eye_radius_m;
  job.width = size.x;
  job.height = size.y;
  job.range_m = range_m.data();
  job.colour = colour.data();
  job.inverse_depth = inverse_depth.empty() ? nullptr : inverse_depth.data();

  const auto bands = static_cast<std::size_t>((size.y + kBand - 1) / kBand);
  std::atomic<std::int64_t> without_data{0};
  TilesOfThreads tiles_of_threads;
  pool.run(bands, [&](std::size_t band) {
    auto tiles = tiles_of_threads.take([&] {
      return std::make_unique<PaintTiles>(*planet_, painter_, look_,
                                          share(kHeldShare / pool.threads(), budget_));
    });
    const int begin = static_cast<int>(band) * kBand;
    without_data += paint_rows(job, *tiles, begin, std::min(begin + kBand, size.y));
    tiles_of_threads.give(std::move(tiles));
  });
  return without_data;
}

}  // namespace vpe::voxel
