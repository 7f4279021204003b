#include "vpe/app/planet/info/source_coverage.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "lod/tree/posts.h"
#include "mars/geodesy/cube.h"
#include "paging/surface/surface.h"
#include "vpe/app/planet/info/tile_area.h"

namespace vpe::app {

namespace {

constexpr int kMapWidth = 512;
constexpr int kMapHeight = 256;
constexpr std::size_t kMostItems = 256;

// Sums for one source, or for what has none.
struct AreaSum {
  double area_sr = 0;
  glm::dvec3 direction{0, 0, 0};

  void add(double area, const glm::dvec3& d) {
    area_sr += area;
    direction += d * area;
  }
  void include(const AreaSum& other) {
    area_sr += other.area_sr;
    direction += other.direction;
  }
};

// Of each source, then of nodata and of what is not known.
using AreaSums = std::vector<AreaSum>;

// Knows the source of each post of a finest tile.
class PostSources {
 public:
  PostSources(const paging::PlanetFile& planet, const lod::TileKey& key,
              std::shared_ptr<const paging::TileSources> sources)
      : sources_(std::move(sources)) {
    if (sources_->of_post.empty() && planet.has_nodata(key)) nodata_ = planet.heights(key).nodata;
  }
  bool is_uniform() const { return sources_->of_post.empty() && nodata_.empty(); }
  std::int16_t at(std::size_t post) const {
    if (!nodata_.empty() && nodata_[post]) return kNoSource;
    if (!sources_->of_post.empty() && sources_->of_post[post] == 0) return kNoSource;
    const std::optional<int> source = sources_->at(post);
    return source ? static_cast<std::int16_t>(*source) : kUnknownSource;
  }

 private:
  std::shared_ptr<const paging::TileSources> sources_;
  std::vector<bool> nodata_;
};

std::size_t slot(std::int16_t source, std::size_t count) {
  if (source == kNoSource) return count;
  return source == kUnknownSource ? count + 1 : static_cast<std::size_t>(source);
}

// Half the distance of both neighbouring lines, at the ends that of the only one.
double width_at(const std::vector<double>& lines, std::size_t n) {
  const double low = n == 0 ? lines[n] : lines[n - 1];
  const double high = n + 1 == lines.size() ? lines[n] : lines[n + 1];
  return 0.5 * (high - low);
}

// Calls visit(source, area, direction) for the posts of a tile; once with its middle where all have one source.
template <class Visit>
void visit_posts(const paging::PlanetFile& planet, const lod::TileKey& key, const Visit& visit) {
  const PostSources sources(planet, key, std::make_shared<const paging::TileSources>(planet.sources(key)));
  const double area_sr = tile_area_sr(key);
  if (sources.is_uniform()) {
    const lod::GridLines middle = lod::grid_lines(key, 2);
    visit(sources.at(0), area_sr, mars::chart_direction(key.face, middle.u[1], middle.v[1]));
    return;
  }
  const lod::GridLines lines = lod::grid_lines(key, planet.meta().tile.intervals());
  const auto density = [](double u, double v) { return std::pow(u * u + v * v + 1, -1.5); };
  double sum = 0;
  for (std::size_t j = 0; j < lines.v.size(); ++j)
    for (std::size_t i = 0; i < lines.u.size(); ++i)
      sum += width_at(lines.u, i) * width_at(lines.v, j) * density(lines.u[i], lines.v[j]);
  for (std::size_t j = 0; j < lines.v.size(); ++j) {
    for (std::size_t i = 0; i < lines.u.size(); ++i) {
      const double part = width_at(lines.u, i) * width_at(lines.v, j) * density(lines.u[i], lines.v[j]) / sum;
      visit(sources.at(j * lines.u.size() + i), part * area_sr,
            mars::chart_direction(key.face, lines.u[i], lines.v[j]));
    }
  }
}

class CoverageMaker {
 public:
  CoverageMaker(const std::shared_ptr<const paging::PlanetFile>& planet, std::size_t budget_bytes,
                base::ThreadPool& pool)
      : planet_(*planet), surface_(planet, budget_bytes), pool_(pool), count_(planet->meta().sources.size()) {
    for (const lod::TileInfo& tile : planet_.tree().tiles())
      if (!tile.has_children) leaves_.push_back(tile.key);
  }

