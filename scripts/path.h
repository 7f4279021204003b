// Playback of a flight: pose of the platform, angles of the head, settings and view at any time.
//
//   - Position: a smooth curve on the sphere (spherical_spline.h): a great circle between two poses, continuous
//     velocity at every pose. Altitude: monotone between poses (monotone_spline.h).
//   - Attitude: the same curve on quaternions of the body-fixed frame, in the shorter direction of rotation. So
//     nothing spins at the poles or the antimeridian, and a straight flight at constant pitch keeps its pitch.
//   - Head: monotone in each angle between `look` lines, in the shorter direction of rotation; straight ahead
//     when there are no such lines.
//   - Field of view: between two `view fov=` lines the logarithm of tan(fov / 2) is monotone and smooth, so an even
//     zoom enlarges the image by the same factor each second. The `view` line without a time is the first of
//     them, at 0 s. Two equal ones hold it. Flights without such lines do not change it.
//   - Other keys of `view` lines hold from their time on.
//   - Objects move at constant speed along the great circle between two of their lines (vpe/core/object_track.h).
//   - The ground changes by `relief` and `patch` lines as ground_tracks.h says. Poses with a height count from the ground
//     without these changes.
//   - Before the first pose (or `look` line), and between the last one and the end, the state is held, as if a
//     line with the same values stood at the start (or the end).
//   - At the time of a pose, `look` or `view` line the state is that of the line, to the bit: a log replays exactly.
//
// Typical usage:
//   const Path path(flight, radius_m, terrain_height_m, exaggeration);
//   for (std::int64_t k = 0; k < frame_count(flight.view.fps, path.duration_s()); ++k) {
//     const double time_s = frame_time(flight.view.fps, k);
//     path.apply_settings(time_s, settings);
//     draw(path.at(time_s).camera, settings, path.interests(time_s));
//   }
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mars/geodesy/pose.h"
#include "mars/geodesy/sphere.h"
#include "scripts/flight.h"
#include "scripts/ground_tracks.h"
#include "scripts/monotone_spline.h"
#include "scripts/spherical_spline.h"
#include "vpe/core/appearance/settings.h"

namespace scripts {

// Returns the height above the sphere of the terrain as drawn with an exaggeration, metres; NaN where it is
// unknown.
using TerrainHeight = std::function<double(mars::LonLat place, double exaggeration)>;

// Holds the state of a flight at a time.
struct FlightState {
  mars::Pose pose;  // of the platform
  mars::HeadAngles head;
  mars::CameraPose camera;  // mars::to_camera(pose, head, radius)
  // Holds what `view` lines with a time say; the field of view has no value if none of them has one.
  ViewState view;
};

// Plays a flight back. Immutable; any number of threads may call its const members at once.
class Path {
 public:
  // Calls terrain_height_m once for every pose given by its height; it may be empty when there is none. The
  // terrain is exaggerated as exaggeration() returns for the pose's time: by what the flight has set up to
  // then, and by `exaggeration` before the flight sets it for the first time. Throws what GroundTracks throws, and
  // std::runtime_error, naming the time, when a terrain height is unknown, when a camera is not above the planet's centre, and
  // when two successive poses, or places of an object, are opposite, so that no great circle is defined.
  Path(const Flight& flight, double radius_m, const TerrainHeight& terrain_height_m, double exaggeration = 1);

  double duration_s() const { return duration_s_; }

  // Returns the exaggeration of heights at a time.
  double exaggeration(double time_s) const;

  // Returns the state at a time; that of the start before it, that of the end after it.
  FlightState at(double time_s) const;

  // Applies all `set` commands up to and including a time, in order. Throws std::runtime_error for a value
  // that the settings refuse.
  void apply_settings(double time_s, vpe::core::Settings& settings) const;

  // Returns how the flight moves objects of the scene, by ascending names; null if it moves none.
  const std::shared_ptr<const std::vector<vpe::core::ObjectTrack>>& tracks() const { return tracks_; }

  // Returns how the flight changes the ground; null if it does not.
  const std::shared_ptr<const GroundTracks>& ground() const { return ground_; }
  GroundState ground_at(double time_s) const { return ground_ ? ground_->at(time_s) : GroundState(); }

  // Returns the regions of interest given up to and including a time.
  std::span<const InterestCommand> interests(double time_s) const;

 private:
  struct Knot {
    double time_s = 0;
    mars::Pose pose;
  };
  // The field of view at a time.
  struct Fov {
    double time_s = 0;
    double fov_deg = 0;
  };
  std::optional<double> fov_deg(double time_s) const;
  std::vector<Knot> knots_of(const Flight& flight, const TerrainHeight& terrain_height_m) const;

  double radius_m_;
  double duration_s_;
  double exaggeration_;  // before the first `set` of it
  std::vector<SetCommand> sets_;
  std::vector<Knot> knots_;         // the poses with resolved heights, and those held at both ends
  std::vector<HeadCommand> heads_;  // likewise
  std::vector<InterestCommand> interests_;
  std::shared_ptr<const std::vector<vpe::core::ObjectTrack>> tracks_;
  std::shared_ptr<const GroundTracks> ground_;
  std::vector<ViewCommand> views_;  // each with what those before it say
  std::vector<Fov> fovs_;           // held at both ends; empty if no view has one
  SphericalSpline<glm::dvec3> place_;
  SphericalSpline<glm::dvec4> attitude_;
  MonotoneSpline alt_m_;
  MonotoneSpline head_yaw_deg_;
  MonotoneSpline head_pitch_deg_;
  MonotoneSpline head_roll_deg_;
  std::optional<MonotoneSpline> zoom_;  // log tan(fov / 2); set if fovs_ is not empty
};

// Describes the frame of a film whose platform is least high above the terrain as drawn.
struct Clearance {
  std::int64_t frame = 0;
  double time_s = 0;
  double height_m = 0;  // of the platform above the terrain; negative = under it
  mars::LonLat place;
};

// Returns the frame with the lowest clearance, or nullopt when the film has no frames or the terrain is
// unknown under all of them.
std::optional<Clearance> lowest_clearance(const Path& path, const FrameRate& rate,
                                          const TerrainHeight& terrain_height_m);

// Returns the height of terrain that changes, as TerrainHeight does.
using ChangingTerrainHeight = std::function<double(mars::LonLat place, double exaggeration, double time_s)>;
std::optional<Clearance> lowest_clearance(const Path& path, const FrameRate& rate,
                                          const ChangingTerrainHeight& terrain_height_m);

}  // namespace scripts
