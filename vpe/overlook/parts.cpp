#include "vpe/overlook/parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "mars/geodesy/sphere.h"
#include "panorama/viewer/viewer.h"

namespace vpe::overlook {

namespace {

using panorama::LevelGrid;
using panorama::PanoramaMap;

// Larger rectangles are divided before their footprints are looked at.
constexpr double kWidest_rad = 0.2;
// Footprints between those looked at may be that much smaller or larger.
constexpr double kMargin = 1.02;
constexpr int kMostDivisions = 48;

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

// What the footprints of a part's pixels are, in pixels of the image.
struct Footprints {
  Range thin;     // Footprint::thin_px
  Range longest;  // Footprint::longest_px
  Range length;   // of their longer side, in widths of a sample
  Range bare;     // the shorter side, which a sample is at least as wide as, and at least 1
};

class Chooser {
 public:
  Chooser(const PanoramaMap& map, std::span<const LevelGrid> grids, const core::View& view,
          const PartOptions& options, const std::function<bool(const TextureKey&)>& is_ready)
      : map_(map),
        grids_(grids),
        view_(view),
        options_(options),
        is_ready_(is_ready),
        sides_(core::side_planes(view)),
        focal_px_(core::focal_px(view)),
        corner_stretch_(core::corner_stretch(view)) {}

  std::vector<Part> run() {
    const auto height_px = static_cast<double>(map_.height_px);
    const auto width_px = static_cast<double>(map_.width_px);
    const double end_px = width_px > map_.turn_px - 1.0 ? map_.turn_px : width_px;
    if (map_.kind != panorama::MapKind::kFacets) {
      // Quarters of the circle, so that none is wider than a cap can be.
      for (int n = 0; n < 4; ++n) look_at({n * end_px / 4, 0, (n + 1) * end_px / 4, height_px}, 0, 0);
      return std::move(parts_);
    }
    double left = 0;
    const double facet_px = map_.facet_px();
    double next = (std::floor(map_.crop_left_px / facet_px + 1e-12) + 1) * facet_px - map_.crop_left_px;
    while (left < end_px - 1e-9) {
      const double right = std::min(next, end_px);
      look_at({left, 0, right, height_px}, facet_of(map_, 0.5 * (left + right)), 0);
      left = right;
      next += facet_px;
    }
    return std::move(parts_);
  }

 private:
  bool is_hidden(const Cap& cap) const {
    if (cap.radius_rad >= 0.5 * mars::kPi) return false;
    const double reach = std::sin(cap.radius_rad);
    return std::any_of(sides_.begin(), sides_.end(),
                       [&](const core::Plane& side) { return glm::dot(side.normal, cap.axis) < -reach; });
  }

  void divide(const Rectangle& r, int facet, int divisions) {
    const glm::dvec2 sides = sides_rad(map_, facet, r);
    const double x = 0.5 * (r.left + r.right);
    const double y = 0.5 * (r.top + r.bottom);
    if (sides.x > sides.y) {
      look_at({r.left, r.top, x, r.bottom}, facet, divisions + 1);
      look_at({x, r.top, r.right, r.bottom}, facet, divisions + 1);
    } else {
      look_at({r.left, r.top, r.right, y}, facet, divisions + 1);
      look_at({r.left, y, r.right, r.bottom}, facet, divisions + 1);
    }
  }

