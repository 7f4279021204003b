// The ends of the palette by the view: palette.low=auto and palette.high=auto.
//
// What a view shows is found by rays in a reduced image of it, whichever backend draws the image. So the ends
// do not depend on the backend, the number of threads, the size of the image nor on what was drawn before.
//
// Typical usage:
//   if (needs_view_palette(request.settings, *planet)) {
//     ViewPalette view(planet, common);
//     view.add(reduced(request));
//     take_ends(request.settings, view.ends());
//   }
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "paging/planet/planet_file.h"
#include "vpe/app/cli/program.h"
#include "vpe/core/appearance/palette.h"
#include "vpe/core/frame.h"

namespace vpe::app {

// Shares of the visible ground, by its area in the image, below the low end and above the high end.
inline constexpr double kBeyondPaletteEnd = 0.02;

// The longer side of a reduced image. Larger: ends by more samples, slower.
inline constexpr int kReducedSide_px = 320;

// Returns true if the settings take an end of the palette from the view, and show its colours or a legend of
// them.
bool needs_view_palette(const core::SettingsValues& settings, const paging::PlanetFile& planet);

// Returns the request with its view reduced to kReducedSide_px. The view must have no part.
core::DrawRequest reduced(core::DrawRequest request);

// Returns the ends for values that are shown, rounded outwards to a step of 1, 2 or 5 times a power of ten that
// is at most a twentieth of their distance; nullopt without values. Reorders the values.
std::optional<core::PaletteEnds> palette_ends(std::vector<double>& values);

// Returns the ends for differences: as far from 0 as the largest one, rounded away from 0 to a step of 1, 2 or 5 times a
// power of ten that is at most a twentieth of it, and at least 0.1 m.
core::PaletteEnds difference_ends(std::span<const double> values);

// Collects what views show. One thread at a time.
class ViewPalette {
 public:
  ViewPalette(std::shared_ptr<const paging::PlanetFile> planet, const Common& common);
  ~ViewPalette();

  // Goes over to another version of the planet. What was added stays.
  void change_planet(std::shared_ptr<const paging::PlanetFile> planet);

  // Adds the values, of the colour of its settings, that every pixel of a request's view shows; ground without
  // data has none. Elevations are those of the pixels; slopes those that are painted, to within 0.2 degrees.
  // Differences are those of the nearest posts, which are about as far apart as the pixels. Throws what renderers throw,
  // and UsageError for differences of a planet without another one (PlanetFile::earlier()).
  void add(const core::DrawRequest& request);

  // Forgets what was added. Terrain that was read is kept.
  void clear() { values_.clear(); }

  // Returns the ends for all that was added; 0 and 0 if that is only sky, 0 and 360 for aspect, which is a
  // circle.
  core::PaletteEnds ends();

 private:
  class Differences;

  std::shared_ptr<const paging::PlanetFile> planet_;
  std::unique_ptr<core::Renderer> rays_;
  std::vector<double> values_;
  bool is_circle_ = false;
  bool is_difference_ = false;
};

// Puts the ends of the view in place of auto.
void take_ends(core::SettingsValues& settings, const core::PaletteEnds& view);

// Does the same to settings that are written to files.
void take_ends(core::Settings& settings, const core::PaletteEnds& view);

// Returns text such as "palette from -4500 to -2200 m, by the view".
std::string palette_text(const core::SettingsValues& settings);

}  // namespace vpe::app
