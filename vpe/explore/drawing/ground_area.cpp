#include "vpe/explore/drawing/ground_area.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "lod/tree/posts.h"
#include "vpe/explore/drawing/facet_walk.h"
#include "vpe/explore/drawing/sphere_polygon.h"

namespace vpe::explore {

namespace {

// Adds areas; those of clockwise parts count negative.
class AreaSum : public FacetVisitor {
 public:
  AreaSum(double radius_m, double cells, const std::function<void(double)>& progress)
      : radius_m_(radius_m), cells_(cells), progress_(progress) {}

  double area_m2() const { return area_m2_; }
  bool has_nodata() const { return has_nodata_; }
  int finest_level() const { return finest_level_; }
  // Sets the sign with which further parts count.
  void set_sign(double sign) { sign_ = sign; }

  void block(const paging::SurfaceTile& tile, int i0, int i1, int j0, int j1, int winding) override {
    note(tile, static_cast<double>(i1 - i0) * (j1 - j0));
    row_m(tile, i0, i1, j0, below_m_);
    double sum_m2 = 0;
    for (int j = j0; j < j1; ++j) {
      row_m(tile, i0, i1, j + 1, above_m_);
      for (int i = i0; i < i1; ++i) {
        const auto n = static_cast<std::size_t>(i - i0);
        const glm::dvec3 diagonal = above_m_[n + 1] - below_m_[n];
        sum_m2 += glm::length(glm::cross(below_m_[n + 1] - below_m_[n], diagonal)) +
                  glm::length(glm::cross(diagonal, above_m_[n] - below_m_[n]));
        note_nodata(tile, i, j);
      }
      std::swap(below_m_, above_m_);
    }
    area_m2_ += sign_ * winding * sum_m2 / 2;
  }

  void part(const paging::SurfaceTile& tile, int i, int j, std::span<const glm::dvec3> piece_m) override {
    note(tile, 0.5);
    note_nodata(tile, i, j);
    glm::dvec3 twice_m2{0, 0, 0};
    for (std::size_t n = 2; n < piece_m.size(); ++n)
      twice_m2 += glm::cross(piece_m[n - 1] - piece_m[0], piece_m[n] - piece_m[0]);
    area_m2_ += sign_ * std::copysign(glm::length(twice_m2) / 2, glm::dot(twice_m2, piece_m[0]));
  }

 private:
  void note(const paging::SurfaceTile& tile, double cells) {
    finest_level_ = std::max(finest_level_, static_cast<int>(tile.data.posts.key.level));
    done_ += cells;
    if (!progress_ || done_ - told_ < cells_ / 200) return;
    told_ = done_;
    progress_(std::min(1.0, done_ / cells_));
  }

  void note_nodata(const paging::SurfaceTile& tile, int i, int j) {
    if (tile.data.nodata.empty() || has_nodata_) return;
    const auto side = static_cast<std::size_t>(tile.data.posts.side());
    const std::size_t at = static_cast<std::size_t>(j) * side + static_cast<std::size_t>(i);
    for (const std::size_t post : {at, at + 1, at + side, at + side + 1})
      has_nodata_ = has_nodata_ || tile.data.nodata[post];
  }

  void row_m(const paging::SurfaceTile& tile, int i0, int i1, int j, std::vector<glm::dvec3>& posts_m) const {
    posts_m.clear();
    const double v = tile.lines.v[static_cast<std::size_t>(j)];
    for (int i = i0; i <= i1; ++i) {
      const double u = tile.lines.u[static_cast<std::size_t>(i)];
      const double w = lod::inverse_depth(u, v, tile.data.posts.at(i, j), radius_m_);
      posts_m.push_back(mars::cube_point(tile.data.posts.key.face, u, v) / w);
    }
  }

  double radius_m_;
  double cells_;
  const std::function<void(double)>& progress_;
  double sign_ = 1;
  double area_m2_ = 0;
  double done_ = 0;
  double told_ = 0;
  bool has_nodata_ = false;
  int finest_level_ = 0;
  std::vector<glm::dvec3> below_m_;
  std::vector<glm::dvec3> above_m_;
};

// Cuts a polygon into parts that each lie in half of the sphere, and the whole spheres to take away.
struct Parts {
  std::vector<std::vector<glm::dvec3>> polygons;
  int whole_spheres = 0;
};

Parts parts_of(std::span<const glm::dvec3> polygon) {
  const FanArea fan = fan_area(polygon);
  if (fan.reference == polygon.front()) return {{{polygon.begin(), polygon.end()}}, fan.whole_spheres};
  Parts parts{{}, fan.whole_spheres};
  for (std::size_t n = 0; n < polygon.size(); ++n)
    parts.polygons.push_back({fan.reference, polygon[n], polygon[(n + 1) % polygon.size()]});
  return parts;
}

double cells_of(const paging::PlanetFile& planet, const Parts& parts, int level, double most) {
  double cells = 0;
  for (const auto& part : parts.polygons) {
    cells += count_cells(planet, part, level, most);
    if (cells > most) break;
  }
  return cells;
}

}  // namespace

std::optional<GroundArea> ground_area(const paging::Surface& surface, std::span<const glm::dvec3> polygon,
                                      const GroundAreaOptions& options, const std::stop_token& stop) {
  GroundArea out;
  if (polygon.size() < 3) return out;
  const paging::PlanetMeta& meta = surface.planet().meta();
  const Parts parts = parts_of(polygon);
  int level = 0;
  double cells = cells_of(surface.planet(), parts, 0, options.most_cells);
  for (; level < meta.finest_level; ++level) {
    if (stop.stop_requested()) return std::nullopt;
    const double next = cells_of(surface.planet(), parts, level + 1, options.most_cells);
    if (next > options.most_cells) break;
    cells = next;
  }
  out.is_exact = level == meta.finest_level;
  double share_before = 0;
  double share = out.is_exact ? 1.0 : 0.2;
  std::function<void(double)> progress;
  if (options.progress) progress = [&](double done) { options.progress(share_before + done * share); };
  const auto area_at = [&](int at_level, double about_cells) -> std::optional<double> {
    AreaSum sum(surface.planet_radius_m(), std::max(1.0, about_cells), progress);
    for (const auto& part : parts.polygons)
      if (!walk_facets(surface, part, at_level, sum, stop)) return std::nullopt;
    sum.set_sign(-parts.whole_spheres);
    if (parts.whole_spheres != 0 && !walk_all_facets(surface, at_level, sum, stop)) return std::nullopt;
    out.has_nodata = sum.has_nodata();
    out.spacing_m = lod::post_spacing_m(sum.finest_level(), meta.tile.intervals(), meta.radius_m);
    return std::abs(sum.area_m2());
  };
  if (!out.is_exact) {
    const std::optional<double> coarser = area_at(std::max(0, level - 1), cells / 4);
    if (!coarser) return std::nullopt;
    out.coarser_area_m2 = *coarser;
    share_before = 0.2;
    share = 0.8;
  }
  const std::optional<double> area = area_at(level, cells);
  if (!area) return std::nullopt;
  out.area_m2 = *area;
  if (out.is_exact) out.coarser_area_m2 = out.area_m2;
  return out;
}

}  // namespace vpe::explore
