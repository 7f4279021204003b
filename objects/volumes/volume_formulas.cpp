#include "objects/volumes/volume_formulas.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/ext/scalar_constants.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <stdexcept>

#include "objects/volumes/volume_noise.h"
#include "vpe/base/parallel.h"

namespace objects {

namespace {

constexpr double kBelowFoot = 0.1;  // of the height
constexpr int kNoiseOctaves = 5;

// Density without a unit, at a place of the model frame.
using Density = std::function<double(const glm::dvec3& place_m)>;

// Describes a field before it is sampled.
struct FormulaField {
  Density density;
  glm::dvec3 low_m{};
  glm::dvec3 high_m{};
};

double square(double x) { return x * x; }

// A column with an axis that leans and sways, and walls of dust that the wind tears into strands.
FormulaField dust_devil(const VolumeFormula& f) {
  const double foot_m = 0.35 * f.radius_m;  // radius there
  const double skirt_m = 0.95 * f.radius_m;
  const double sway_m = 0.12 * f.radius_m;
  const auto density = [=](const glm::dvec3& p) {
    const double h = p.z / f.height_m;
    if (h < -kBelowFoot || h > 1) return 0.0;
    const double up = std::max(0.0, h);
    const double phase = static_cast<double>(f.seed % 64);
    const double sway = sway_m * std::min(1.0, 3 * up);
    const glm::dvec2 axis(sway * std::sin(5 * up + phase),
                          f.lean_m * std::pow(up, 1.3) + sway * std::cos(4 * up + 2 * phase));
    const glm::dvec2 beside(p.x - axis.x, p.y - axis.y);
    const double r = glm::length(beside);
    const double radius = 0.88 * (foot_m + (f.radius_m - foot_m) * std::pow(up, 0.8));
    const double q = r / radius;
    const double skirt = r / skirt_m;
    if (q >= 1 && (skirt >= 1 || h > 0.2)) return 0.0;
    // The wind turns thrice on its way up, faster near the axis, and climbs.
    const double turn = 18 * up + 2.5 * std::exp(-2 * q);
    const glm::dvec2 turned(beside.x * std::cos(turn) - beside.y * std::sin(turn),
                            beside.x * std::sin(turn) + beside.y * std::cos(turn));
    const double height = p.z / (0.4 * f.radius_m);
    const glm::dvec3 at(1.8 * turned.x / radius, 1.8 * turned.y / radius, 0.8 * height);
    const double noise = fractal_noise(f.seed, at, kNoiseOctaves);
    // Large billows push the walls in and out.
    const double billow = volume_noise(f.seed + 77, 0.45 * at);
    const double edge = q + 0.5 * noise + 0.3 * billow;
    const double wall = std::exp(-square((edge - 0.5) / 0.26)) + 0.4 * std::exp(-square(edge / 0.4));
    const double fade = glm::smoothstep(1.0, 0.45, q + 0.4 * noise + 0.3 * billow) *
                        glm::smoothstep(1.0, 0.8, q) *
                        glm::smoothstep(1.0, 0.45, h + 0.4 * noise + 0.2 * billow);
    const double strands = std::clamp(0.9 + 3.2 * noise + 0.8 * billow, 0.0, 2.5);
    double sum = wall * fade * (0.5 + 0.5 * std::exp(-2.5 * up)) * strands;
    if (skirt < 1) {
      // Dust that the foot tears off the ground.
      const double low =
          std::exp(-square(std::max(0.0, p.z) / (0.55 * foot_m * std::max(0.3, 1 + 1.5 * billow))));
      const double puffs = std::clamp(0.8 + 3 * noise + billow, 0.0, 2.5);
      sum += 0.9 * puffs * low * glm::smoothstep(1.0, 0.1, skirt + 0.3 * noise) *
             glm::smoothstep(1.0, 0.8, skirt) * glm::smoothstep(0.2, 0.1, h);
    }
    return sum;
  };
  const double reach = f.radius_m + sway_m;
  return {density, {-reach, -reach, -kBelowFoot * f.height_m}, {reach, reach + f.lean_m, f.height_m}};
}

FormulaField cloud(const VolumeFormula& f) {
  const auto density = [=](const glm::dvec3& p) {
    // The base is flatter than the top.
    const double z = p.z / f.height_m - 0.38;
    const glm::dvec3 in(p.x / f.radius_m, p.y / f.radius_m, z / (z < 0 ? 0.38 : 0.62));
    const double r = glm::length(in);
    if (r >= 1) return 0.0;
    const glm::dvec3 at(2.6 * in.x, 2.6 * in.y, 2.6 * in.z * std::min(1.0, f.height_m / f.radius_m));
    const double noise = fractal_noise(f.seed, at, kNoiseOctaves + 1);
    return glm::smoothstep(0.0, 0.35, 0.72 - r + 1.35 * noise) * glm::smoothstep(1.0, 0.8, r);
  };
  return {density, {-f.radius_m, -f.radius_m, 0}, {f.radius_m, f.radius_m, f.height_m}};
}

FormulaField plume(const VolumeFormula& f) {
  const auto density = [=](const glm::dvec3& p) {
    const double h = p.z / f.height_m;
    if (h < -kBelowFoot || h > 1) return 0.0;
    const double up = std::max(0.0, h);
    const double radius = f.radius_m * (0.18 + 0.82 * up);
    const glm::dvec2 beside(p.x, p.y - f.lean_m * std::pow(up, 1.6));
    const double q = glm::length(beside) / radius;
    if (q >= 1) return 0.0;
    // Billows grow with the radius.
    const double height = std::log(0.18 + up);
    const glm::dvec3 at(1.5 * beside.x / radius, 1.5 * beside.y / radius,
                        2.4 * height * f.height_m / (f.height_m + f.radius_m));
    const double noise = fractal_noise(f.seed, at, kNoiseOctaves);
    const double body = glm::smoothstep(0.0, 0.4, 0.75 - q + 1.2 * noise);
    // As much dust at each height, but for what falls out.
    return body * glm::smoothstep(1.0, 0.75, q) * glm::smoothstep(1.0, 0.6, h + 0.4 * noise) /
           (0.25 + 0.75 * radius / f.radius_m);
  };
  return {density,
          {-f.radius_m, -f.radius_m, -kBelowFoot * f.height_m},
          {f.radius_m, f.radius_m + f.lean_m, f.height_m}};
}

FormulaField field_of(const VolumeFormula& f) {
  switch (f.kind) {
    case VolumeKind::kDustDevil: return dust_devil(f);
    case VolumeKind::kCloud: return cloud(f);
    case VolumeKind::kPlume: return plume(f);
  }
  return dust_devil(f);
}

// The mean over rays through the middle of the largest depth beside each other, in values of the field times metres.
double depth_through_middle(const DenseVolume& dense, const VolumeFormula& f) {
  const VolumeLattice& lattice = dense.lattice();
  const auto spacing_m = static_cast<double>(lattice.spacing_m);
  const auto place = [&](int axis, int n) {
    return static_cast<double>(lattice.corner_m[axis]) + spacing_m * n;
  };
  const bool is_cloud = f.kind == VolumeKind::kCloud;
  double sum = 0;
  int rays = 0;
  if (is_cloud) {
    for (int y = 0; y < lattice.posts[1]; ++y) {
      for (int x = 0; x < lattice.posts[0]; ++x) {
        if (std::hypot(place(0, x), place(1, y)) > 0.3 * f.radius_m) continue;
        ++rays;
        for (int z = 0; z < lattice.posts[2]; ++z) sum += static_cast<double>(dense.at(x, y, z)) * spacing_m;
      }
    }
  } else {
    for (int z = 0; z < lattice.posts[2]; ++z) {
      if (place(2, z) < 0.3 * f.height_m || place(2, z) > 0.7 * f.height_m) continue;
      double largest = 0;
      for (int x = 0; x < lattice.posts[0]; ++x) {
        double along = 0;
        for (int y = 0; y < lattice.posts[1]; ++y) along += static_cast<double>(dense.at(x, y, z)) * spacing_m;
        largest = std::max(largest, along);
      }
      sum += largest;
      ++rays;
    }
  }
  return rays > 0 ? sum / rays : 0;
}

}  // namespace

std::string check(const VolumeFormula& f) {
  using Limits = VolumeFormulaLimits;
  const auto is_size = [](double m) { return m >= Limits::kLeastSize_m && m <= Limits::kMostSize_m; };
  if (!is_size(f.height_m)) return "the height is not between 0.01 and 1e6 m";
  if (!is_size(f.radius_m)) return "the radius is not between 0.01 and 1e6 m";
  if (!(f.lean_m >= 0 && f.lean_m <= Limits::kMostSize_m)) return "the lean is not between 0 and 1e6 m";
  if (f.kind == VolumeKind::kCloud && f.lean_m > 0) return "a cloud does not lean";
  const double width_m = 2 * f.radius_m;
  if (std::max({f.height_m, width_m, f.lean_m}) > Limits::kMostProportion * std::min(f.height_m, width_m))
    return "height, twice the radius and lean differ by more than 50 times";
  if (!(f.optical_depth > 0 && f.optical_depth <= Limits::kMostOpticalDepth))
    return "the optical depth is not above 0 and at most 100";
  if (f.voxels < Limits::kLeastVoxels || f.voxels > Limits::kMostVoxels) return "the voxels are not 16 to 256";
  return "";
}

VolumeLevel level_by_formula(const VolumeFormula& f) {
  const std::string problem = check(f);
  if (!problem.empty()) throw std::invalid_argument(problem);
  const FormulaField field = field_of(f);
  const glm::dvec3 size_m = field.high_m - field.low_m;
  const double spacing_m = std::max({size_m.x, size_m.y, size_m.z}) / f.voxels;
  VolumeLattice lattice;
  lattice.spacing_m = static_cast<float>(spacing_m);
  lattice.corner_m = glm::vec3(field.low_m);
  for (int k = 0; k < 3; ++k)
    lattice.posts[static_cast<std::size_t>(k)] =
        std::max(2, static_cast<int>(std::ceil(size_m[k] / spacing_m)) + 1);
  DenseVolume dense(lattice);
  vpe::base::parallel_for(static_cast<std::size_t>(lattice.posts[2]), 0, [&](std::size_t layer) {
    const int z = static_cast<int>(layer);
    for (int y = 0; y < lattice.posts[1]; ++y) {
      for (int x = 0; x < lattice.posts[0]; ++x)
        dense.at(x, y, z) = static_cast<float>(field.density(field.low_m + spacing_m * glm::dvec3(x, y, z)));
    }
  });
  const double depth = depth_through_middle(dense, f);
  const double factor = depth > 0 ? f.optical_depth / depth : 0;
  for (float& v : dense.values()) v = static_cast<float>(static_cast<double>(v) * factor);
  return build_level(dense);
}

VolumeModel volume_by_formula(const VolumeFormula& f) { return VolumeModel(level_by_formula(f), f.colour); }

}  // namespace objects
