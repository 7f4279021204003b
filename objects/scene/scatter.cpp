#include "objects/scene/scatter.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "mars/geodesy/pose.h"
#include "objects/scene/polygon_points.h"
#include "objects/scene/rock_sizes.h"
#include "objects/scene/scatter_chance.h"
#include "vpe/base/number.h"

namespace objects {

namespace {

// What is drawn for a rock. Draws from kPointDraw on are of its place.
enum ScatterDraw : std::uint8_t { kModelDraw, kSizeDraw, kHeadingDraw, kPitchDraw, kRollDraw, kPointDraw };
constexpr std::uint64_t kCountRock = ~std::uint64_t{0};  // draws how many there are

[[noreturn]] void fail_scatter(const ScatterEntry& entry, const std::string& what) {
  throw std::runtime_error((entry.where.empty() ? "scatter" : entry.where) + ": " + what);
}

PolygonPoints points_of(const ScatterEntry& entry) {
  try {
    return PolygonPoints(entry.polygon);
  } catch (const std::invalid_argument& e) {
    fail_scatter(entry, e.what());
  }
}

double rocks_in(const PolygonPoints& points, const RockSizes& sizes, double planet_radius_m) {
  return points.area_sr() * planet_radius_m * planet_radius_m * sizes.rocks_per_m2();
}

// Returns the height of the model's origin above the ground.
double origin_height_m(const Placing& placing, const RockModel& model, double diameter_m, double buried) {
  const mars::LocalFrame level{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const mars::Axes axes = mars::oriented_axes(level, 0, placing.pitch_deg, placing.roll_deg);
  const glm::dvec3 centre =
      axes.right * model.centre_m.x + axes.forward * model.centre_m.y + axes.up * model.centre_m.z;
  return diameter_m * (0.5 - buried) - placing.scale * centre.z;
}

}  // namespace

double expected_rocks(const ScatterEntry& entry, double planet_radius_m) {
  return rocks_in(points_of(entry), RockSizes(entry), planet_radius_m);
}

std::vector<Scattered> scatter(const ScatterEntry& entry, std::span<const RockModel> models,
                               double planet_radius_m) {
  const PolygonPoints points = points_of(entry);
  const RockSizes sizes(entry);
  const double expected = rocks_in(points, sizes, planet_radius_m);
  if (entry.most == 0 && expected > static_cast<double>(kMostInstances)) {
    fail_scatter(entry, "expected at most " + std::to_string(kMostInstances) + " rocks, found " +
                            vpe::base::format_significant(expected, 4) +
                            "; make the polygon smaller or the rocks larger, or set most");
  }
  const double most =
      static_cast<double>(entry.most == 0 ? kMostInstances : std::min(entry.most, kMostInstances));
  const auto count = static_cast<std::size_t>(
      std::min(most, std::floor(expected + scatter_chance(entry.seed, kCountRock, 0))));
  std::vector<Scattered> rocks(count);
  for (std::size_t n = 0; n < count; ++n) {
    const auto drawn = [&](std::uint64_t draw) { return scatter_chance(entry.seed, n, draw); };
    Scattered& rock = rocks[n];
    const auto kinds = static_cast<double>(entry.models.size());
    rock.model = entry.models[static_cast<std::size_t>(drawn(kModelDraw) * kinds)];
    rock.diameter_m = sizes.diameter_m(drawn(kSizeDraw));
    Placing& placing = rock.placing;
    std::uint64_t draw = kPointDraw;
    placing.place = mars::lon_lat(points.point([&] { return drawn(draw++); }));
    placing.heading_deg = 360 * drawn(kHeadingDraw);
    if (entry.tumbles) {
      placing.pitch_deg = std::asin(2 * drawn(kPitchDraw) - 1) / mars::kRadiansPerDegree;
      placing.roll_deg = 360 * drawn(kRollDraw);
    }
    placing.follows_slope = entry.follows_slope;
    const RockModel& model = models[rock.model];
    placing.scale = rock.diameter_m / model.diameter_m;
    placing.height_m = origin_height_m(placing, model, rock.diameter_m, entry.buried);
  }
  return rocks;
}

}  // namespace objects
