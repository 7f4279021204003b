#include "vpe/warp/carry_rows.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "vpe/core/ray_lengths.h"

namespace vpe::warp {

namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

// Neighbours of which one is sky are a skyline. Its place between them is unknown, so each pixel takes the nearer one as
// long as they are hardly farther apart than in the first image.
constexpr float kMostPartedSkyline_px = 0.125F;

constexpr int kTaskRows = 16;

// Describes how pixels move, in scanning order: from the side that the eye moves to, so that what hides a pixel comes
// before it. Positions are in pixels of the row in that order.
struct Scan {
  bool is_mirrored = false;  // the eye moves to the left: the row is read from its end
  int count = 0;
  float shift_px = 0;   // of points at infinity
  float base_px_m = 0;  // shift of a point at depth 1 m, >= 0
  float open_from = 0;  // positions from here on are open
  float most_parted_px = 0;
  bool filters = true;
};

// Works on rows one after the other. For one thread.
class RowCarrier {
 public:
  explicit RowCarrier(const Scan& scan)
      : scan_(scan),
        inverse_depth_(static_cast<std::size_t>(scan.count)),
        place_(static_cast<std::size_t>(scan.count)),
        source_(static_cast<std::size_t>(scan.count)),
        origin_(static_cast<std::size_t>(scan.count)) {}

  std::span<float> inverse_depth() { return inverse_depth_; }  // in, in scanning order; 0 for sky

  // Finds for each pixel the position in the first image's row that it shows.
  void find_sources();

  // The index of a neighbour and the share of the next; for open pixels the inverse of a depth before which there is
  // nothing, 0 if none is known.
  std::span<const float> source() const { return source_; }
  std::span<const Origin> origin() const { return origin_; }
  float added_px() const { return added_px_; }

 private:
  void fill(int left, float begin, float reach);

  const Scan& scan_;
  std::vector<float> inverse_depth_;
  std::vector<float> place_;
  std::vector<float> source_;
  std::vector<Origin> origin_;
  float added_px_ = 0;
};

void RowCarrier::find_sources() {
  const int n = scan_.count;
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    place_[k] = static_cast<float>(i) + 0.5F + scan_.shift_px - scan_.base_px_m * inverse_depth_[k];
  }
  std::fill(origin_.begin(), origin_.end(), Origin::kOpen);
  std::fill(source_.begin(), source_.end(), 0.0F);
  if (n < 2) return;
  const float last = place_[static_cast<std::size_t>(n - 1)];
  float reach = std::min(last + static_cast<float>(kCarriedPosition_px), scan_.open_from);
  // The last sample has no neighbour beyond it: only a pixel at its very place shows it.
  if (last < reach) {
    fill(n - 2, last, reach);
    reach = last;
  }
  for (int i = n - 2; i >= 0; --i) {
    const float x = place_[static_cast<std::size_t>(i)];
    if (!(x < reach)) continue;  // hidden
    fill(i, x, reach);
    reach = x;
  }
}

// Fills the pixels whose centres are at [begin, reach) with what lies between samples `left` and left + 1.
void RowCarrier::fill(int left, float begin, float reach) {
  // Returns the first pixel whose centre is not before a position.
  const auto pixel_from = [n = static_cast<float>(scan_.count)](float position) {
    const float clamped = std::clamp(position - 0.5F, 0.0F, n);
    const auto down = static_cast<int>(clamped);
    return down + (static_cast<float>(down) < clamped ? 1 : 0);
  };
  const int first = pixel_from(begin);
  const int end = pixel_from(reach);
  if (first >= end) return;
  const auto l = static_cast<std::size_t>(left);
  const float x = place_[l];
  const float width = place_[l + 1] - x;
  const bool is_sky = inverse_depth_[l] == 0;
  const bool is_skyline = is_sky != (inverse_depth_[l + 1] == 0);
  // How much farther than its neighbour a pixel moves.
  const float parted_px = std::abs(width - 1);
  if (!(parted_px <= (is_skyline ? kMostPartedSkyline_px : scan_.most_parted_px))) {
    // No nearer than the nearer neighbour: silhouettes may reach a pixel farther than their last sample.
    std::fill(source_.begin() + first, source_.begin() + end,
              std::max(inverse_depth_[l], inverse_depth_[l + 1]));
    return;
  }
  if (!is_sky || is_skyline) added_px_ = std::max(added_px_, parted_px);
  for (int k = first; k < end; ++k) {
    float share = std::min((static_cast<float>(k) + 0.5F - x) / width, 1.0F);
    const float nearer_px = std::min(share, 1 - share) * width;
    if (is_skyline) share = share < 0.5F ? 0.0F : 1.0F;
    const auto p = static_cast<std::size_t>(k);
    source_[p] = static_cast<float>(left) + share;
    const bool is_sky_here = is_skyline ? (share == 0) == is_sky : is_sky;
    origin_[p] = is_sky_here ? Origin::kSky : nearer_px <= 0.5F ? Origin::kCarried : Origin::kBetween;
  }
}

// Mixes two colours in 256ths: within half a step of 8 bits.
base::Rgb between(const base::Rgb& a, const base::Rgb& b, int share_256) {
  const auto mix = [share_256](std::uint8_t x, std::uint8_t y) {
    return static_cast<std::uint8_t>(((256 - share_256) * x + share_256 * y + 128) >> 8);
  };
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

void set_inverse_depth(std::span<const float> length, std::span<const float> range_m, std::span<float> out) {
  // No number where the range is none: neither that pixel nor what lies beside it is carried.
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t x = 0; x < out.size(); ++x) out[x] = range_m[x] > 0 ? length[x] / range_m[x] : kNone;
}

