#include "vpe/explore/layers/feature_pick.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <tuple>

#include "mars/vector/area_index.h"
#include "vpe/base/number.h"

namespace vpe::explore {
namespace {

constexpr int kMostBisections = 40;
constexpr double kShortest_px = 1;
// Edges that are shown in part are followed down to this share of the reach.
constexpr double kShortestShare = 1.0 / 4096;

// Tells which places in degrees may be within an angle of a place.
class Reach {
 public:
  Reach(mars::LonLat place, double reach_rad) : place_(place) {
    // The margin covers rounding of longitudes and latitudes.
    reach_deg_ = reach_rad / mars::kRadiansPerDegree + 1e-9;
    const double widest_lat_rad =
        std::max(std::abs(place.lat_deg - reach_deg_), std::abs(place.lat_deg + reach_deg_)) *
        mars::kRadiansPerDegree;
    const double least_cos = std::cos(place.lat_deg * mars::kRadiansPerDegree);
    if (widest_lat_rad >= mars::kPi / 2 || std::sin(reach_deg_ * mars::kRadiansPerDegree) >= least_cos)
      lon_reach_deg_ = 180;
    else
      lon_reach_deg_ =
          std::asin(std::sin(reach_deg_ * mars::kRadiansPerDegree) / least_cos) / mars::kRadiansPerDegree +
          1e-9;
  }

  bool meets(glm::dvec2 low, glm::dvec2 high) const {
    if (low.y > place_.lat_deg + reach_deg_ || high.y < place_.lat_deg - reach_deg_) return false;
    const double half = (high.x - low.x) / 2;
    return half + lon_reach_deg_ >= 180 ||
           std::abs(std::remainder((low.x + high.x) / 2 - place_.lon_deg, 360)) <= half + lon_reach_deg_;
  }

  double shortest_deg() const { return std::max(reach_deg_ * kShortestShare, 1e-12); }

 private:
  mars::LonLat place_;
  double reach_deg_ = 0;
  double lon_reach_deg_ = 180;
};

// Finds how near to the cursor one feature is shown.
class Picker {
 public:
  Picker(const PickQuery& query, const Reach& reach) : query_(query), reach_(reach) {}

  // Returns the least distance of a place and of an edge that is at most `most_px` and is seen, else infinity.
  double point_px(glm::dvec2 place, double most_px) const {
    if (!reach_.meets(place, place)) return kNone_px;
    const auto at = query_.position(place);
    return at ? accept(glm::length(*at - query_.cursor_px), place, most_px) : kNone_px;
  }

  double edge_px(glm::dvec2 from, glm::dvec2 to, double most_px) const {
    if (!reach_.meets(glm::min(from, to), glm::max(from, to))) return kNone_px;
    return follow({from, query_.position(from)}, {to, query_.position(to)}, most_px, 0);
  }

  static constexpr double kNone_px = std::numeric_limits<double>::infinity();

 private:
  struct End {
    glm::dvec2 place;
    std::optional<glm::dvec2> at;
  };

  double accept(double distance_px, glm::dvec2 place, double most_px) const {
    if (!(distance_px <= most_px) || (query_.is_seen && !query_.is_seen(place))) return kNone_px;
    return distance_px;
  }

  double end_px(const End& end, double most_px) const {
    return end.at ? accept(glm::length(*end.at - query_.cursor_px), end.place, most_px) : kNone_px;
  }

  double follow(const End& from, const End& to, double most_px, int depth) const {
    if (!reach_.meets(glm::min(from.place, to.place), glm::max(from.place, to.place))) return kNone_px;
    const bool is_short = from.at && to.at && glm::length(*to.at - *from.at) <= kShortest_px &&
                          glm::length(to.place - from.place) < 1;
    const bool is_end = depth >= kMostBisections || glm::length(to.place - from.place) <= reach_.shortest_deg();
    if (is_short) {
      const glm::dvec2 along = *to.at - *from.at;
      const double length2 = glm::dot(along, along);
      const double share =
          length2 > 0 ? std::clamp(glm::dot(query_.cursor_px - *from.at, along) / length2, 0.0, 1.0) : 0.0;
      return accept(glm::length(*from.at + share * along - query_.cursor_px),
                    from.place + share * (to.place - from.place), most_px);
    }
    if (is_end) return std::min(end_px(from, most_px), end_px(to, most_px));
    const glm::dvec2 middle = 0.5 * (from.place + to.place);
    const End between{middle, query_.position(middle)};
    const double first = follow(from, between, most_px, depth + 1);
    return std::min(first, follow(between, to, std::min(first, most_px), depth + 1));
  }

