#include "vpe/voxel/cast/view_fan.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace vpe::voxel {

namespace {

// Rows and columns beyond what the image shows, so that every pixel lies between samples.
constexpr int kMargin = 2;
// Columns are no farther apart than this, wherever the image lies.
constexpr double kMostSpacing_rad = 0.05;

double spacing_of(const core::View& view) {
  const double height_rad = 1 / core::focal_px(view);
  const double width_rad = 2 * mars::kPi / view.width;
  const double least = std::max(std::min(height_rad, width_rad), 0.5 * std::sqrt(height_rad * width_rad));
  return std::min(least, kMostSpacing_rad);
}

// Returns a direction that is normal to the camera's vertical.
glm::dvec3 north_of(const mars::Axes& axes, const glm::dvec3& up) {
  const glm::dvec3& v = std::abs(glm::dot(axes.forward, up)) < 0.9 ? axes.forward : axes.up;
  return glm::normalize(v - glm::dot(v, up) * up);
}

// Returns true if the drawn part shows a direction, or nearly does.
bool shows(const core::View& view, const glm::dvec3& direction) {
  const core::SubRectangle part = core::drawn_part(view);
  core::View from_origin = view;
  from_origin.camera.position_m = {0, 0, 0};
  const core::Projected at = core::project(from_origin, direction);
  if (at.behind) return false;
  const double x = at.xy.x;
  constexpr double kBeside_px = 1;
  const auto within = [&](double to) {
    return to > part.x - kBeside_px && to < part.x + part.width + kBeside_px;
  };
  return (within(x) || within(x - view.width) || within(x + view.width)) && at.xy.y > part.y - kBeside_px &&
         at.xy.y < part.y + part.height + kBeside_px;
}

}  // namespace

// The directions along the border of the drawn part, no farther apart than a fan's rows.
struct ViewFan::Border {
  struct Point {
    double azimuth;
    double elevation;
  };

  Border(const core::View& view, const ViewFan& fan) {
    const core::SubRectangle part = core::drawn_part(view);
    const auto edge = [&](glm::dvec2 from, glm::dvec2 to, double length_px, double pixel_rad) {
      const int steps = static_cast<int>(std::ceil(length_px * std::max(1.0, pixel_rad / fan.spacing_rad_)));
      for (int n = 0; n < steps; ++n) {
        const glm::dvec2 at = from + (to - from) * (static_cast<double>(n) / steps);
        const glm::dvec3 ray = core::pixel_ray(view, at.x, at.y);
        const double along = glm::dot(ray, fan.north_);
        const double across = glm::dot(ray, fan.east_);
        points.push_back(
            {std::atan2(across, along), std::atan2(glm::dot(ray, fan.up_), std::hypot(along, across))});
      }
    };
    const double width_rad = 2 * mars::kPi / view.width;
    const double height_rad = 1 / core::focal_px(view);
    const glm::dvec2 a(part.x, part.y);
    const glm::dvec2 b(part.x + part.width, part.y);
    const glm::dvec2 c(part.x + part.width, part.y + part.height);
    const glm::dvec2 d(part.x, part.y + part.height);
    edge(a, b, part.width, width_rad);
    edge(b, c, part.height, height_rad);
    edge(c, d, part.width, width_rad);
    edge(d, a, part.height, height_rad);
    shows_nadir = shows(view, -fan.up_);
    shows_zenith = shows(view, fan.up_);
  }

  std::vector<Point> points;  // a closed line
  bool shows_nadir = false;
  bool shows_zenith = false;
};

ViewFan::ViewFan(const core::View& view, const glm::dvec3& up)
    : spacing_rad_(spacing_of(view)),
      up_(up),
      north_(north_of(view.camera.axes, up)),
      east_(glm::cross(north_, up)) {
  const Border border(view, *this);
  const auto [low, high] =
      std::ranges::minmax(border.points, {}, [](const Border::Point& p) { return p.elevation; });
  const bool is_level = low.elevation < 0 && high.elevation > 0;
  const double least = std::min(std::abs(low.elevation), std::abs(high.elevation));
  const double widest =
      is_level || (border.shows_nadir && high.elevation > 0) || (border.shows_zenith && low.elevation < 0)
          ? 1
          : std::min(1.0, std::cos(least) + spacing_rad_);
  azimuth_step_ = 2 * mars::kPi / std::ceil(2 * mars::kPi * widest / spacing_rad_);
  elevation_step_ = mars::kPi / std::ceil(mars::kPi / spacing_rad_);
  set_rows_of_columns(border);
  set_table();
}

