// The configurations of `vpe report error-time`: the swept settings, their values, and the exact references.
#pragma once

#include "paging/planet/planet_file.h"
#include "vpe/app/report/report_error_time_views.h"
#include "vpe/report/error_time.h"

namespace vpe::app {

// Names of the renderers that configurations use.
inline constexpr const char* kTriangles = "triangles";
inline constexpr const char* kPlainTriangles = "triangles without textures";
inline constexpr const char* kRayImages = "rays";
inline constexpr const char* kEmbreeRanges = "Embree";

struct ConfigurationOptions {
  int width = 640;
  int height = 360;
  bool is_short = false;     // fewer values of every setting, smaller images of many samples and panoramas
  bool has_gpu = false;      // decides what is drawn when no backend is named
  bool with_embree = false;  // adds Embree, as the baseline
};

// Returns all sweeps of one view. The baseline is rays in mode exact, or Embree's ranges.
report::Subject subject_of(const NamedView& view, const paging::PlanetFile& planet,
                           const ConfigurationOptions& options);

}  // namespace vpe::app
