// Images and kiosks that a scene file puts into the world: its tables [[picture]] and [[kiosk]].
//
//   [[picture]]                  # file, form; name, opacity = 1; lon, lat, and height above the ground or altitude
//   file = "map.png"
//   form = "pane"                # an upright rectangle on its lower edge; width_m, tall_m, heading = 0, tilt = 0
//   form = "billboard"           # turns to the camera about the vertical; width_m, tall_m
//   form = "photograph"          # of a camera at the place: yaw, pitch, roll, fov (vertical), distance_m
//   form = "dome"                # a panorama about the place; radius_m, fade_m, shape = "sphere" | "cylinder",
//                                # heading = 0 is added to its azimuths, replaces_ground = false
//   [[kiosk]]                    # a post with signs; name, lon, lat, heading = 0, size_m = 3, panorama
//   hotspots = "spots.txt"       # or one beside each hotspot of a file, size_m; beside_m = size_m to the north
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "mars/geodesy/sphere.h"
#include "objects/files/height_kind.h"

namespace objects {

enum class PosterForm : std::uint8_t { kPane, kBillboard, kPhotograph, kDome };

// Describes an image in the world. What belongs to other forms has no effect.
struct PosterEntry {
  std::string name;            // "": none
  std::filesystem::path file;  // PNG or JPEG; of domes a panorama with its metadata
  PosterForm form = PosterForm::kPane;
  std::optional<mars::LonLat> place;  // absent: as the panorama's metadata say; domes only
  HeightKind height_kind = HeightKind::kAboveGround;
  double height_m = 0;     // of the lower edge, or of the camera that took the image
  double opacity = 1;      // 0 to 1
  double width_m = 1;      // of panes and billboards
  double tall_m = 0;       // 0: in proportion to the image
  double heading_deg = 0;  // of panes: where the front faces; photographs: yaw; domes: is added to azimuths
  double pitch_deg = 0;    // of panes: by how much the top leans back; of photographs: up
  double roll_deg = 0;     // of photographs
  double fov_deg = 60;     // of photographs: from the lower to the upper edge
  double distance_m = 1;   // of photographs: from the camera to the plane of the image
  double radius_m = 1;     // of domes
  double fade_m = 1;       // of domes: distance of the camera from the middle, from which on nothing is seen
  bool is_cylinder = false;
  bool replaces_ground = false;  // the dome hides ground that is nearer than itself
  bool operator==(const PosterEntry& other) const {
    return name == other.name && file == other.file && form == other.form &&
           place.has_value() == other.place.has_value() &&
           (!place || (place->lon_deg == other.place->lon_deg && place->lat_deg == other.place->lat_deg)) &&
           height_kind == other.height_kind && height_m == other.height_m && opacity == other.opacity &&
           width_m == other.width_m && tall_m == other.tall_m && heading_deg == other.heading_deg &&
           pitch_deg == other.pitch_deg && roll_deg == other.roll_deg && fov_deg == other.fov_deg &&
           distance_m == other.distance_m && radius_m == other.radius_m && fade_m == other.fade_m &&
           is_cylinder == other.is_cylinder && replaces_ground == other.replaces_ground;
  }
};

// Describes a kiosk at a place, or one beside each hotspot of a file.
struct KioskEntry {
  std::string name;  // "": none
  mars::LonLat place;
  double heading_deg = 0;
  double size_m = 3;               // from the foot to the top
  std::filesystem::path panorama;  // of which it tells; empty: not stated. Does not affect images.
  std::filesystem::path hotspots;  // a file of hotspots; empty: the kiosk stands at `place`
  double beside_m = 0;             // of hotspots: how far to the north of them
};

}  // namespace objects
