#include "paging/live/planet_change.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "mars/geodesy/datum.h"
#include "mars/geodesy/sphere.h"
#include "paging/live/planet_ground.h"
#include "vpe/base/number.h"

namespace paging {

namespace {

constexpr double kAngleRounding_rad = 1e-14;

bool is_same_tile(const PlanetFile& a, const PlanetFile& b, const lod::TileKey& key) {
  const lod::TileInfo* other = b.tree().find(key);
  if (other == nullptr || other->has_children) return false;
  const TileHeights x = a.heights(key);
  const TileHeights y = b.heights(key);
  return x.posts.height_m == y.posts.height_m && x.nodata == y.nodata;
}

// Holds a part of the sphere in which the planets differ, and the posts that `to` has there.
struct Part {
  mars::Cap cap;
  double spacing_m = 0;
};

class PlanetChange final : public GroundChange {
 public:
  PlanetChange(const PlanetFile& from, std::shared_ptr<const PlanetFile> to, std::size_t budget_bytes)
      : ground_(std::move(to), budget_bytes) {
    const PlanetFile& other = ground_.planet();
    for (const lod::TileInfo& tile : from.tree().tiles()) {
      if (tile.has_children || is_same_tile(from, other, tile.key)) continue;
      parts_.push_back({lod::bounding_cap(tile.key), finest_m(other, tile.key)});
    }
    info_.name = other.path();
    info_.datum = other.meta().datum;
    info_.illustration = other.meta().illustration;
    info_.treatment = "the ground of another planet file";
    info_.resolution_m = std::numeric_limits<double>::infinity();
    for (const Part& part : parts_) info_.resolution_m = std::min(info_.resolution_m, part.spacing_m);
    if (parts_.empty()) info_.resolution_m = 0;
  }

  std::vector<mars::SourceInfo> infos() const override { return {info_}; }

  bool touches(const mars::Cap& cap) const override {
    return std::ranges::any_of(parts_, [&](const Part& part) { return meet(part.cap, cap); });
  }

  double spacing_in(const mars::Cap& cap) const override {
    double spacing_m = std::numeric_limits<double>::infinity();
    for (const Part& part : parts_)
      if (meet(part.cap, cap)) spacing_m = std::min(spacing_m, part.spacing_m);
    return spacing_m;
  }

  void change(std::span<const glm::dvec3> directions, double /*spacing_m*/, std::span<double> heights_m,
              std::span<int> decided_by) const override {
    for (std::size_t i = 0; i < directions.size(); ++i) {
      decided_by[i] = -1;
      const double height_m = ground_.height_m(directions[i]);
      if (std::isnan(height_m)) continue;
      heights_m[i] = height_m;
      decided_by[i] = 0;
    }
  }

 private:
  static bool meet(const mars::Cap& a, const mars::Cap& b) {
    return mars::angle_between_rad(a.centre, b.centre) <= a.radius_rad + b.radius_rad + kAngleRounding_rad;
  }

  // Returns the distance of posts of a planet's finest tile in the area of a tile.
  static double finest_m(const PlanetFile& planet, const lod::TileKey& key) {
    const lod::TileTree& tree = planet.tree();
    const lod::TileInfo& there = tree.deepest(key);
    int level = there.key.level;
    if (there.has_children) {
      for (const lod::TileInfo& tile : tree.tiles())
        if (!tile.has_children && lod::contains(key, tile.key)) level = std::max(level, tile.key.level);
    }
    return lod::post_spacing_m(level, planet.meta().tile.intervals(), planet.radius_m());
  }

  PlanetGround ground_;
  std::vector<Part> parts_;
  mars::SourceInfo info_;
};

void require_same_body(const PlanetFile& from, const PlanetFile& to) {
  const PlanetMeta& a = from.meta();
  const PlanetMeta& b = to.meta();
  const auto refuse = [&](const std::string& what, const std::string& is, const std::string& was) {
    throw PlanetError(to.path() + ": cannot be mixed with " + from.path() + ": " + what + " is " + is +
                      ", and that of the other " + was + "; give two planets of one body, radius and datum");
  };
  using vpe::base::format_number;
  if (a.body != b.body) refuse("its body", b.body, a.body);
  if (a.radius_m != b.radius_m)
    refuse("its radius", format_number(b.radius_m) + " m", format_number(a.radius_m) + " m");
  if (a.shape != b.shape) refuse("its shape", b.shape, a.shape);
  if (!(a.datum == b.datum)) refuse("its datum", mars::to_string(b.datum), mars::to_string(a.datum));
}

}  // namespace

std::shared_ptr<const GroundChange> planet_change(const PlanetFile& from, std::shared_ptr<const PlanetFile> to,
                                                  std::size_t budget_bytes) {
  require_same_body(from, *to);
  return std::make_shared<PlanetChange>(from, std::move(to), budget_bytes);
}

}  // namespace paging
