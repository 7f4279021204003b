// The plane that fits ground best, with its dip and strike.
//
// Typical usage:
//   PlaneFit fit(low_m, high_m);
//   for (const auto& facet : facets) fit.add(facet.a, facet.b, facet.c);
//   if (const auto plane = fit.plane()) tell(plane->dip_deg);
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace vpe::explore {

// Describes the plane z = height_m + slope.x x + slope.y y in a level frame: x east, y north, z up, metres.
struct FittedPlane {
  double height_m = 0;
  glm::dvec2 slope{0};
  double dip_deg = 0;          // against the level, 0 to 90
  double dip_azimuth_deg = 0;  // to where it falls, clockwise from north, 0 to 360
  double strike_deg = 0;       // the plane falls to the right of it; 0 to 360
  double residual_m = 0;       // root mean square of the vertical distances of the ground
  // Standard deviations by leaving out a sixteenth of the ground's extent at a time (jackknife), so that ground whose
  // neighbouring posts are alike does not look more certain than it is. Absent with ground in fewer than four parts.
  // That of the strike is at most 180.
  std::optional<double> dip_error_deg;
  std::optional<double> strike_error_deg;
};

// Sums the moments of triangles. The sums are exact integrals over them; what is minimised is the integral of the squared
// vertical distance over the level area. Rounding is below 1e-6 of the extent of heights.
class PlaneFit {
 public:
  // Takes the extent of the ground in x and y, which is divided into four by four parts.
  PlaneFit(const glm::dvec2& low_m, const glm::dvec2& high_m);

  // Adds a triangle. Those that run clockwise, seen from above, count negative.
  void add(const glm::dvec3& a_m, const glm::dvec3& b_m, const glm::dvec3& c_m);

  // Returns the plane, or nullopt for ground without a level area of at least two directions.
  std::optional<FittedPlane> plane() const;

 private:
  static constexpr int kParts = 4;  // along each side

  // Holds the integrals of products of (1, x, y, z) over the level area.
  struct Moments {
    std::array<std::array<double, 4>, 4> of{};
    void add(const Moments& other, double factor);
  };
  static std::optional<glm::dvec3> solve(const Moments& moments);

  glm::dvec2 low_m_;
  glm::dvec2 size_m_;
  std::array<Moments, kParts * kParts> parts_;
};

}  // namespace vpe::explore
