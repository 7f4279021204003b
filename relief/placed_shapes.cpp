// The shapes of each kind, and the sizes that are not given.
#include <algorithm>
#include <cmath>

#include "relief/crater.h"
#include "relief/dune.h"
#include "relief/earthworks.h"
#include "relief/interval_math.h"
#include "relief/noise.h"
#include "relief/placed.h"
#include "relief/weights.h"

namespace relief {

namespace {

constexpr double kTrenchSlope_deg = 45;
constexpr double kDamSlope_deg = 30;
constexpr double kReposeSlope_deg = 33;
constexpr double kMostPartsOfSide = 16;
constexpr int kMostOctavesOfPosts = 5;  // finer ones do not ask for posts

double corner_distance_m(const Rect& rect) { return radii_of(rect).high; }

// Sets the weight and the reach of an area around the origin that is a circle or a box, 1 inside and falling outside.
void set_area(const ReliefSpec& spec, double falloff_m, ReliefShapes& out) {
  if (spec.radius_m) {
    out.weight = std::make_shared<CircleWeight>(*spec.radius_m, falloff_m);
    out.reach_m = *spec.radius_m + falloff_m;
    return;
  }
  const double length_m = spec.length_m.value();
  out.weight =
      std::make_shared<BoxWeight>(centred_rect(length_m / 2, spec.width_m.value_or(length_m) / 2), falloff_m);
  out.reach_m = corner_distance_m(out.weight->support());
}

double smaller_side_m(const ReliefSpec& spec) {
  if (spec.radius_m) return *spec.radius_m;
  return std::min(spec.length_m.value(), spec.width_m.value_or(spec.length_m.value()));
}

// Returns the smallest part of an area with a border. A narrow border does not ask for posts without end.
double part_of_border_m(double falloff_m, double side_m) {
  return std::clamp(falloff_m, side_m / kMostPartsOfSide, side_m);
}

bool is_added(const ReliefSpec& spec) { return spec.mode.value_or(usual_mode(spec.kind)) == Mode::kAdd; }

// Ends a shape that ends by itself where it does not count from the ground: over a quarter of its support.
void set_weight_of_support(const ReliefSpec& spec, ReliefShapes& out) {
  const Rect support = out.height->support();
  out.reach_m = corner_distance_m(support);
  if (is_added(spec)) return;
  const double falloff_m = std::min(support.x1_m - support.x0_m, support.y1_m - support.y0_m) / 4;
  out.weight = std::make_shared<BoxWeight>(grown(support, -falloff_m), falloff_m);
}

ReliefShapes crater(const ReliefSpec& spec) {
  CraterSize size = mars_crater(spec.radius_m.value());
  size.depth_m = spec.depth_m.value_or(size.depth_m);
  size.rim_m = spec.rim_m.value_or(size.depth_m / 5);
  size.peak_m = spec.peak_m.value_or(std::min(size.peak_m, size.depth_m / 2));
  size.floor_ratio = spec.floor_ratio.value_or(size.floor_ratio);
  size.ejecta_ratio = spec.ejecta_ratio;
  ReliefShapes out;
  out.height = std::make_shared<CraterShape>(size);
  out.reach_m = size.radius_m * size.ejecta_ratio;
  if (!is_added(spec)) {
    const double falloff_m = size.radius_m * (size.ejecta_ratio - 1) / 2;
    out.weight = std::make_shared<CircleWeight>(size.radius_m + falloff_m, falloff_m);
    out.reach_m = size.radius_m + 2 * falloff_m;
  }
  out.part_m = size.radius_m / 8;
  return out;
}

ReliefShapes ramp(const ReliefSpec& spec) {
  ReliefShapes out;
  const double falloff_m = spec.falloff_m.value_or(*spec.width_m / 4);
  out.height = std::make_shared<RampShape>(*spec.length_m, spec.start_m, spec.end_m);
  set_area(spec, falloff_m, out);
  out.part_m = part_of_border_m(falloff_m, smaller_side_m(spec));
  return out;
}

ReliefShapes pad(const ReliefSpec& spec) {
  ReliefShapes out;
  const double falloff_m = spec.falloff_m.value_or(smaller_side_m(spec) / 4);
  out.height = std::make_shared<LevelShape>(0);
  set_area(spec, falloff_m, out);
  out.part_m = part_of_border_m(falloff_m, smaller_side_m(spec));
  return out;
}

ReliefShapes trench(const ReliefSpec& spec) {
  ReliefShapes out;
  const double slope_deg = spec.slope_deg.value_or(kTrenchSlope_deg);
  out.height = std::make_shared<TrenchShape>(*spec.length_m, *spec.width_m, *spec.depth_m, slope_deg);
  set_weight_of_support(spec, out);
  const double wall_m = *spec.depth_m / slope_of(slope_deg);
  out.part_m = std::max(std::min(smaller_side_m(spec), wall_m), smaller_side_m(spec) / 8);
  return out;
}

ReliefShapes dune(const ReliefSpec& spec) {
  DuneSize size;
  size.height_m = *spec.height_m;
  size.width_m = spec.width_m.value_or(std::max(10 * size.height_m, kLeastLength_m));
  size.stoss_m = spec.stoss_m.value_or(std::max(6 * size.height_m, kLeastLength_m));
  size.is_barchan = spec.form == DuneForm::kBarchan;
  size.horn_m = spec.horn_m.value_or(size.is_barchan ? size.width_m / 3 : 0);
  size.repose_deg = spec.slope_deg.value_or(kReposeSlope_deg);
  ReliefShapes out;
  out.height = std::make_shared<DuneShape>(size);
  set_weight_of_support(spec, out);
  const double slip_m = size.height_m / slope_of(size.repose_deg);
  out.part_m = std::max(slip_m, std::min(size.width_m, size.stoss_m) / 8);
  return out;
}

ReliefShapes dam(const ReliefSpec& spec) {
  const double height_m = *spec.height_m;
  const double slope_deg = spec.slope_deg.value_or(kDamSlope_deg);
  const double width_m = spec.width_m.value_or(std::max(height_m / 4, kLeastLength_m));
  // The sides end where they are so deep; there the weight ends what ground deeper than that would leave as a wall.
  const double side_m = (height_m + spec.foundation_m.value_or(height_m)) / slope_of(slope_deg);
  const double falloff_m = spec.falloff_m.value_or(std::max(side_m / 4, kLeastLength_m));
  ReliefShapes out;
  out.height = std::make_shared<DamShape>(*spec.length_m, width_m, height_m, slope_deg);
  out.weight =
      std::make_shared<BoxWeight>(grown(centred_rect(*spec.length_m / 2, width_m / 2), side_m), falloff_m);
  out.reach_m = corner_distance_m(out.weight->support());
  out.part_m = std::max(width_m, side_m / 4);
  return out;
}

ReliefShapes flood(const ReliefSpec& spec, std::vector<glm::dvec2> corners_m) {
  ReliefShapes out;
  out.height = std::make_shared<LevelShape>(0);
  if (spec.radius_m) {
    const double falloff_m = std::min(spec.falloff_m.value_or(*spec.radius_m / 20), *spec.radius_m);
    out.weight = std::make_shared<CircleWeight>(*spec.radius_m - falloff_m, falloff_m);
    out.reach_m = *spec.radius_m;
    out.part_m = part_of_border_m(falloff_m, *spec.radius_m);
    return out;
  }
  for (const glm::dvec2& corner : corners_m) out.reach_m = std::max(out.reach_m, radius_of(corner.x, corner.y));
  const Rect support = PolygonWeight(corners_m, 1).support();
  const double extent_m = std::max(support.x1_m - support.x0_m, support.y1_m - support.y0_m);
  const double falloff_m = spec.falloff_m.value_or(std::max(extent_m / 40, kLeastLength_m));
  out.weight = std::make_shared<PolygonWeight>(std::move(corners_m), falloff_m);
  out.part_m = part_of_border_m(falloff_m, std::max(extent_m / 2, kLeastLength_m));
  return out;
}

ReliefShapes noise(const ReliefSpec& spec) {
  NoiseSize size;
  size.amplitude_m = *spec.amplitude_m;
  size.wavelength_m = *spec.wavelength_m;
  size.octaves = spec.octaves;
  size.gain = spec.gain;
  size.seed = static_cast<std::uint32_t>(spec.seed);
  ReliefShapes out;
  out.height = std::make_shared<NoiseShape>(size);
  set_area(spec, spec.falloff_m.value_or(smaller_side_m(spec) / 2), out);
  out.part_m = std::ldexp(size.wavelength_m, 1 - std::min(size.octaves, kMostOctavesOfPosts));
  return out;
}

}  // namespace

ReliefShapes shapes_of(const ReliefSpec& spec, std::vector<glm::dvec2> corners_m) {
  switch (spec.kind) {
    case ReliefKind::kCrater: return crater(spec);
    case ReliefKind::kRamp: return ramp(spec);
    case ReliefKind::kPad: return pad(spec);
    case ReliefKind::kTrench: return trench(spec);
    case ReliefKind::kDune: return dune(spec);
    case ReliefKind::kDam: return dam(spec);
    case ReliefKind::kFlood: return flood(spec, std::move(corners_m));
    case ReliefKind::kNoise: break;
  }
  return noise(spec);
}

}  // namespace relief
