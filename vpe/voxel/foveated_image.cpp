#include "vpe/voxel/foveated_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "vpe/voxel/downsampled_view.h"
#include "vpe/voxel/ray_request.h"

namespace vpe::voxel {

namespace {

// Beyond the border that fades: smooth_edges() reads up to 5 pixels away, stripes of nodata ground one.
constexpr int kFilterReach_px = 6;
constexpr int kRowsOfTask = 16;
constexpr std::size_t kChannels = 3;

core::SubRectangle common(const core::SubRectangle& a, const core::SubRectangle& b) {
  const int x0 = std::max(a.x, b.x);
  const int y0 = std::max(a.y, b.y);
  const int width = std::min(a.x + a.width, b.x + b.width) - x0;
  const int height = std::min(a.y + a.height, b.y + b.height) - y0;
  return width > 0 && height > 0 ? core::SubRectangle{x0, y0, width, height} : core::SubRectangle{};
}

core::SubRectangle grown(const core::SubRectangle& r, int by) {
  return {r.x - by, r.y - by, r.width + 2 * by, r.height + 2 * by};
}

core::SubRectangle middle_of(const core::View& view, double share) {
  const auto border = [&](int side) { return static_cast<int>(std::floor(0.5 * (1 - share) * side)); };
  const int x = border(view.width);
  const int y = border(view.height);
  return {x, y, view.width - 2 * x, view.height - 2 * y};
}

// Runs `rows` for bands [begin, end) of rows of the drawn part, counted from the top of the full image.
template <typename Rows>
void for_bands(const core::SubRectangle& part, base::ThreadPool& pool, const Rows& rows) {
  const int tasks = (part.height + kRowsOfTask - 1) / kRowsOfTask;
  pool.run(static_cast<std::size_t>(tasks), [&](std::size_t task) {
    const int begin = part.y + static_cast<int>(task) * kRowsOfTask;
    rows(begin, std::min(begin + kRowsOfTask, part.y + part.height));
  });
}

// Calls `run` with the parts [begin, end) of row y that lie outside of a rectangle.
template <typename Run>
void outside_of(const core::SubRectangle& r, const core::SubRectangle& part, int y, const Run& run) {
  if (r.width == 0 || y < r.y || y >= r.y + r.height) {
    run(part.x, part.x + part.width);
    return;
  }
  run(part.x, r.x);
  run(r.x + r.width, part.x + part.width);
}

std::size_t offset(const core::SubRectangle& in, int x, int y) {
  return static_cast<std::size_t>(y - in.y) * static_cast<std::size_t>(in.width) +
         static_cast<std::size_t>(x - in.x);
}

// Interpolates rows of the outer image. A pixel's centre lies a quarter of an outer pixel from the nearest outer
// centre along each side, so all weights are quarters and sums are exact.
class OuterRows {
 public:
  OuterRows(const core::SubRectangle& part, std::span<const base::Rgb> colour)
      : part_(part),
        stride_(static_cast<std::size_t>(part.width) * kChannels),
        bytes_(reinterpret_cast<const std::uint8_t*>(colour.data())),
        sums_(stride_ + 2 * kChannels),
        left_(static_cast<std::size_t>(part.width)),
        right_(static_cast<std::size_t>(part.width)) {}

  // Selects the row of the image that write() is asked for.
  void set_row(int y) {
    const int near = std::clamp(y / kThinned, part_.y, part_.y + part_.height - 1);
    const int next = std::clamp(y % kThinned == 0 ? near - 1 : near + 1, part_.y, part_.y + part_.height - 1);
    const std::uint8_t* const a = bytes_ + static_cast<std::size_t>(near - part_.y) * stride_;
    const std::uint8_t* const b = bytes_ + static_cast<std::size_t>(next - part_.y) * stride_;
    // Four times the colours, with the border's once more at either end.
    std::uint16_t* const sum = sums_.data() + kChannels;
    for (std::size_t k = 0; k < stride_; ++k) sum[k] = static_cast<std::uint16_t>(3 * a[k] + b[k]);
    for (std::size_t c = 0; c < kChannels; ++c) {
      sums_[c] = sum[c];
      sum[stride_ + c] = sum[stride_ - kChannels + c];
    }
    mix(sum, sum - kChannels, reinterpret_cast<std::uint8_t*>(left_.data()));
    mix(sum, sum + kChannels, reinterpret_cast<std::uint8_t*>(right_.data()));
  }

  // Writes pixels [begin, end) of the row.
  void write(int begin, int end, base::Rgb* out) const {
    if (begin >= end) return;
    const base::Rgb* left = left_.data() + (begin / kThinned - part_.x);
    const base::Rgb* right = right_.data() + (begin / kThinned - part_.x);
    base::Rgb* const last = out + (end - begin);
    if (begin % kThinned != 0) {
      *out++ = *right++;
      ++left;
    }
    for (; last - out >= kThinned; out += kThinned) {
      out[0] = *left++;
      out[1] = *right++;
    }
    if (out != last) *out = *left;
  }

