#include "vpe/warp/carry_rows.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "vpe/core/ray_lengths.h"
#include "vpe/warp/row_kernel.h"

namespace vpe::warp {

namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

constexpr int kTaskRows = 16;

// Copies a row between the order of the image and that of the scan.
template <typename T, typename Out>
void copy_row(const Scan& scan, std::span<const T> row, Out out) {
  if (scan.is_mirrored) {
    std::ranges::reverse_copy(row, out);
  } else {
    std::ranges::copy(row, out);
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
  const bool has_same_lengths = from.principal_offset_px == to.principal_offset_px;
  const auto n = static_cast<std::size_t>(scan.count);
  pool.run(static_cast<std::size_t>(tasks), [&](std::size_t task) {
    RowBuffers row(scan);
    std::vector<float> length(n);
    const int end = std::min((static_cast<int>(task) + 1) * kTaskRows, into.height);
    for (int y = static_cast<int>(task) * kTaskRows; y < end; ++y) {
      const std::size_t first = static_cast<std::size_t>(y) * n;
      from_lengths.row(y, length);
      copy_row(scan, std::span<const float>(length), row.length.begin());
      if (has_same_lengths) {
        row.new_length = row.length;
      } else {
        to_lengths.row(y, length);
        copy_row(scan, std::span<const float>(length), row.new_length.begin());
      }
      copy_row(scan, std::span(frame.range_m).subspan(first, n), row.range.begin());
      if (!frame.colour.empty()) copy_row(scan, std::span(frame.colour).subspan(first, n), row.colour.begin());
      added[task] = std::max(added[task], carry_row(scan, row, !frame.colour.empty()));
      copy_row(scan, std::span(std::as_const(row.new_range)).first(n), &into.range_m[first]);
      copy_row(scan, std::span(std::as_const(row.origin)).first(n), &into.origin[first]);
      if (!frame.colour.empty())
        copy_row(scan, std::span(std::as_const(row.new_colour)).first(n), &into.colour[first]);
    }
  });
  for (const float px : added) into.added_px = std::max(into.added_px, static_cast<double>(px));
  if (into.added_px > 0 || scan.base_px_m > 0) into.added_px += kCarriedPosition_px;
}

}  // namespace vpe::warp
