#include "paging/surface/change.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <stdexcept>

#include "paging/planet/planet_user.h"
#include "paging/surface/height_difference.h"

namespace paging {

namespace {

// Tiles that are measured before their figures are added up.
constexpr std::size_t kTilesAtOnce = 256;

struct TileChange {
  double area = 0;  // solid angles, as nodata and changed
  double nodata = 0;
  double changed = 0;
  double sum = 0;  // of differences, by solid angle
  double squares = 0;
  double gained_m3 = 0;
  double lost_m3 = 0;
  std::int64_t triangles = 0;
  std::optional<ChangeExtreme> least;
  std::optional<ChangeExtreme> most;
  std::map<double, double> weights;  // solid angle by rounded difference

  void extend(const std::optional<ChangeExtreme>& low, const std::optional<ChangeExtreme>& high) {
    if (low && (!least || low->difference_m < least->difference_m)) least = low;
    if (high && (!most || high->difference_m > most->difference_m)) most = high;
  }
  void add(const TileChange& other) {
    area += other.area;
    nodata += other.nodata;
    changed += other.changed;
    sum += other.sum;
    squares += other.squares;
    gained_m3 += other.gained_m3;
    lost_m3 += other.lost_m3;
    triangles += other.triangles;
    extend(other.least, other.most);
    for (const auto& [value, weight] : other.weights) weights[value] += weight;
  }
};

// Returns the value with 14 binary digits, so that a planet has few of them.
double rounded_difference(double value) {
  constexpr double kSteps = 16384;
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::round(mantissa * kSteps) / kSteps, exponent);
}

// Van Oosterom and Strackee 1983; differences of unit vectors keep the digits of small triangles.
double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double volume = std::abs(glm::dot(a, glm::cross(b - a, c - a)));
  return 2 * std::atan2(volume, 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

struct Post {
  glm::dvec3 direction;
  double difference_m = 0;
  double volume = 0;  // between the surfaces, for each unit of solid angle
  bool nodata = false;
};

class TileMeter {
 public:
  TileMeter(const Surface& earlier, const Surface& later, const ChangeRegion& region, double threshold_m)
      : earlier_(earlier), later_(later), region_(region), threshold_m_(threshold_m) {}

  TileChange measure(const lod::TileKey& key) const {
    TileChange out;
    if (region_.may_hold && !region_.may_hold(key)) return out;
    const int n = std::max(earlier_.planet().meta().tile.intervals(), later_.planet().meta().tile.intervals());
    const std::vector<Post> posts = take_posts(key, n);
    const auto side = static_cast<std::size_t>(n) + 1;
    for (std::size_t j = 0; j + 1 < side; ++j) {
      for (std::size_t i = 0; i + 1 < side; ++i) {
        const Post* south_west = &posts[j * side + i];
        add({south_west, south_west + 1, south_west + side + 1}, out);
        add({south_west, south_west + side + 1, south_west + side}, out);
      }
    }
    return out;
  }

 private:
  std::vector<Post> take_posts(const lod::TileKey& key, int intervals) const {
    const PostHeights before = heights_at_posts(earlier_, key, intervals);
    const PostHeights after = heights_at_posts(later_, key, intervals);
    const lod::GridLines lines = lod::grid_lines(key, intervals);
    const double radius_m = later_.planet_radius_m();
    std::vector<Post> posts;
    posts.reserve(before.height_m.size());
    for (const double v : lines.v) {
      for (const double u : lines.u) {
        const std::size_t at = posts.size();
        const double a = radius_m + before.height_m[at];
        const double b = radius_m + after.height_m[at];
        const double difference = after.height_m[at] - before.height_m[at];
        const bool nodata =
            (!before.nodata.empty() && before.nodata[at]) || (!after.nodata.empty() && after.nodata[at]);
        posts.push_back({mars::chart_direction(key.face, u, v), difference,
                         difference * ((a * a + b * b + a * b) / 3), nodata});
      }
    }
    return posts;
  }

  void add(const std::array<const Post*, 3>& p, TileChange& out) const {
    if (region_.holds && !region_.holds(glm::normalize(p[0]->direction + p[1]->direction + p[2]->direction)))
      return;
    ++out.triangles;
    const double angle = solid_angle(p[0]->direction, p[1]->direction, p[2]->direction);
    if (p[0]->nodata || p[1]->nodata || p[2]->nodata) {
      out.nodata += angle;
      return;
    }
    const double a = p[0]->difference_m;
    const double b = p[1]->difference_m;
    const double c = p[2]->difference_m;
    out.area += angle;
    for (const Post* post : p) {
      out.weights[rounded_difference(post->difference_m)] += angle / 3;
      const bool is_new = !out.least || post->difference_m < out.least->difference_m ||
                          post->difference_m > out.most->difference_m;
      if (!is_new) continue;
      const ChangeExtreme here{post->difference_m, mars::lon_lat(post->direction)};
      out.extend(here, here);
    }
    if (a == 0 && b == 0 && c == 0) return;
    out.sum += angle * (a + b + c) / 3;
    out.squares += angle * (a * a + b * b + c * c + a * b + b * c + c * a) / 6;
    out.changed += angle * (share_above(a, b, c, threshold_m_) + share_above(-a, -b, -c, threshold_m_));
    out.gained_m3 += angle * mean_of_positive_part(p[0]->volume, p[1]->volume, p[2]->volume);
    out.lost_m3 += angle * mean_of_positive_part(-p[0]->volume, -p[1]->volume, -p[2]->volume);
  }

  const Surface& earlier_;
  const Surface& later_;
  const ChangeRegion& region_;
  double threshold_m_;
};

bool has_children(const Surface& surface, const lod::TileKey& key) {
  const lod::TileInfo* tile = surface.planet().tree().find(key);
  return tile != nullptr && tile->has_children;
}

// Adds the finest tiles that either planet has below a tile.
void find_finest(const Surface& earlier, const Surface& later, const ChangeRegion& region,
                 const lod::TileKey& key, std::vector<lod::TileKey>& out) {
  if (region.may_hold && !region.may_hold(key)) return;
  if (!has_children(earlier, key) && !has_children(later, key)) {
    out.push_back(key);
    return;
  }
  for (int c = 0; c < 4; ++c) find_finest(earlier, later, region, lod::child(key, c), out);
}

// Where exactly one half lies below, the median is between two values.
std::optional<double> median_of(const std::map<double, double>& weights, double total) {
  const auto reaches = [&](auto begin, auto end) {
    double sum = 0;
    for (auto at = begin; at != end; ++at) {
      sum += at->second;
      if (2 * sum >= total) return at->first;
    }
    return 0.0;
  };
  if (weights.empty()) return std::nullopt;
  return 0.5 * (reaches(weights.begin(), weights.end()) + reaches(weights.rbegin(), weights.rend()));
}

}  // namespace

double share_above(double a, double b, double c, double above) {
  const double low = std::min({a, b, c});
  const double high = std::max({a, b, c});
  const double middle = std::max(std::min(a, b), std::min(std::max(a, b), c));
  if (low > above) return 1;
  if (high <= above) return 0;
  if (middle <= above) return (high - above) / (high - middle) * ((high - above) / (high - low));
  return 1 - (above - low) / (middle - low) * ((above - low) / (high - low));
}

double mean_of_positive_part(double a, double b, double c) {
  const double low = std::min({a, b, c});
  const double high = std::max({a, b, c});
  const double middle = std::max(std::min(a, b), std::min(std::max(a, b), c));
  const double mean = (low + middle + high) / 3;
  if (low >= 0) return mean;
  if (high <= 0) return 0;
  if (middle <= 0) return high / (high - middle) * (high / (high - low)) * (high / 3);
  return mean + low / (low - middle) * (low / (low - high)) * (-low / 3);
}

ChangeStatistics measure_change(const Surface& earlier, const Surface& later, const ChangeRegion& region,
                                const ChangeOptions& options, vpe::base::ThreadPool& pool) {
  if (!(options.threshold_m >= 0)) throw std::invalid_argument("measure_change: the threshold is negative");
  require_comparable(earlier.planet(), later.planet());
  std::vector<lod::TileKey> keys;
  for (int face = 0; face < mars::kFaces; ++face)
    find_finest(earlier, later, region, {static_cast<mars::Face>(face), 0, 0, 0}, keys);
  const TileMeter meter(earlier, later, region, options.threshold_m);
  TileChange all;
  for (std::size_t begin = 0; begin < keys.size(); begin += kTilesAtOnce) {
    if (options.tell) options.tell(static_cast<double>(begin) / static_cast<double>(keys.size()));
    std::vector<TileChange> tiles(std::min(kTilesAtOnce, keys.size() - begin));
    pool.run(tiles.size(), [&](std::size_t n) { tiles[n] = meter.measure(keys[begin + n]); });
    for (const TileChange& tile : tiles) all.add(tile);
  }
  const double square = later.planet_radius_m() * later.planet_radius_m();
  ChangeStatistics out;
  out.area_m2 = all.area * square;
  out.nodata_area_m2 = all.nodata * square;
  out.changed_area_m2 = all.changed * square;
  out.gained_m3 = all.gained_m3;
  out.lost_m3 = all.lost_m3;
  out.triangles = all.triangles;
  out.least = all.least;
  out.most = all.most;
  if (all.area > 0) {
    out.mean_m = all.sum / all.area;
    out.rms_m = std::sqrt(all.squares / all.area);
    out.median_m = median_of(all.weights, all.area);
  }
  return out;
}

}  // namespace paging