 private:
  void mix(const std::uint16_t* near, const std::uint16_t* next, std::uint8_t* out) const {
    for (std::size_t k = 0; k < stride_; ++k)
      out[k] = static_cast<std::uint8_t>((3 * near[k] + next[k] + 8) / 16);
  }

  core::SubRectangle part_;
  std::size_t stride_;
  const std::uint8_t* bytes_;
  std::vector<std::uint16_t> sums_;
  std::vector<base::Rgb> left_;  // of the even pixels
  std::vector<base::Rgb> right_;
};

// Returns the distance of a pixel from the middle along its farther axis; 0 in it.
int distance_px(const core::SubRectangle& middle, int x, int y) {
  const int dx = std::max({middle.x - x, x - (middle.x + middle.width - 1), 0});
  const int dy = std::max({middle.y - y, y - (middle.y + middle.height - 1), 0});
  return std::max(dx, dy);
}

base::Rgb mixed(const base::Rgb& dense, const base::Rgb& outer, int distance) {
  const int share = kFade_px + 1 - distance;  // of the dense colour, in parts of kFade_px + 1
  const auto mix = [&](int a, int b) {
    return static_cast<std::uint8_t>((a * share + b * distance + (kFade_px + 1) / 2) / (kFade_px + 1));
  };
  return {mix(dense.r, outer.r), mix(dense.g, outer.g), mix(dense.b, outer.b)};
}

}  // namespace

double thinning_px(double steepest_slope) {
  return std::max(kThinnedColour_px, rise_px(kThinnedRange_px, steepest_slope));
}

std::optional<FoveaPlan> fovea_plan(const core::DrawRequest& request) {
  const core::View& view = request.view;
  const std::optional<double> share = request.settings.ray_fovea;
  if (!share || view.projection != core::Projection::kPerspective || view.fov_deg > kWidestFovea_deg) return {};
  const core::SubRectangle part = core::drawn_part(view);
  FoveaPlan plan;
  plan.middle = middle_of(view, *share);
  const core::SubRectangle fading = grown(plan.middle, kFade_px);
  if (common(fading, part).width > 0) plan.dense = common(grown(fading, kFilterReach_px), part);
  if (plan.dense == part) return {};
  plan.outer = downsampled_view(view, kThinned);
  // A pixel more on every side to interpolate with, except at the image's edges.
  plan.outer.part = common(grown(core::drawn_part(plan.outer), 1), {0, 0, plan.outer.width, plan.outer.height});
  return plan;
}

void spread_ranges(const FoveaPlan& plan, const core::View& view, std::span<const float> outer_m,
                   base::ThreadPool& pool, std::span<float> range_m) {
  const core::SubRectangle part = core::drawn_part(view);
  const core::SubRectangle outer = core::drawn_part(plan.outer);
  for_bands(part, pool, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const float* const from = outer_m.data() + offset(outer, outer.x, y / kThinned);
      outside_of(plan.dense, part, y, [&](int begin, int end) {
        float* const out = range_m.data() + offset(part, begin, y);
        for (int x = begin; x < end; ++x) out[x - begin] = from[x / kThinned - outer.x];
      });
    }
  });
}

void merge_colours(const FoveaPlan& plan, const core::View& view, const FoveaColours& from,
                   base::ThreadPool& pool, std::span<base::Rgb> colour) {
  const core::SubRectangle part = core::drawn_part(view);
  const core::SubRectangle middle = common(plan.middle, part);
  const core::SubRectangle fading = common(grown(plan.middle, kFade_px), plan.dense);
  for_bands(part, pool, [&](int first, int last) {
    OuterRows rows(core::drawn_part(plan.outer), from.outer);
    for (int y = first; y < last; ++y) {
      rows.set_row(y);
      outside_of(middle, part, y,
                 [&](int begin, int end) { rows.write(begin, end, colour.data() + offset(part, begin, y)); });
      if (y < fading.y || y >= fading.y + fading.height) continue;
      const base::Rgb* const sharp = from.dense.data() + offset(plan.dense, fading.x, y);
      base::Rgb* const out = colour.data() + offset(part, fading.x, y);
      const bool crosses = middle.width > 0 && y >= middle.y && y < middle.y + middle.height;
      const int first_sharp = crosses ? middle.x - fading.x : fading.width;
      const int end_sharp = crosses ? first_sharp + middle.width : fading.width;
      std::copy(sharp + first_sharp, sharp + end_sharp, out + first_sharp);
      const auto fade = [&](int begin, int end) {
        for (int k = begin; k < end; ++k)
          out[k] = mixed(sharp[k], out[k], distance_px(plan.middle, fading.x + k, y));
      };
      fade(0, first_sharp);
      fade(end_sharp, fading.width);
    }
  });
}

}  // namespace vpe::voxel
