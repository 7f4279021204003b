#include "vpe/app/planet/placement_option.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "vpe/app/cli/program.h"
#include "vpe/app/planet/source_mask.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

using Values = std::vector<std::string> PlacementArguments::*;

struct PlacementOption {
  const char* name;
  Values values;
  const char* help;
};

constexpr std::array<PlacementOption, 4> kPlacementOptions{{
    {"--gcp-method", &PlacementArguments::gcp_methods,
     "[NAME=]METHOD: how control points place rasters without a map, or the raster NAME alone: polynomial1, "
     "polynomial2, polynomial3 or tps, a thin-plate spline (default: tps for 10 to 2000 points, else the highest "
     "polynomial that they allow) (repeatable)"},
    {"--rpc-height", &PlacementArguments::rpc_heights_m,
     "[NAME=]METRES: height of the ground for rasters that an RPC places, above its surface, -100000 to 100000 "
     "(default: the RPC's own) (repeatable)"},
    {"--rpc-dem", &PlacementArguments::rpc_dems,
     "[NAME=]RASTER: elevation of the ground for rasters that an RPC places, in place of a height (repeatable)"},
    {"--rpc-crs", &PlacementArguments::rpc_systems,
     "[NAME=]CRS: geographic system of RPCs whose rasters name none, such as IAU_2015:49900 (default: the sphere of "
     "the body; WGS 84 for the Earth) (repeatable)"},
}};

// Divides [NAME=]VALUE at the first equals sign before which a raster is named.
NamedValue divided(const std::string& text, std::span<const std::string> rasters) {
  for (std::size_t at = text.find('='); at != std::string::npos; at = text.find('=', at + 1)) {
    const std::string name = text.substr(0, at);
    const bool is_raster = std::ranges::any_of(rasters, [&](const std::string& raster) {
      return raster == name || std::filesystem::path(raster).filename().string() == name;
    });
    if (is_raster) return {name, text.substr(at + 1)};
  }
  return {"", text};
}

// Returns the value for a raster, the last one given; "" if there is none.
std::string value_for(const std::vector<std::string>& texts, const std::string& raster,
                      std::span<const std::string> rasters) {
  std::string general;
  std::string own;
  for (const std::string& text : texts) {
    const NamedValue option = divided(text, rasters);
    if (option.name.empty()) general = option.value;
    if (option.name == raster ||
        (!option.name.empty() && option.name == std::filesystem::path(raster).filename().string())) {
      own = option.value;
    }
  }
  return own.empty() ? general : own;
}

}  // namespace

void add_placement_options(CLI::App& command, PlacementArguments& arguments) {
  for (const PlacementOption& option : kPlacementOptions) {
    command.add_option(option.name, arguments.*option.values, option.help)
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  }
}

void append_arguments(const PlacementArguments& placement, std::vector<std::string>& arguments) {
  for (const PlacementOption& option : kPlacementOptions) {
    for (const std::string& value : placement.*option.values)
      arguments.push_back(std::string(option.name) + "=" + value);
  }
}

mars::PlacementOptions placement_of(const PlacementArguments& placement, const std::string& raster,
                                    std::span<const std::string> rasters, double body_radius_m) {
  mars::PlacementOptions options;
  options.body_radius_m = body_radius_m;
  if (const std::string method = value_for(placement.gcp_methods, raster, rasters); !method.empty()) {
    const auto parsed = mars::parse_gcp_method(method);
    if (!parsed) {
      throw UsageError(
          "--gcp-method " + method +
          ": expected polynomial1, polynomial2, polynomial3 or tps, or NAME=METHOD with the name of a "
          "raster that is given");
    }
    options.gcp_method = *parsed;
  }
  if (const std::string height = value_for(placement.rpc_heights_m, raster, rasters); !height.empty()) {
    options.rpc_height_m = base::parse_number(height);
    if (!options.rpc_height_m || std::abs(*options.rpc_height_m) > mars::kMostRpcHeight_m) {
      throw UsageError(
          "--rpc-height " + height +
          ": expected metres from -100000 to 100000, or NAME=METRES with the name of a raster that is "
          "given");
    }
  }
  options.rpc_dem = value_for(placement.rpc_dems, raster, rasters);
  options.rpc_crs = value_for(placement.rpc_systems, raster, rasters);
  return options;
}

std::vector<std::string> placement_files(const PlacementArguments& placement,
                                         std::span<const std::string> rasters) {
  std::vector<std::string> files;
  for (const std::string& text : placement.rpc_dems) files.push_back(divided(text, rasters).value);
  return files;
}

void rename_placement(PlacementArguments& placement, const std::string& from, const std::string& to,
                      std::span<const std::string> rasters) {
  for (const PlacementOption& each : kPlacementOptions) {
    for (std::string& text : placement.*each.values) {
      NamedValue option = divided(text, rasters);
      if (option.name == from) option.name = to;
      if (each.values == &PlacementArguments::rpc_dems && option.value == from) option.value = to;
      text = option.name.empty() ? option.value : option.name + "=" + option.value;
    }
  }
}

void add_placement(PlacementArguments& placement, const PlacementArguments& more,
                   std::span<const std::string> added) {
  for (const PlacementOption& each : kPlacementOptions) {
    for (const std::string& text : more.*each.values) {
      if (!divided(text, added).name.empty()) {
        (placement.*each.values).push_back(text);
        continue;
      }
      for (const std::string& raster : added) (placement.*each.values).push_back(raster + "=" + text);
    }
  }
}

}  // namespace vpe::app
