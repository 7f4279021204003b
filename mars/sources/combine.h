// Combines opened elevation rasters into the one source from which a planet is built: converts them to one
// datum, aligns insets to the coarser rasters below them, finds outliers, and stacks the results.
//
// Typical usage:
//   CombineOptions options;
//   options.alignment = CombineOptions::Alignment::kPlane;
//   const Combined combined = combine_elevation({open_elevation(base), open_elevation(inset)}, options);
//   combined.source->sample(directions, spacing_m, heights_m);
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mars/sources/edge_matching.h"
#include "mars/sources/outliers.h"
#include "mars/sources/source.h"
#include "mars/sources/vertical_alignment.h"

namespace mars {

struct CombineOptions {
  // Selects what changes where an inset and its base disagree at the boundary of the inset.
  enum class Alignment {
    kNone,   // nothing: the stack fades one into the other
    kPlane,  // the inset, by an offset and a tilt: fit_alignment()
    kEdges,  // the base around the inset: fit_edge_matching()
  };

  double radius_m = kMarsRadius_m;  // of the planet's sphere
  bool true_radii = false;          // --shape radius: the datum becomes the sphere of radius_m
  // Converts sources of other datums. Without it they are refused, because mixing datums shifts the ground by
  // up to kilometres.
  bool convert = false;
  // Target of the conversion. Unknown: the datum of the coarsest source that states its own.
  VerticalDatum datum;
  // Names of sources of unknown datum that have that of the others, whatever these differ by. Others of unknown
  // datum are refused if they differ too much, see check_silent_datums().
  std::set<std::string> same_datum;
  std::shared_ptr<const ElevationSource> areoid;  // see conversion()
  Alignment alignment = Alignment::kNone;
  std::map<std::string, Alignment> alignments;  // by SourceInfo::name, for single sources
  bool check_outliers = true;                   // costs one more look at a subset of the posts
  bool reject_outliers = false;                 // leaves outliers out; implies check_outliers
  OutlierOptions outliers;
  // Two posts of the base: a narrower fade is finer than the base can show, a wider one hides more of the
  // inset.
  StackOptions stack{.feather_base_posts = 2};
  // Applied to each source after all checks and alignments, before the sources are stacked. Empty: nothing.
  std::function<std::shared_ptr<const ElevationSource>(std::shared_ptr<const ElevationSource>)> finish;
};

// Reports what was found about one source.
struct CombineFinding {
  std::string name;
  std::optional<VerticalAlignment> alignment;
  std::optional<EdgeMatching> edge_matching;  // of the base below it
  std::optional<OutlierReport> outliers;
  bool masked = false;  // its outliers were left out
};

struct Combined {
  std::shared_ptr<const ElevationSource> source;
  VerticalDatum datum;
  bool true_radii = false;               // also true if all given sources are radii
  std::vector<CombineFinding> findings;  // the coarsest source first
  std::vector<std::string> notes;        // sentences for the user, those of the sources among them
};

// Combines the sources. Throws SourceError if there are none, if a datum does not fit (the message states the
// median difference where both sources have data), or if a check of source_checks.h fails.
Combined combine_elevation(std::vector<std::shared_ptr<const ElevationSource>> sources,
                           const CombineOptions& options);

}  // namespace mars