  const PickQuery& query_;
  const Reach& reach_;
};

// Returns true if a place is beside a polygon that goes around no pole, by its extent.
bool is_beside(const mars::Shape& shape, mars::LonLat place) {
  glm::dvec2 low = shape.rings.at(0).at(0);
  glm::dvec2 high = low;
  for (const auto& ring : shape.rings) {
    if (std::abs(ring.back().x - ring.front().x) > 180) return false;
    for (const glm::dvec2& vertex : ring) {
      low = glm::min(low, vertex);
      high = glm::max(high, vertex);
    }
  }
  return !Reach(place, 0).meets(low, high);
}

std::optional<PickedFeature> pick_one(const mars::Feature& feature, const Picker& picker,
                                      const PickQuery& query) {
  double point_px = Picker::kNone_px;
  double line_px = Picker::kNone_px;
  bool is_inside = false;
  for (const mars::Shape& shape : feature.shapes) {
    if (shape.kind == mars::ShapeKind::point) {
      point_px = std::min(point_px, picker.point_px(shape.rings.at(0).at(0), query.reach_px));
      continue;
    }
    for (const auto& ring : shape.rings) {
      for (std::size_t n = 1; n < ring.size(); ++n)
        line_px = std::min(line_px, picker.edge_px(ring[n - 1], ring[n], std::min(line_px, query.reach_px)));
    }
    if (shape.kind == mars::ShapeKind::polygon && query.is_on_ground && !is_inside)
      is_inside = !is_beside(shape, query.place) &&
                  mars::AreaIndex(shape).contains({query.place.lon_deg, query.place.lat_deg});
  }
  if (point_px <= query.reach_px) return PickedFeature{0, 0, mars::ShapeKind::point, point_px};
  if (line_px <= query.reach_px) return PickedFeature{0, 0, mars::ShapeKind::line, line_px};
  if (is_inside) return PickedFeature{0, 0, mars::ShapeKind::polygon, 0};
  return std::nullopt;
}

}  // namespace

std::vector<PickedFeature> pick_features(std::span<const mars::FeatureLayer* const> layers,
                                         const PickQuery& query) {
  const Reach reach(query.place, query.reach_rad);
  const Picker picker(query, reach);
  std::vector<PickedFeature> found;
  for (std::size_t n = layers.size(); n-- > 0;) {
    const auto first = static_cast<std::ptrdiff_t>(found.size());
    const std::vector<mars::Feature>& features = layers[n]->features;
    for (std::size_t f = features.size(); f-- > 0;) {
      if (auto picked = pick_one(features[f], picker, query)) {
        picked->layer = n;
        picked->feature = static_cast<std::uint32_t>(f);
        found.push_back(*picked);
      }
    }
    std::stable_sort(found.begin() + first, found.end(), [](const PickedFeature& a, const PickedFeature& b) {
      return std::tuple(a.kind, a.distance_px) < std::tuple(b.kind, b.distance_px);
    });
  }
  return found;
}

std::string field_text(const mars::FieldValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const auto* number = std::get_if<double>(&value)) return base::format_number(*number);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return {};
}

std::vector<std::pair<std::string, std::string>> field_texts(const mars::FeatureLayer& layer,
                                                             const mars::Feature& feature) {
  std::vector<std::pair<std::string, std::string>> texts;
  for (std::size_t n = 0; n < layer.fields.size(); ++n)
    texts.emplace_back(layer.fields[n], n < feature.values.size() ? field_text(feature.values[n]) : "");
  return texts;
}

}  // namespace vpe::explore
