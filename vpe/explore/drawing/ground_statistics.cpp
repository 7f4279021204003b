#include "vpe/explore/drawing/ground_statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <stdexcept>

#include "lod/tree/posts.h"
#include "vpe/explore/drawing/facet_walk.h"
#include "vpe/explore/drawing/ground_volume.h"
#include "vpe/explore/drawing/rim_surface.h"
#include "vpe/explore/drawing/sphere_polygon.h"

namespace vpe::explore {

namespace {

using Triangle = std::array<glm::dvec3, 3>;

constexpr double kSlopeBin_deg = 0.01;
constexpr double kThinnest_m = 1e-3;  // of a part of a facet whose slope counts as the steepest

// Hands on facets, and what each tile is made of.
class Triangles : public FacetVisitor {
 public:
  // Describes where a triangle is from.
  struct Origin {
    bool is_nodata = false;
    bool is_synthetic = false;
    int level = 0;
  };
  using Take = std::function<void(const Triangle& corners_m, const Origin& origin, int winding)>;

  Triangles(const paging::Surface& surface, double cells, const std::function<void(double)>& progress,
            Take take)
      : surface_(surface), cells_(cells), progress_(progress), take_(std::move(take)) {}

  void block(const paging::SurfaceTile& tile, int i0, int i1, int j0, int j1, int winding) override {
    note(static_cast<double>(i1 - i0) * (j1 - j0));
    for (int j = j0; j < j1; ++j) {
      for (int i = i0; i < i1; ++i) {
        const Origin origin = origin_of(tile, i, j);
        const glm::dvec3 low = post_m(tile, i, j);
        const glm::dvec3 high = post_m(tile, i + 1, j + 1);
        take_({low, post_m(tile, i + 1, j), high}, origin, winding);
        take_({low, high, post_m(tile, i, j + 1)}, origin, winding);
      }
    }
  }
  std::optional<double> resampling_max_m() const { return resampling_max_m_; }

  void part(const paging::SurfaceTile& tile, int i, int j, std::span<const glm::dvec3> piece_m) override {
    note(0.5);
    const Origin origin = origin_of(tile, i, j);
    for (std::size_t n = 2; n < piece_m.size(); ++n) take_({piece_m[0], piece_m[n - 1], piece_m[n]}, origin, 1);
  }

 private:
  void note(double cells) {
    done_ += cells;
    if (!progress_ || done_ - told_ < cells_ / 200) return;
    told_ = done_;
    progress_(std::min(1.0, done_ / cells_));
  }

  glm::dvec3 post_m(const paging::SurfaceTile& tile, int i, int j) const {
    const double u = tile.lines.u[static_cast<std::size_t>(i)];
    const double v = tile.lines.v[static_cast<std::size_t>(j)];
    const double w = lod::inverse_depth(u, v, tile.data.posts.at(i, j), surface_.planet_radius_m());
    return mars::cube_point(tile.data.posts.key.face, u, v) / w;
  }

  Origin origin_of(const paging::SurfaceTile& tile, int i, int j) {
    const lod::Posts& posts = tile.data.posts;
    const auto side = static_cast<std::size_t>(posts.side());
    const std::size_t at = static_cast<std::size_t>(j) * side + static_cast<std::size_t>(i);
    Origin origin{false, false, static_cast<int>(posts.key.level)};
    for (const std::size_t post : {at, at + 1, at + side, at + side + 1})
      origin.is_nodata = origin.is_nodata || (!tile.data.nodata.empty() && tile.data.nodata[post]);
    if (key_ != posts.key) {
      key_ = posts.key;
      // Coarser tiles that stand for finer ones have no sources of their own.
      const lod::TileInfo* info = surface_.planet().tree().find(posts.key);
      sources_ = info == nullptr || info->has_children ? nullptr : surface_.sources(posts.key);
      if (sources_ != nullptr)
        for (const paging::SourceResampling& of : sources_->resampling)
          if (of.error.posts > 0) resampling_max_m_ = std::max(resampling_max_m_.value_or(0), of.error.max_m);
    }
    if (sources_ == nullptr) return origin;
    const std::optional<int> source = sources_->at(at);
    origin.is_synthetic =
        source && surface_.planet().meta().sources.at(static_cast<std::size_t>(*source)).illustration;
    return origin;
  }

