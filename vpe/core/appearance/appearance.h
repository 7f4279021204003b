// The appearance of ground: one value that both backends draw the same (Hitchner 1992, section 2.4;
// docs/design/appearance.md).
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>

namespace vpe::core {

// The way the surface is painted. Lit modes are shaded by the sun, unless Appearance::light says otherwise.
enum class Mode {
  kWireframe,  // edges of the drawn triangles
  kMarkers,    // a dot at each of their vertices
  kUnlit,      // `colour` without light
  kLit,        // one colour, shaded
  kColoured,   // `colour`, shaded
  kTextured,   // imagery, shaded; as kColoured where the planet file has none
};

// The elements for which light and slope are computed.
enum class Shading {
  kFlat,     // each drawn triangle
  kGouraud,  // each post of the surface; interpolated between posts
  // Light: each vertex of the drawn triangles, interpolated over them. Slope and aspect: each drawn triangle. Triangles only:
  // rays refuse it.
  kVertex,
};

// The value that the colour of the ground shows.
enum class Colour {
  kNone,        // one colour everywhere
  kElevation,   // metres above the sphere, without exaggeration
  kSlope,       // degrees between the normal and the vertical, of the exaggerated ground
  kAspect,      // degrees clockwise from north of the direction of descent, of the exaggerated ground
  kImage,       // the planet file's imagery at each post, as colours of vertices
  kDifference,  // metres above the ground of another planet (PlanetFile::compared_with()), without exaggeration
};

// Whether the sun lights ground in the lit modes. kOff: colours and imagery are as they are. kAuto: off for imagery that the
// planet file knows as photographs with their own light, on otherwise (light_choice.h).
enum class Light { kAuto, kOn, kOff };

enum class Background { kBlack, kWhite, kSky };

// The colour, 0 to 255, of ground of Mars that shows no value and no imagery.
inline constexpr glm::dvec3 kPlainGround{178, 142, 112};

// The air of background=sky and of haze; sky.h, air_of(). kAuto: that of the planet's body.
enum class Atmosphere { kAuto, kNone, kMars, kEarth, kVenus, kTitan };

// Holds both ends of palette=hsv. Hue runs from one to the other; it passes through 0 only if the values are
// given so that it does (for example 350 to 370).
struct HsvRamp {
  double low_hue_deg = 240;
  double low_saturation = 0.9;
  double low_value = 0.85;
  double high_hue_deg = 0;
  double high_saturation = 0.9;
  double high_value = 0.95;
  bool operator==(const HsvRamp&) const = default;
};

// Holds all settings of the appearance of ground and sky. The keys are in settings.cpp.
struct Appearance : HsvRamp {
  Mode mode = Mode::kTextured;
  Shading shading = Shading::kGouraud;
  Colour colour = Colour::kElevation;
  std::string palette = "auto";  // a name, hsv, or a file; vpe/core/appearance/palette.h
  // Values at the palette's ends; if both are equal, a range that suits `colour`. nullopt: as the view asks
  // for, which whoever draws decides first (vpe/app/picture/view_palette.h); ColourScale refuses it.
  std::optional<double> palette_low = 0.0;
  std::optional<double> palette_high = 0.0;
  // The values of imagery that are black and white, 0 to 255, and the gamma between them; larger: brighter.
  double image_low = 0;
  double image_high = 255;
  double image_gamma = 1;
  // The layers of imagery that are shown (vpe/core/appearance/image_layers.h); "": as the planet file was built.
  std::string image_layers;
  bool colourise = false;  // imagery keeps its brightness and takes hue and saturation from `colour`
  Light light = Light::kAuto;
  double exaggeration = 1;  // factor on elevations; larger: steeper ground and larger errors
  // Position of the sun: "local" (azimuth and elevation at the ground below the camera), a date, or Ls and
  // local time; mars/geodesy/mars_time.h.
  std::string sun = "local";
  double sun_azimuth_deg = 315;
  double sun_elevation_deg = 35;
  double sun_ambient = 0.05;     // larger: brighter shadows
  double sun_diffuse = 1.235;    // larger: brighter slopes that face the sun
  bool shadows = false;          // ground casts shadows; slower
  double gamma = 1;              // larger: brighter
  double haze_visibility_m = 0;  // shading.h, transmittance(); 0: clear air, else smaller: denser haze
  double marker_px = 3;
  Background background = Background::kSky;
  Atmosphere atmosphere = Atmosphere::kAuto;
  // Colour of ground that shows no value and no imagery. It has no key: for_body() sets it.
  glm::dvec3 plain_ground = kPlainGround;

  bool operator==(const Appearance&) const = default;
};

}  // namespace vpe::core