// Writes a row whose first pixel is `first`. `length` is that of the new image's rays.
void write_row(const Scan& scan, RowCarrier& row, std::span<const float> length, const core::Frame& frame,
               std::size_t first, CarriedImage& into) {
  const int n = scan.count;
  const std::span<const float> inverse_depth = row.inverse_depth();
  const std::span<const float> source = row.source();
  const std::span<const Origin> origin = row.origin();
  const auto colour_at = [&](int sample) {
    return frame.colour[first + static_cast<std::size_t>(scan.is_mirrored ? n - 1 - sample : sample)];
  };
  for (int k = 0; k < n; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const auto x = static_cast<std::size_t>(scan.is_mirrored ? n - 1 - k : k);
    into.origin[first + x] = origin[at];
    if (origin[at] == Origin::kOpen) {
      into.range_m[first + x] = source[at] > 0 ? length[x] / source[at] : 0;
      if (!into.colour.empty()) into.colour[first + x] = {};
      continue;
    }
    const int left = std::min(static_cast<int>(source[at]), n - 2);
    const float share = source[at] - static_cast<float>(left);
    const auto l = static_cast<std::size_t>(left);
    const float w = inverse_depth[l] + share * (inverse_depth[l + 1] - inverse_depth[l]);
    into.range_m[first + x] = origin[at] == Origin::kSky ? core::kSkyRange : length[x] / w;
    if (into.colour.empty()) continue;
    const int share_256 = scan.filters ? static_cast<int>(share * 256 + 0.5F) : share < 0.5F ? 0 : 256;
    into.colour[first + x] = between(colour_at(left), colour_at(left + 1), share_256);
  }
}

Scan scan_of(const core::View& from, const core::View& to, const CarryOptions& options) {
  const double aside_m = glm::dot(to.camera.position_m - from.camera.position_m, from.camera.axes.right);
  const double shift_px = to.principal_offset_px.x - from.principal_offset_px.x;
  const double base_px_m = std::abs(aside_m) * core::focal_px(from);
  Scan scan;
  scan.is_mirrored = aside_m < 0;
  scan.count = core::drawn_size(from).x;
  scan.shift_px = static_cast<float>(scan.is_mirrored ? -shift_px : shift_px);
  scan.base_px_m = static_cast<float>(base_px_m);
  // A ray of the new eye runs beside the first image until it crosses that image's border. It may do so within the
  // distance where there is no ground.
  const double nearest_depth_m = options.nearest_m / std::sqrt(core::corner_stretch(from));
  scan.open_from =
      base_px_m == 0
          ? kInfinite
          : static_cast<float>(scan.count + static_cast<double>(scan.shift_px) - base_px_m / nearest_depth_m);
  scan.most_parted_px =
      std::min(static_cast<float>(options.gap_px - 1 + kCarriedPosition_px), options.most_added_px);
  scan.filters = options.filters;
  return scan;
}

}  // namespace

bool rows_correspond(const core::View& from, const core::View& to) {
  const mars::Axes& a = from.camera.axes;
  const mars::Axes& b = to.camera.axes;
  if (a.right != b.right || a.up != b.up || a.forward != b.forward || from.fov_deg != to.fov_deg ||
      from.width != to.width || from.height != to.height || core::drawn_part(from) != core::drawn_part(to) ||
      from.principal_offset_px.y != to.principal_offset_px.y)
    return false;
  const glm::dvec3 shift = to.camera.position_m - from.camera.position_m;
  const double beside_m = glm::length(shift - glm::dot(shift, a.right) * a.right);
  return beside_m <= 1e-15 * glm::length(from.camera.position_m) + 1e-9 * glm::length(shift);
}

void carry_rows(const core::View& from, const core::Frame& frame, const core::View& to,
                const CarryOptions& options, base::ThreadPool& pool, CarriedImage& into) {
  const Scan scan = scan_of(from, to, options);
  const int tasks = (into.height + kTaskRows - 1) / kTaskRows;
  std::vector<float> added(static_cast<std::size_t>(tasks));
  const core::RayLengths from_lengths(from);
  const core::RayLengths to_lengths(to);
  pool.run(static_cast<std::size_t>(tasks), [&](std::size_t task) {
    RowCarrier row(scan);
    std::vector<float> length(static_cast<std::size_t>(scan.count));
    const int end = std::min((static_cast<int>(task) + 1) * kTaskRows, into.height);
    for (int y = static_cast<int>(task) * kTaskRows; y < end; ++y) {
      const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(scan.count);
      from_lengths.row(y, length);
      set_inverse_depth(length, {frame.range_m.data() + first, length.size()}, row.inverse_depth());
      if (scan.is_mirrored) std::ranges::reverse(row.inverse_depth());
      row.find_sources();
      to_lengths.row(y, length);
      write_row(scan, row, length, frame, first, into);
    }
    added[task] = row.added_px();
  });
  for (const float px : added) into.added_px = std::max(into.added_px, static_cast<double>(px));
  if (into.added_px > 0 || scan.base_px_m > 0) into.added_px += kCarriedPosition_px;
}

}  // namespace vpe::warp