  SourceCoverage make(const std::function<void(double)>& tell) {
    SourceCoverage out;
    const AreaSums sums = sum_areas();
    if (tell) tell(0.5);
    for (std::size_t n = 0; n < count_; ++n) {
      CoveredArea area;
      area.share = sums[n].area_sr / (4 * mars::kPi);
      if (glm::length(sums[n].direction) > 0) area.middle = mars::lon_lat(sums[n].direction);
      out.sources.push_back(area);
    }
    out.nodata_share = sums[count_].area_sr / (4 * mars::kPi);
    out.unknown_share = sums[count_ + 1].area_sr / (4 * mars::kPi);
    out.map = draw_map();
    return out;
  }

 private:
  // The number of items does not depend on the threads, so that the order of the sums does not either.
  AreaSums sum_areas() {
    const std::size_t items = std::min(kMostItems, leaves_.size());
    std::vector<AreaSums> parts(items, AreaSums(count_ + 2));
    pool_.run(items, [&](std::size_t item) {
      for (std::size_t n = item * leaves_.size() / items; n < (item + 1) * leaves_.size() / items; ++n)
        visit_posts(planet_, leaves_[n], [&](std::int16_t source, double area_sr, const glm::dvec3& d) {
          parts[item][slot(source, count_)].add(area_sr, d);
        });
    });
    AreaSums sums(count_ + 2);
    for (const AreaSums& part : parts)
      for (std::size_t n = 0; n < sums.size(); ++n) sums[n].include(part[n]);
    return sums;
  }

  SourceMap draw_map() {
    SourceMap map{kMapWidth, kMapHeight, {}};
    map.source.resize(static_cast<std::size_t>(kMapWidth) * static_cast<std::size_t>(kMapHeight));
    pool_.run(static_cast<std::size_t>(kMapHeight), [&](std::size_t y) {
      std::optional<lod::TileKey> held;
      std::optional<PostSources> sources;
      for (std::size_t x = 0; x < static_cast<std::size_t>(kMapWidth); ++x) {
        const mars::LonLat place{(static_cast<double>(x) + 0.5) * 360 / kMapWidth - 180,
                                 90 - (static_cast<double>(y) + 0.5) * 180 / kMapHeight};
        const mars::ChartPoint point = mars::chart_point(mars::direction(place));
        const lod::TileKey key = planet_.tree().deepest(lod::tile_at(point, planet_.meta().finest_level)).key;
        if (!held || !(*held == key)) {
          held = key;
          sources.emplace(planet_, key, surface_.sources(key));
        }
        map.source[y * static_cast<std::size_t>(kMapWidth) + x] = sources->at(nearest(key, point));
      }
    });
    return map;
  }

  std::size_t nearest(const lod::TileKey& key, const mars::ChartPoint& point) const {
    const int intervals = planet_.meta().tile.intervals();
    const auto line = [&](double x, std::int32_t index) {
      const double at = mars::face_parameter(x) * std::ldexp(1.0, key.level) - index;
      return static_cast<std::size_t>(std::lround(std::clamp(at, 0.0, 1.0) * intervals));
    };
    return line(point.v, key.j) * static_cast<std::size_t>(intervals + 1) + line(point.u, key.i);
  }

  const paging::PlanetFile& planet_;
  paging::Surface surface_;
  base::ThreadPool& pool_;
  std::size_t count_;
  std::vector<lod::TileKey> leaves_;
};

}  // namespace

SourceCoverage source_coverage(const std::shared_ptr<const paging::PlanetFile>& planet,
                               std::size_t budget_bytes, base::ThreadPool& pool,
                               const std::function<void(double)>& tell) {
  return CoverageMaker(planet, budget_bytes, pool).make(tell);
}

}  // namespace vpe::app
