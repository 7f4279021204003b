// The elevation source of a planet, combined from the rasters named on the command line.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "mars/sources/combine.h"
#include "paging/build/builder.h"
#include "vpe/app/cli/program.h"

namespace vpe::app {

// Options of `vpe build` that say how elevation rasters are interpreted and combined.
struct SourceArguments {
  std::vector<std::string> datums;  // [NAME=]DATUM
  std::string to_datum;  // empty: no conversion; "base": the datum of the coarsest raster; or a datum
  std::string areoid;    // raster of the areoid
  std::string shape = "sphere";
  std::vector<std::string> alignments;  // [NAME=]none, plane or edges
  std::vector<std::string> masks;       // NAME=RASTER
  double feather_m = 0;                 // 0: mars::StackOptions' default
  bool reject_outliers = false;
  double outlier_floor_m = mars::OutlierOptions().floor_m;
  std::string body;          // empty: the body of the sources
  double radius_m = 0;       // 0: the body's radius
  bool adds_detail = false;  // synthetic detail below data that have none
};

void add_source_options(CLI::App& command, SourceArguments& arguments);

// Combines opened elevation sources, and sets body, radius and shape of the build. Throws UsageError and
// mars::SourceError.
mars::Combined combine_sources(std::vector<std::shared_ptr<const mars::ElevationSource>> sources,
                               const SourceArguments& arguments, paging::BuildOptions& options);

// Prints on stderr what was found about the sources: notes, vertical alignments, edge matchings and outliers.
void print_findings(const mars::Combined& combined);

// Returns the findings as a list, the coarsest source first. Keys of what was not computed are null.
nlohmann::json findings_json(const mars::Combined& combined);

}  // namespace vpe::app
