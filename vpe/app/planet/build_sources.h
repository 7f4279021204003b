// From rasters named on the command line to what a planet is built from.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mars/sources/combine.h"
#include "paging/build/builder.h"
#include "vpe/app/cli/program.h"

namespace vpe::app {

// Options of `vpe build` that say how elevation rasters are understood and combined.
struct SourceArguments {
  std::vector<std::string> datums;  // [NAME=]DATUM
  std::string convert;              // empty = no, "base", or a datum
  std::string areoid;               // raster of the areoid
  std::string shape = "sphere";
  std::string level = "none";
  double feather_m = 0;
  bool reject_outliers = false;
  double blunder_m = mars::OutlierOptions().floor_m;
  std::string body;     // empty = as the sources
  double radius_m = 0;  // 0 = as the body
};

void add_source_options(CLI::App& command, SourceArguments& arguments);

// Combines opened elevation sources; sets body, radius and shape of the build. Throws UsageError, SourceError.
mars::Combined combine_sources(std::vector<std::shared_ptr<const mars::ElevationSource>> sources,
                               const SourceArguments& arguments, paging::BuildOptions& options);

// What was found, on stderr: notes, levels, blunders.
void say_findings(const mars::Combined& combined);
nlohmann::json findings_json(const mars::Combined& combined);

}  // namespace vpe::app