  const paging::Surface& surface_;
  double cells_;
  const std::function<void(double)>& progress_;
  Take take_;
  double done_ = 0;
  double told_ = 0;
  std::optional<lod::TileKey> key_;
  std::shared_ptr<const paging::TileSources> sources_;
  std::optional<double> resampling_max_m_;
};

// A level frame whose origin is on the planet's sphere.
struct LevelFrame {
  mars::LocalFrame axes;
  glm::dvec3 origin_m;

  LevelFrame(mars::LonLat middle, double radius_m)
      : axes(mars::local_frame(middle)), origin_m(radius_m * axes.up) {}
  glm::dvec3 in_frame(const glm::dvec3& point_m) const {
    const glm::dvec3 off_m = point_m - origin_m;
    return {glm::dot(off_m, axes.east), glm::dot(off_m, axes.north), glm::dot(off_m, axes.up)};
  }
  // Returns where a direction meets the level plane through the origin, in radii. Great circles are straight there.
  glm::dvec2 seen(const glm::dvec3& direction) const {
    const double up = glm::dot(direction, axes.up);
    return glm::dvec2(glm::dot(direction, axes.east), glm::dot(direction, axes.north)) / up;
  }
};

// Sums heights and slopes over the area on the sphere.
class SlopeSum {
 public:
  SlopeSum(double radius_m, GroundStatistics& out) : radius_m_(radius_m), out_(out) {
    out_.lowest_m = std::numeric_limits<double>::infinity();
    out_.highest_m = -out_.lowest_m;
  }

  void add(const Triangle& t, const Triangles::Origin& origin, double sign) {
    const double area_m2 = sign * solid_angle(t) * radius_m_ * radius_m_;
    const glm::dvec3 twice_m2 = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double facet_m2 = glm::length(twice_m2) / 2;
    if (!(facet_m2 > 0)) return;
    const glm::dvec3 up = glm::normalize(t[0] + t[1] + t[2]);
    const double rise = std::abs(glm::dot(twice_m2, up));
    const double slope_deg = std::atan2(glm::length(glm::cross(twice_m2, up)), rise) / mars::kRadiansPerDegree;
    out_.area_m2 += std::copysign(facet_m2, area_m2);
    out_.sphere_area_m2 += area_m2;
    out_.mean_slope_deg += area_m2 * slope_deg;
    out_.rms_slope_deg += area_m2 * slope_deg * slope_deg;
    // The normals of slivers that the outline cuts off are rounding.
    const double longest_m =
        std::max({glm::length(t[1] - t[0]), glm::length(t[2] - t[0]), glm::length(t[2] - t[1])});
    if (facet_m2 > kThinnest_m * longest_m) out_.steepest_deg = std::max(out_.steepest_deg, slope_deg);
    bins_[std::min(bins_.size() - 1, static_cast<std::size_t>(slope_deg / kSlopeBin_deg))] += area_m2;
    for (std::size_t n = 0; n < 3; ++n) {
      const double height_m = glm::length(t[n]) - radius_m_;
      out_.lowest_m = std::min(out_.lowest_m, height_m);
      out_.highest_m = std::max(out_.highest_m, height_m);
      // A facet bulges towards the centre between its corners; the middles of edges see that.
      out_.mean_m += area_m2 * (glm::length((t[n] + t[(n + 1) % 3]) / 2.0) - radius_m_) / 3;
    }
    if (origin.is_nodata) out_.nodata_share += area_m2;
    if (origin.is_synthetic) synthetic_m2_ += area_m2;
  }

  void finish(std::span<const double> limits_deg) {
    const double area_m2 = out_.sphere_area_m2;
    for (double* mean : {&out_.mean_slope_deg, &out_.rms_slope_deg, &out_.mean_m, &out_.nodata_share})
      *mean /= area_m2;
    out_.rms_slope_deg = std::sqrt(std::max(0.0, out_.rms_slope_deg));
    if (out_.is_exact) out_.synthetic_share = synthetic_m2_ / area_m2;
    out_.median_slope_deg = percentile_deg(0.5);
    out_.slope_90_deg = percentile_deg(0.9);
    for (const double limit_deg : limits_deg) {
      double steeper_m2 = 0;
      for (std::size_t n = 0; n < bins_.size(); ++n)
        if ((static_cast<double>(n) + 0.5) * kSlopeBin_deg > limit_deg) steeper_m2 += bins_[n];
      out_.steeper_share.push_back(std::clamp(steeper_m2 / area_m2, 0.0, 1.0));
    }
    // Where a clockwise outline made everything negative.
    out_.area_m2 = std::abs(out_.area_m2);
    out_.sphere_area_m2 = std::abs(area_m2);
  }

