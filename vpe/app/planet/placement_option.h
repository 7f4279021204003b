// Options for rasters without a map: by which method control points place them, and on which heights an RPC does.
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <vector>

#include "mars/raster/placement/placement_options.h"

namespace vpe::app {

// Holds the options as given: [NAME=]VALUE, where NAME is a raster's path or file name. A value without a name is for
// all rasters; one with the name of a raster comes first for that.
struct PlacementArguments {
  std::vector<std::string> gcp_methods;
  std::vector<std::string> rpc_heights_m;
  std::vector<std::string> rpc_dems;
  std::vector<std::string> rpc_systems;

  bool operator==(const PlacementArguments&) const = default;
};

void add_placement_options(CLI::App& command, PlacementArguments& arguments);

// Appends the options to arguments of `vpe build`.
void append_arguments(const PlacementArguments& placement, std::vector<std::string>& arguments);

// Returns the options of one raster. `rasters` are all that are given: names are looked for among these. An RPC whose
// body nothing states is taken for one of body_radius_m (0: Mars). Throws UsageError for values that are no method, or
// no height within mars::kMostRpcHeight_m.
mars::PlacementOptions placement_of(const PlacementArguments& placement, const std::string& raster,
                                    std::span<const std::string> rasters, double body_radius_m);

// Returns the DEMs that RPCs need.
std::vector<std::string> placement_files(const PlacementArguments& placement,
                                         std::span<const std::string> rasters);

// Replaces a file's path, also where it names a raster.
void rename_placement(PlacementArguments& placement, const std::string& from, const std::string& to,
                      std::span<const std::string> rasters);

// Adds the options of another command for some rasters alone: values without a name get that of each of `added`.
void add_placement(PlacementArguments& placement, const PlacementArguments& more,
                   std::span<const std::string> added);

}  // namespace vpe::app
