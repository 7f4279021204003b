// How ground is drawn: one value that every backend draws the same (Hitchner 1992, 2.4; docs/appearance.md).
#pragma once

#include <string>

namespace vpe::core {

// How the surface is painted. Lit modes shade by the sun.
enum class Mode {
  kWireframe,  // edges of the drawn triangles
  kMarkers,    // a dot at each of their vertices
  kUnlit,      // `colour`, no light
  kLit,        // one colour, shaded
  kColoured,   // `colour`, shaded
  kTextured,   // imagery, shaded; as kColoured where the planet file has none
};

// What light and slope are computed from.
enum class Shading {
  kFlat,     // each drawn triangle
  kGouraud,  // each post of the surface; between posts interpolated
};

enum class Colour {
  kNone,       // one colour
  kElevation,  // metres above the sphere, without exaggeration
  kSlope,      // degrees between the normal and the vertical, of the ground as exaggerated
  kAspect,     // degrees clockwise from north of the way down, of the same
  kImage,      // the planet file's imagery at each post: colours of vertices
};

enum class Background { kBlack, kWhite, kSky };

// Both ends of palette=hsv; hue runs from one to the other without going round through 0, unless they are given
// so.
struct HsvRamp {
  double low_hue_deg = 240;
  double low_saturation = 0.9;
  double low_value = 0.85;
  double high_hue_deg = 0;
  double high_saturation = 0.9;
  double high_value = 0.95;
  bool operator==(const HsvRamp&) const = default;
};

struct Appearance : HsvRamp {
  Mode mode = Mode::kTextured;
  Shading shading = Shading::kGouraud;
  Colour colour = Colour::kElevation;
  std::string palette = "auto";  // a name, hsv, or a file; vpe/core/appearance/palette.h
  double palette_low = 0;        // values at the palette's ends; both equal: as suits `colour`
  double palette_high = 0;
  bool colourise = false;  // imagery keeps its brightness and takes hue and saturation from `colour`
  double exaggeration = 1;
  // Where the light comes from: "local" (azimuth and elevation at a place), a date, or Ls and local time;
  // mars/geodesy/mars_time.h.
  std::string sun = "local";
  double sun_azimuth_deg = 315;
  double sun_elevation_deg = 35;
  double sun_ambient = 0.05;
  double sun_diffuse = 1.235;
  bool shadows = false;
  double gamma = 1;
  double haze_visibility_m = 0;  // shading.h, transmittance(); 0 = clear air
  double marker_px = 3;
  Background background = Background::kSky;

  bool operator==(const Appearance&) const = default;
};

}  // namespace vpe::core