  // Adds the footprints of the view's pixels at a place.
  void add_footprint(int facet, double x, double y, Footprints& footprints) const {
    const glm::dvec3 direction = glm::normalize(direction_vector(map_, facet, x, y));
    const core::Projected p = core::project(view_, view_.camera.position_m + direction);
    if (p.behind) return;
    const auto place = [&](double px, double py) {
      return map_.place(panorama::to_direction(core::pixel_ray(view_, px, py)));
    };
    const glm::dvec2 here = place(p.xy.x, p.xy.y);
    const auto to = [&](const glm::dvec2& there) {
      return glm::dvec2(std::remainder(there.x - here.x, map_.turn_px), there.y - here.y);
    };
    const glm::dvec2 across = to(place(p.xy.x + 1, p.xy.y));
    const glm::dvec2 down = to(place(p.xy.x, p.xy.y + 1));
    const panorama::Footprint footprint = panorama::footprint_of(across, down);
    if (!std::isfinite(footprint.thin_px)) return;
    footprints.thin.add(footprint.thin_px);
    footprints.longest.add(footprint.longest_px);
    footprints.length.add(footprint.longest_px / footprint.thin_px);
    const double area_px2 = std::abs(across.x * down.y - across.y * down.x);
    if (footprint.longest_px > 0) footprints.bare.add(area_px2 / footprint.longest_px);
  }

  void look_at(const Rectangle& r, int facet, int divisions) {
    const Cap cap = cap_of(map_, facet, r);
    if (is_hidden(cap)) return;
    const glm::dvec2 sides = sides_rad(map_, facet, r);
    const double longer = std::max(sides.x, sides.y);
    if (longer > kWidest_rad && divisions < kMostDivisions) {
      divide(r, facet, divisions);
      return;
    }
    Footprints footprints;
    for (const double s : {0.0, 0.5, 1.0}) {
      for (const double t : {0.0, 0.5, 1.0})
        add_footprint(facet, std::lerp(r.left, r.right, s), std::lerp(r.top, r.bottom, t), footprints);
    }
    const int coarsest = static_cast<int>(grids_.size()) - 1;
    const bool is_seen = footprints.longest.high > 0;
    if (!is_seen) footprints.thin = {1e300, 1e300};
    const bool is_enlarged = is_seen && footprints.longest.high * kMargin <= 1.0;
    // Samples one pixel wide are all of the image itself.
    const bool is_of_image = is_enlarged || (is_seen && footprints.bare.high * kMargin <= 1.0 &&
                                             footprints.longest.high * kMargin <= panorama::kMostSamples);
    const double length = footprints.length.high * kMargin * kMargin;
    most_samples_ = !is_seen || length - 1e-3 > 2 ? 16 : length - 1e-3 > 1 ? 2 : 1;
    const int finest = panorama::level_of_footprint(grids_, footprints.thin.low / kMargin);
    const int last =
        is_of_image
            ? 0
            : std::min(coarsest, panorama::level_of_footprint(grids_, footprints.thin.high * kMargin) + 1);
    const bool is_small = longer * focal_px_ < 1.0;
    if (last - finest >= static_cast<int>(Part::kMostLevels) && !is_small && divisions < kMostDivisions) {
      divide(r, facet, divisions);
      return;
    }
    const double off_axis_rad =
        std::acos(std::clamp(glm::dot(cap.axis, view_.camera.axes.forward), -1.0, 1.0)) + cap.radius_rad;
    const double cosine = off_axis_rad < 0.5 * mars::kPi ? std::cos(off_axis_rad) : 0.0;
    const double stretch = cosine * cosine * corner_stretch_ > 1.0 ? 1.0 / (cosine * cosine) : corner_stretch_;
    allowed_rad_ = options_.shift_px / (focal_px_ * stretch);
    add(r, facet, finest, std::min(last, finest + static_cast<int>(Part::kMostLevels) - 1), is_enlarged);
  }

  // Returns the places where textures of a level begin, along x or y.
  void add_borders(int level, bool is_x, double low, double high, std::vector<double>& borders) const {
    const LevelGrid& grid = grids_[static_cast<std::size_t>(level)];
    const double scale = is_x ? grid.scale.x : grid.scale.y;
    const double origin = is_x ? grid.origin_px.x : grid.origin_px.y;
    const std::int64_t first = is_x ? grid.left : grid.top;
    const std::int64_t last = is_x ? grid.right : grid.bottom;
    const auto from = static_cast<std::int64_t>(
        std::floor(((low + origin) * scale - static_cast<double>(first)) / kTextureSide_px));
    for (std::int64_t n = std::max<std::int64_t>(from, 0) + 1; first + n * kTextureSide_px <= last; ++n) {
      const double at = static_cast<double>(first + n * kTextureSide_px) / scale - origin;
      if (at >= high) break;
      if (at > low) borders.push_back(at);
    }
  }

