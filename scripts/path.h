// Playback of a flight: where the platform is, where the head looks and what is set, at any time.
//
//   - Position: a smooth curve on the sphere (spherical_spline.h): great circles between two poses, continuous
//     velocity at every pose. Altitude: monotone between poses (monotone_spline.h).
//   - Attitude: the same curve on quaternions of the body-fixed frame, the short way round. So nothing spins at
//     the poles or the antimeridian, and a straight flight at constant pitch keeps it.
//   - Head: monotone in each angle between `look` lines, the short way round; held before the first and after
//     the last; straight ahead when there is none.
//   - Before the first pose (look) and between the last one and the end all is held, as by a pose of its own.
//   - At the time of a pose or look line the state is what the line says, to the bit: a log replays exactly.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "mars/geodesy/pose.h"
#include "mars/geodesy/sphere.h"
#include "scripts/flight.h"
#include "scripts/monotone_spline.h"
#include "scripts/spherical_spline.h"
#include "vpe/core/appearance/settings.h"

namespace scripts {

// Height above the sphere of the terrain as it is drawn with an exaggeration, metres; NaN where it is not known.
using TerrainHeight = std::function<double(mars::LonLat place, double exaggeration)>;

struct FlightState {
  mars::Pose pose;  // of the platform
  mars::HeadAngles look;
  mars::CameraPose camera;  // both together: mars::to_camera(pose, look, radius)
};

// Immutable; every const member may be called from any number of threads at once.
class Path {
 public:
  // Calls terrain_height_m once for every pose given by its height; it may be empty when there is none. The terrain
  // counts with the exaggeration at the pose's time: the flight's, before its first `set` the given one.
  // Throws std::runtime_error, naming the time, when a terrain height is not known, when a camera is not above
  // the planet's centre, and when two successive poses are opposite, so that no great circle is defined.
  Path(const Flight& flight, double radius_m, const TerrainHeight& terrain_height_m, double exaggeration = 1);

  double duration_s() const { return duration_s_; }

  // Of heights, at a time.
  double exaggeration(double time_s) const;

  // State at a time; at the start for times before it, at the end for times after it.
  FlightState at(double time_s) const;

  // Brings settings up to a time: all `set` commands up to and including it, in order.
  void apply_settings(double time_s, vpe::core::Settings& settings) const;

  // Regions of interest given up to and including a time.
  std::span<const Interest> interests(double time_s) const;

 private:
  struct Knot {
    double time_s = 0;
    mars::Pose pose;
  };
  std::vector<Knot> knots_of(const Flight& flight, const TerrainHeight& terrain_height_m) const;

  double radius_m_;
  double duration_s_;
  double exaggeration_;  // before the first `set` of it
  std::vector<SetCommand> sets_;
  std::vector<Knot> knots_;  // the poses with their heights resolved, and what is held at both ends
  std::vector<Look> looks_;  // likewise
  std::vector<Interest> interests_;
  SphericalSpline<glm::dvec3> place_;
  SphericalSpline<glm::dvec4> attitude_;
  MonotoneSpline alt_m_;
  MonotoneSpline look_yaw_deg_;
  MonotoneSpline look_pitch_deg_;
  MonotoneSpline look_roll_deg_;
};

// The frame of a film that comes closest to the ground as drawn, straight down.
struct Clearance {
  std::int64_t frame = 0;
  double time_s = 0;
  double height_m = 0;  // of the platform above the terrain; negative = under it
  mars::LonLat place;
};

// Nothing when the film has no frames or the terrain is not known under any of them.
std::optional<Clearance> lowest_clearance(const Path& path, const FrameRate& rate,
                                          const TerrainHeight& terrain_height_m);

}  // namespace scripts