 private:
  double percentile_deg(double share) const {
    double sum_m2 = 0;
    for (std::size_t n = 0; n < bins_.size(); ++n) {
      sum_m2 += bins_[n];
      if (sum_m2 / out_.sphere_area_m2 >= share) return (static_cast<double>(n) + 0.5) * kSlopeBin_deg;
    }
    return 90;
  }

  double radius_m_;
  GroundStatistics& out_;
  std::vector<double> bins_ = std::vector<double>(9001, 0.0);
  double synthetic_m2_ = 0;
};

// Returns the ground along the outline as a surface, or nullopt for outlines without extent.
std::optional<RimSurface> rim_of(const paging::Surface& surface, std::span<const glm::dvec3> polygon,
                                 const LevelFrame& frame, double spacing_m) {
  constexpr double kMostCorners = 400;
  const double length_m = outline_length_rad(polygon) * surface.planet_radius_m();
  const double step_m = std::max(spacing_m, length_m / kMostCorners);
  std::vector<glm::dvec2> outline;
  std::vector<double> heights_m;
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    const glm::dvec3& from = polygon[n];
    const glm::dvec3& to = polygon[n + 1 == polygon.size() ? 0 : n + 1];
    const double angle_rad = mars::angle_between_rad(from, to);
    const int steps = std::max(1, static_cast<int>(std::ceil(angle_rad * surface.planet_radius_m() / step_m)));
    for (int k = 0; k < steps; ++k) {
      const glm::dvec3 at = glm::normalize(glm::mix(from, to, static_cast<double>(k) / steps));
      const glm::dvec2 seen = frame.seen(at);
      if (!outline.empty() && glm::length(seen - outline.back()) == 0) continue;
      outline.push_back(seen);
      heights_m.push_back(surface.at(at).height_m);
    }
  }
  try {
    return RimSurface(outline, heights_m);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

// A clockwise outline makes all volumes negative.
GroundVolume positive(const GroundVolume& volume, double sign) {
  return {sign * volume.above_m3, sign * volume.below_m3, sign * volume.area_above_m2,
          sign * volume.area_below_m2};
}

glm::dvec3 middle_of(std::span<const glm::dvec3> polygon) {
  glm::dvec3 sum(0);
  for (const glm::dvec3& corner : polygon) sum += corner;
  return glm::normalize(sum);
}

}  // namespace

std::string why_no_statistics(std::span<const glm::dvec3> polygon) {
  if (polygon.size() < 3) return "a polygon has at least three corners";
  const double length_rad = outline_length_rad(polygon);
  if (!(std::abs(signed_sphere_area(polygon)) > 4 * kSphereAreaError * length_rad))
    return "the polygon has no area";
  const glm::dvec3 middle = middle_of(polygon);
  for (const glm::dvec3& corner : polygon) {
    if (!(mars::angle_between_rad(middle, corner) <= kLargestStatistics_rad))
      return "the polygon is too large for a plane and volumes: its corners may be half a radian from their middle";
  }
  return "";
}

std::optional<GroundStatistics> ground_statistics(const paging::Surface& surface,
                                                  std::span<const glm::dvec3> polygon,
                                                  const GroundStatisticsOptions& options,
                                                  const std::stop_token& stop) {
  if (const std::string why = why_no_statistics(polygon); !why.empty()) throw std::invalid_argument(why);
  if (options.other && options.other->planet_radius_m() != surface.planet_radius_m())
    throw std::invalid_argument("the other planet has another radius");
  const glm::dvec3 middle = middle_of(polygon);
  const paging::PlanetMeta& meta = surface.planet().meta();
  const double radius_m = surface.planet_radius_m();
  GroundStatistics out;
  out.middle = mars::lon_lat(middle);
  int level = 0;
  double cells = count_cells(surface.planet(), polygon, 0, options.most_cells);
  for (; level < meta.finest_level; ++level) {
    if (stop.stop_requested()) return std::nullopt;
    const double next = count_cells(surface.planet(), polygon, level + 1, options.most_cells);
    if (next > options.most_cells) break;
    cells = next;
  }
  out.is_exact = level == meta.finest_level;

  double share_before = 0;
  std::function<void(double)> progress;
  if (options.progress) progress = [&](double done) { options.progress(share_before + done / 2); };
  const LevelFrame frame(out.middle, radius_m);
  glm::dvec2 low_m(std::numeric_limits<double>::infinity());
  glm::dvec2 high_m(-low_m);
  for (const glm::dvec3& corner : polygon) {
    low_m = glm::min(low_m, glm::dvec2(frame.in_frame(radius_m * corner)));
    high_m = glm::max(high_m, glm::dvec2(frame.in_frame(radius_m * corner)));
  }
  PlaneFit fit(low_m, high_m);
  SlopeSum slopes(radius_m, out);
  int finest = 0;
  Triangles first(surface, std::max(1.0, cells), progress,
                  [&](const Triangle& t, const Triangles::Origin& origin, int winding) {
                    finest = std::max(finest, origin.level);
                    for (int n = 0; n < std::abs(winding); ++n)
                      fit.add(frame.in_frame(t[0]), frame.in_frame(t[winding > 0 ? 1 : 2]),
                              frame.in_frame(t[winding > 0 ? 2 : 1]));
                    slopes.add(t, origin, winding);
                  });
  if (!walk_facets(surface, polygon, level, first, stop)) return std::nullopt;
  const double sign = out.sphere_area_m2 < 0 ? -1 : 1;
  if (out.is_exact) out.resampling_max_m = first.resampling_max_m();
  slopes.finish(options.slope_limits_deg);
  out.spacing_m = lod::post_spacing_m(finest, meta.tile.intervals(), radius_m);
  out.plane = fit.plane();

  std::vector<std::pair<VolumeSum, std::optional<GroundVolume>*>> volumes;
  if (out.plane) {
    const FittedPlane& plane = *out.plane;
    const glm::dvec3 normal =
        frame.axes.up - plane.slope.x * frame.axes.east - plane.slope.y * frame.axes.north;
    const double offset_m = glm::dot(normal, frame.origin_m) + plane.height_m;
    const auto plane_m = [normal, offset_m](const glm::dvec3& p) {
      return offset_m * glm::length(p) / glm::dot(normal, p);
    };
    // A plane so steep that rays from the centre miss it has no radius.
    const bool is_met = std::ranges::all_of(polygon, [&](const glm::dvec3& corner) {
      return glm::dot(normal, corner) > 0.01 * glm::length(normal);
    });
    if (is_met) volumes.emplace_back(VolumeSum(plane_m, true, radius_m), &out.over_plane);
  }
  const std::optional<RimSurface> rim = rim_of(surface, polygon, frame, out.spacing_m);
  if (rim)
    volumes.emplace_back(
        VolumeSum([&](const glm::dvec3& p) { return radius_m + rim->at(frame.seen(p)); }, false, radius_m),
        &out.over_rim);
  if (options.level_m)
    volumes.emplace_back(
        VolumeSum([at_m = radius_m + *options.level_m](const glm::dvec3&) { return at_m; }, false, radius_m),
        &out.over_level);
  if (options.other)
    volumes.emplace_back(
        VolumeSum([&](const glm::dvec3& p) { return radius_m + options.other->at(p).height_m; }, false,
                  radius_m),
        &out.over_other);
  share_before = 0.5;
  Triangles second(surface, std::max(1.0, cells), progress,
                   [&](const Triangle& t, const Triangles::Origin&, int winding) {
                     const Triangle turned{t[0], t[2], t[1]};
                     for (auto& volume : volumes)
                       for (int n = 0; n < std::abs(winding); ++n) volume.first.add(winding > 0 ? t : turned);
                   });
  if (!walk_facets(surface, polygon, level, second, stop)) return std::nullopt;
  for (auto& [sum, into] : volumes) *into = positive(sum.sum(), sign);
  return out;
}

}  // namespace vpe::explore