  std::int64_t square_of(const LevelGrid& grid, bool is_x, double at) const {
    const std::int64_t first = is_x ? grid.left : grid.top;
    const std::int64_t last = is_x ? grid.right : grid.bottom;
    const double place = is_x ? (at + grid.origin_px.x) * grid.scale.x : (at + grid.origin_px.y) * grid.scale.y;
    const auto square =
        static_cast<std::int64_t>(std::floor((place - static_cast<double>(first)) / kTextureSide_px));
    return std::clamp<std::int64_t>(square, 0, (last - first) / kTextureSide_px);
  }

  std::vector<double> lines(int finest, int last, bool is_x, double low, double high) const {
    std::vector<double> lines{low};
    for (int level = finest; level <= last; ++level) add_borders(level, is_x, low, high, lines);
    lines.push_back(high);
    std::sort(lines.begin(), lines.end());
    // Borders of two levels that differ by rounding are one.
    const auto end = std::unique(lines.begin(), lines.end(), [](double a, double b) { return b - a < 1e-6; });
    lines.erase(end, lines.end());
    lines.back() = high;
    return lines;
  }

  void add(const Rectangle& r, int facet, int finest, int last, bool is_enlarged) {
    const std::vector<double> xs = lines(finest, last, true, r.left, r.right);
    const std::vector<double> ys = lines(finest, last, false, r.top, r.bottom);
    const int coarsest = static_cast<int>(grids_.size()) - 1;
    for (std::size_t row = 0; row + 1 < ys.size(); ++row) {
      for (std::size_t column = 0; column + 1 < xs.size(); ++column) {
        Part added;
        added.rectangle = {xs[column], ys[row], xs[column + 1], ys[row + 1]};
        added.facet = facet;
        if (is_hidden(cap_of(map_, facet, added.rectangle))) continue;
        bool is_ready = true;
        for (int level = finest; level <= last; ++level) {
          const LevelGrid& grid = grids_[static_cast<std::size_t>(level)];
          added.textures.push_back(
              {level, square_of(grid, true, 0.5 * (added.rectangle.left + added.rectangle.right)),
               square_of(grid, false, 0.5 * (added.rectangle.top + added.rectangle.bottom))});
          is_ready = is_ready && (level == coarsest || is_ready_(added.textures.back()));
        }
        if (!is_ready) {
          add(added.rectangle, facet, finest + 1, std::max(last, finest + 1), is_enlarged);
          continue;
        }
        added.is_enlarged = is_enlarged;
        added.most_samples = is_enlarged ? 1 : most_samples_;
        added.cuts = cuts_of(map_, added.rectangle, allowed_rad_);
        parts_.push_back(std::move(added));
      }
    }
  }

  const PanoramaMap& map_;
  std::span<const LevelGrid> grids_;
  const core::View& view_;
  const PartOptions& options_;
  const std::function<bool(const TextureKey&)>& is_ready_;
  std::array<core::Plane, 4> sides_;
  double focal_px_;
  double corner_stretch_;
  double allowed_rad_ = 0;  // of the rectangle that is looked at
  int most_samples_ = 16;   // likewise
  std::vector<Part> parts_;
};

}  // namespace

std::vector<Part> choose_parts(const PanoramaMap& map, std::span<const LevelGrid> grids, const core::View& view,
                               const PartOptions& options,
                               const std::function<bool(const TextureKey&)>& is_ready) {
  return Chooser(map, grids, view, options, is_ready).run();
}

}  // namespace vpe::overlook
