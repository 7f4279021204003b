// The sun over the skyline of a place on a planet.
#pragma once

#include <cstdint>
#include <optional>

#include "mars/geodesy/sun_times.h"
#include "paging/surface/query.h"
#include "panorama/horizon/skyline.h"

namespace vpe::app {

// Names what hides the sun: the ground of the planet, or the horizontal plane through the viewpoint.
enum class SunHorizon : std::uint8_t { kTerrain, kFlat };

// Describes the ground that the sun rises or sets behind.
struct SunRidge {
  double elevation_deg = 0;  // of the skyline
  double range_m = 0;        // from the viewpoint
  mars::LonLat place;
  std::optional<double> ground_error_m;  // sum of ground_error_m() there and at the viewpoint
  // Bounds what that changes of a time; nullopt where it is not known, and where the sun hardly climbs.
  std::optional<double> error_s;
};

// Tells whether the sun is seen from a viewpoint. Any thread may call any member. Members throw PlanetError.
class SunSky {
 public:
  // `limb_deg` is added to the elevation of the centre of the disc: its radius, for the upper limb. The surface must
  // outlive the object.
  SunSky(const paging::Surface& surface, const panorama::Viewpoint& viewpoint, SunHorizon horizon,
         double limb_deg);

  // Returns whether the straight line to that point of the disc meets no ground.
  bool is_seen(const mars::SunPosition& sun) const;

  // Returns the elevation of the skyline at an azimuth, to panorama::kSkyline_deg; 0 for the flat horizon.
  double skyline_deg(double azimuth_deg) const;

  // Returns the ground of the skyline below the sun of a time; nullopt for the flat horizon.
  std::optional<SunRidge> ridge(mars::UnixSeconds time_s) const;

 private:
  double range_m(const glm::dvec3& ray) const;
  panorama::GroundPoint highest_ground(double azimuth_deg) const;

  const paging::Surface* surface_;
  panorama::Viewpoint viewpoint_;
  SunHorizon horizon_;
  double limb_deg_;
};

// Returns the stated error of the ground in metres: of the tiles as drawn, and of their posts against the sources, in
// the tile or else on the whole planet. The errors of the sources themselves are not part of it. Returns nullopt where
// the planet file does not state one.
std::optional<double> ground_error_m(const paging::PlaceAnswer& answer);

}  // namespace vpe::app
