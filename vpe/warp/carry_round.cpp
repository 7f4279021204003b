#include "vpe/warp/carry_round.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mars/geodesy/sphere.h"
#include "vpe/warp/carry_checks.h"
#include "vpe/warp/row_kernel.h"

namespace vpe::warp {

namespace {

constexpr int kRowsATask = 16;

// Returns by how many columns ground moves from the left eye's image to the right one's.
double moved_px(double px_per_turn, double radius_m, double level_m) {
  return px_per_turn / mars::kPi * std::atan2(radius_m, level_m);
}

Scan scan_of(const RoundRow& row, double px_per_turn, int count, const CarryOptions& options) {
  Scan scan;
  scan.count = count;
  scan.radius_m = static_cast<float>(row.radius_m);
  scan.base_px_m = static_cast<float>(px_per_turn / mars::kPi * row.radius_m);
  scan.open_from =
      row.radius_m == 0
          ? std::numeric_limits<float>::infinity()
          : static_cast<float>(count - moved_px(px_per_turn, row.radius_m, options.nearest_m * row.level));
  scan.most_parted_px =
      std::min(static_cast<float>(options.gap_px - 1 + kCarriedPosition_px), options.most_added_px);
  scan.filters = options.filters;
  return scan;
}

}  // namespace

int columns_beside(double px_per_turn, std::span<const RoundRow> rows, double nearest_m) {
  double most_px = 0;
  for (const RoundRow& row : rows)
    most_px = std::max(most_px, moved_px(px_per_turn, row.radius_m, nearest_m * row.level));
  return static_cast<int>(std::ceil(most_px)) + 1;
}

void carry_round(const core::Frame& left, const RoundColumns& columns, std::span<const RoundRow> rows,
                 const CarryOptions& options, base::ThreadPool& pool, CarriedImage& into) {
  check_options(options);
  const std::size_t all = static_cast<std::size_t>(std::max(left.width, 0)) * rows.size();
  if (!(columns.px_per_turn > 0) || columns.count < 1 || columns.count > left.width ||
      left.height != static_cast<int>(rows.size()) || left.range_m.size() != all ||
      (!left.colour.empty() && left.colour.size() != all))
    throw std::invalid_argument("the panorama to carry has another size than its rows and columns");
  if (!std::ranges::all_of(rows, [](const RoundRow& row) { return row.radius_m >= 0 && row.level > 0; }))
    throw std::invalid_argument("rows of a panorama need a circle of eyes and an elevation below 90 degrees");
  const auto width = static_cast<std::size_t>(columns.count);
  const auto from_width = static_cast<std::size_t>(left.width);
  prepare(columns.count, left.height, !left.colour.empty(), into);
  const std::size_t tasks = (rows.size() + kRowsATask - 1) / kRowsATask;
  std::vector<float> added(tasks);
  pool.run(options.gap_px == 0 ? 0 : tasks, [&](std::size_t task) {
    const std::size_t end = std::min((task + 1) * kRowsATask, rows.size());
    for (std::size_t y = task * kRowsATask; y < end; ++y) {
      const Scan scan = scan_of(rows[y], columns.px_per_turn, left.width, options);
      RowBuffers row(scan);
      const auto length = static_cast<float>(1 / rows[y].level);
      std::ranges::fill(row.length, length);
      std::ranges::fill(row.new_length, length);
      std::copy_n(&left.range_m[y * from_width], from_width, row.range.begin());
      if (!left.colour.empty()) std::copy_n(&left.colour[y * from_width], from_width, row.colour.begin());
      added[task] = std::max(added[task], carry_row(scan, row, !left.colour.empty()));
      std::copy_n(row.new_range.begin(), width, &into.range_m[y * width]);
      std::copy_n(row.origin.begin(), width, &into.origin[y * width]);
      if (!left.colour.empty()) std::copy_n(row.new_colour.begin(), width, &into.colour[y * width]);
    }
  });
  for (const float px : added) into.added_px = std::max(into.added_px, static_cast<double>(px));
  if (into.added_px > 0) into.added_px += kCarriedPosition_px;
  finish(pool, into);
}

}  // namespace vpe::warp