// Goes along the border. Where a column meets the image, the ends lie on the border, or straight above or below the camera.
void ViewFan::set_rows_of_columns(const Border& border) {
  const int circle = static_cast<int>(std::lround(2 * mars::kPi / azimuth_step_));
  const int most = static_cast<int>(std::lround(mars::kPi / elevation_step_));
  constexpr int kNone = std::numeric_limits<int>::max();
  std::vector<int> first(static_cast<std::size_t>(circle), kNone);
  std::vector<int> end(static_cast<std::size_t>(circle), 0);
  const auto row_of = [&](double elevation) {
    return std::clamp(static_cast<int>(std::floor((elevation + mars::kPi / 2) / elevation_step_)), 0, most - 1);
  };
  const auto column_of = [&](double angle) {
    return static_cast<int>(std::floor((angle + mars::kPi) / azimuth_step_));
  };
  for (std::size_t n = 0; n < border.points.size(); ++n) {
    const Border::Point& a = border.points[n];
    const Border::Point& b = border.points[n + 1 < border.points.size() ? n + 1 : 0];
    const double turn = std::remainder(b.azimuth - a.azimuth, 2 * mars::kPi);
    const int from = column_of(std::min(a.azimuth, a.azimuth + turn)) - kMargin;
    const int to = column_of(std::max(a.azimuth, a.azimuth + turn)) + kMargin;
    const int low = row_of(std::min(a.elevation, b.elevation));
    const int high = row_of(std::max(a.elevation, b.elevation));
    for (int c = from; c <= std::min(to, from + circle - 1); ++c) {
      const auto column = static_cast<std::size_t>((c % circle + circle) % circle);
      first[column] = std::min(first[column], std::max(low - kMargin, 0));
      end[column] = std::max(end[column], std::min(high + kMargin + 1, most));
    }
  }
  for (std::size_t c = 0; c < first.size(); ++c) {
    if (border.shows_nadir) {
      first[c] = 0;
      end[c] = std::max(end[c], std::min(2 * kMargin, most));
    }
    if (border.shows_zenith) {
      first[c] = std::min(first[c], std::max(most - 2 * kMargin, 0));
      end[c] = most;
    }
  }
  // Begins after the widest gap.
  int gap = 0;
  int begin = 0;
  for (int c = 0, empty = 0; c < 2 * circle; ++c) {
    empty = first[static_cast<std::size_t>(c % circle)] == kNone ? empty + 1 : 0;
    if (empty > gap) {
      gap = empty;
      begin = (c + 1) % circle;
    }
  }
  is_full_circle_ = gap == 0;
  columns_ = circle - gap;
  const int lowest = *std::ranges::min_element(first);
  const int highest = *std::ranges::max_element(end);
  for (int c = 0; c < columns_; ++c) {
    const auto column = static_cast<std::size_t>((begin + c) % circle);
    const bool is_empty = first[column] == kNone;
    first_row_.push_back(is_empty ? 0 : first[column] - lowest);
    end_row_.push_back(is_empty ? 1 : end[column] - lowest);
  }
  first_azimuth_ = -mars::kPi + (begin + 0.5) * azimuth_step_;
  if (first_azimuth_ > mars::kPi) first_azimuth_ -= 2 * mars::kPi;
  first_elevation_ = -mars::kPi / 2 + (lowest + 0.5) * elevation_step_;
  slope_.resize(static_cast<std::size_t>(highest - lowest));
}

void ViewFan::set_table() {
  for (std::size_t r = 0; r < slope_.size(); ++r) {
    slope_[r] = std::tan(first_elevation_ + static_cast<double>(r) * elevation_step_);
    length_.push_back(static_cast<float>(std::hypot(1.0, slope_[r])));
  }
  slope_.push_back(std::numeric_limits<double>::infinity());
  rounded_slope_.assign(slope_.begin(), slope_.end());
}

std::int64_t ViewFan::sample_count() const {
  return std::accumulate(end_row_.begin(), end_row_.end(), std::int64_t{0}) -
         std::accumulate(first_row_.begin(), first_row_.end(), std::int64_t{0});
}

FanSamples ViewFan::samples(const float* range_m) const {
  FanSamples s;
  s.north = north_;
  s.east = east_;
  s.up = up_;
  s.first_azimuth = first_azimuth_;
  s.azimuth_step = azimuth_step_;
  s.first_elevation = first_elevation_;
  s.elevation_step = elevation_step_;
  s.columns = columns_;
  s.is_full_circle = is_full_circle_;
  s.range_m = range_m;
  s.first_row = first_row_.data();
  s.end_row = end_row_.data();
  return s;
}

ColumnBatch ViewFan::batch(float* range_m) const {
  ColumnBatch batch;
  batch.rows.kind = RowKind::kTable;
  batch.rows.count = rows();
  batch.rows.slope = rounded_slope_.data();
  batch.rows.slope_exact = slope_.data();
  batch.rows.length = length_.data();
  batch.rows.first_elevation = first_elevation_;
  batch.rows.elevation_step = elevation_step_;
  batch.columns = columns_;
  batch.out = range_m;
  batch.stride = columns_;
  batch.set_column = [this](int column, ColumnGroup& group, int lane, glm::dvec3& direction) {
    const double angle = azimuth(column);
    direction = std::cos(angle) * north_ + std::sin(angle) * east_;
    group.row[lane] = static_cast<float>(first_row_[static_cast<std::size_t>(column)]);
    group.row_end[lane] = static_cast<float>(end_row_[static_cast<std::size_t>(column)]);
  };
  return batch;
}

}  // namespace vpe::voxel
