#include "vpe/voxel/discrete_image.h"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

namespace vpe::voxel {

namespace {

std::uint8_t faded(std::uint8_t own, std::uint8_t coarser, double share) {
  const double value =
      static_cast<double>(own) + share * (static_cast<double>(coarser) - static_cast<double>(own));
  return static_cast<std::uint8_t>(std::lround(value));
}

// Paints one ray of each pixel, or of those that are wanted, and leaves the others.
class RayPainter {
 public:
  RayPainter(const core::DrawRequest& request, ImagePainter& painter, base::ThreadPool& pool,
             ImagePainter::Reading& reading, std::vector<AbsentPage>& absent)
      : painter_(painter),
        pool_(pool),
        reading_(reading),
        absent_(absent),
        ratio_(request.settings.ray_ratio * std::max(1.0, request.coarsening)),
        level_range_m_(painter.level_range_m(request, ratio_)),
        blends_(request.settings.ray_blend) {}

  // Returns the number of nodata pixels. `wanted` is empty or not 0 for wanted pixels.
  std::int64_t paint(const core::DrawRequest& request, std::span<const float> range_m,
                     std::span<const std::uint8_t> wanted, std::span<base::Rgb> colour) {
    const std::int64_t nodata = paint_level(request, ratio_, range_m, wanted, colour);
    if (!blends_) return nodata;
    coarser_.resize(colour.size());
    paint_level(request, 2 * ratio_, range_m, wanted, coarser_);
    const auto width = static_cast<std::size_t>(core::drawn_size(request.view).x);
    pool_.run(colour.size() / width, [&](std::size_t row) {
      for (std::size_t n = row * width; n < (row + 1) * width; ++n) {
        if (!wanted.empty() && wanted[n] == 0) continue;
        const double share = coarser_share(range_m[n], level_range_m_);
        base::Rgb& c = colour[n];
        c = {faded(c.r, coarser_[n].r, share), faded(c.g, coarser_[n].g, share),
             faded(c.b, coarser_[n].b, share)};
      }
    });
    return nodata;
  }

 private:
  std::int64_t paint_level(const core::DrawRequest& request, double post_px, std::span<const float> range_m,
                           std::span<const std::uint8_t> wanted, std::span<base::Rgb> out) {
    const std::int64_t nodata = painter_.paint(request, range_m, out, wanted, pool_, &reading_, {}, post_px);
    absent_.insert(absent_.end(), reading_.absent.begin(), reading_.absent.end());
    return nodata;
  }

  ImagePainter& painter_;
  base::ThreadPool& pool_;
  ImagePainter::Reading& reading_;
  std::vector<AbsentPage>& absent_;
  double ratio_;
  double level_range_m_;
  bool blends_;
  std::vector<base::Rgb> coarser_;
};

}  // namespace

double coarser_share(float range_m, double level_range_m) {
  if (!(range_m > 0) || !std::isfinite(range_m)) return 0;
  // The painter's level is the exponent of this number, rounded up.
  int level = 0;
  const float part = std::frexp(static_cast<float>(level_range_m) / range_m, &level);
  return part == 0.5F ? 0.0 : 1.0 / static_cast<double>(part) - 1.0;
}

void take_middle_rays(std::span<const float> rays_m, int width, int rays, std::span<float> range_m) {
  const auto row = static_cast<std::size_t>(width);
  const auto step = row * static_cast<std::size_t>(rays);
  for (std::size_t y = 0; y < range_m.size() / row; ++y) {
    const auto from =
        rays_m.begin() + static_cast<std::ptrdiff_t>(y * step + row * static_cast<std::size_t>(rays / 2));
    std::copy_n(from, row, range_m.begin() + static_cast<std::ptrdiff_t>(y * row));
  }
}

std::int64_t paint_discrete(const core::DrawRequest& request, std::span<const float> rays_m,
                            std::span<const std::uint8_t> wanted, ImagePainter& painter, base::ThreadPool& pool,
                            ImagePainter::Reading& reading, std::vector<AbsentPage>& absent,
                            std::span<base::Rgb> colour) {
  const int rays = request.settings.ray_vertical;
  RayPainter ray_painter(request, painter, pool, reading, absent);
  if (rays == 1) return ray_painter.paint(request, rays_m, wanted, colour);
  const auto row = static_cast<std::size_t>(core::drawn_size(request.view).x);
  std::vector<float> range_m(colour.size());
  std::vector<std::uint8_t> is_other(colour.size(), 1);
  std::vector<glm::ivec3> sum(colour.size(), glm::ivec3(0));
  core::DrawRequest of_ray = request;
  std::int64_t nodata = 0;
  for (int ray = 0; ray < rays; ++ray) {
    // A ray with the range of the one above it shows the same voxel.
    for (std::size_t y = 0; y * row < range_m.size(); ++y) {
      const float* const from =
          rays_m.data() + (y * static_cast<std::size_t>(rays) + static_cast<std::size_t>(ray)) * row;
      float* const to = range_m.data() + y * row;
      std::uint8_t* const other = is_other.data() + y * row;
      for (std::size_t x = 0; x < row; ++x) {
        other[x] = ray == 0 || from[x] != to[x] ? 1 : 0;
        to[x] = from[x];
      }
    }
    of_ray.view.principal_offset_px.y = request.view.principal_offset_px.y - ((ray + 0.5) / rays - 0.5);
    const std::int64_t painted = ray_painter.paint(of_ray, range_m, is_other, colour);
    if (ray == 0) nodata = painted;
    for (std::size_t n = 0; n < sum.size(); ++n) sum[n] += glm::ivec3(colour[n].r, colour[n].g, colour[n].b);
  }
  const auto mean = [&](int total) { return static_cast<std::uint8_t>((total + rays / 2) / rays); };
  for (std::size_t n = 0; n < sum.size(); ++n) colour[n] = {mean(sum[n].x), mean(sum[n].y), mean(sum[n].z)};
  return nodata;
}

}  // namespace vpe::voxel
