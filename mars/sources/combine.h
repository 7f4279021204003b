// Opened elevation rasters -> the one source that a planet is built from: one datum, insets levelled and
// checked against what lies below them, stacked.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mars/sources/edge_matching.h"
#include "mars/sources/outliers.h"
#include "mars/sources/source.h"
#include "mars/sources/vertical_alignment.h"

namespace mars {

struct CombineOptions {
  double radius_m = kMarsRadius_m;  // of the planet's sphere
  bool true_radii = false;          // --shape radius: the datum becomes the sphere of radius_m
  bool convert = false;             // sources of other datums are converted, else refused
  VerticalDatum datum;              // to convert to; unknown = that of the coarsest source that says its own
  std::shared_ptr<const ElevationSource> areoid;  // see converted()
  // What gives way where an inset and what lies below it disagree at its rim.
  enum class VerticalAlignment {
    kNone,   // neither: the fade alone
    kPlane,  // the inset, by an offset and a tilt: fit_alignment()
    kEdges,  // what lies below, around the inset: fit_edge_matching()
  };
  VerticalAlignment level = VerticalAlignment::kNone;
  bool check_outliers = true;
  bool reject_outliers = false;
  OutlierOptions outliers;
  StackOptions stack{.feather_base_posts = 2};
};

// What was found out of one source.
struct CombineFinding {
  std::string name;
  std::optional<VerticalAlignment> level;
  std::optional<EdgeMatching> bend;  // of what lies below it
  std::optional<OutlierReport> outliers;
  bool masked = false;
};

struct Combined {
  std::shared_ptr<const ElevationSource> source;
  VerticalDatum datum;
  bool true_radii = false;               // also set when all that was given are radii
  std::vector<CombineFinding> findings;  // the coarsest first
  std::vector<std::string> notes;        // what a user should know, as sentences
};

// Throws SourceError: none given, a datum that does not fit (with the median difference where both sources have
// data), a body whose radius is more than kBodyMismatch off radius_m.
inline constexpr double kBodyMismatch = 0.2;
Combined combine_elevation(std::vector<std::shared_ptr<const ElevationSource>> sources,
                           const CombineOptions& options);

}  // namespace mars
