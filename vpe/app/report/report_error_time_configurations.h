// The ways of `vpe report error-time`: which knobs are turned, how far, and what counts as exact.
#pragma once

#include "paging/planet/planet_file.h"
#include "vpe/app/report/report_error_time_views.h"
#include "vpe/report/error_time.h"

namespace vpe::app {

// Names of renderers that ways ask for.
inline constexpr const char* kTriangles = "triangles";
inline constexpr const char* kPlainTriangles = "triangles without textures";
inline constexpr const char* kRayImages = "rays";
inline constexpr const char* kEmbreeRanges = "Embree";

struct ConfigurationOptions {
  int width = 640;
  int height = 360;
  bool is_short = false;     // fewer values of every knob, smaller images of many samples and panoramas
  bool has_gpu = false;      // for what is drawn when no backend is named
  bool with_embree = false;  // which is the baseline then
};

// All sweeps of one view. The baseline is rays in mode exact, or Embree's ranges.
report::Subject subject_of(const NamedView& view, const paging::PlanetFile& planet,
                           const ConfigurationOptions& options);

}  // namespace vpe::app
