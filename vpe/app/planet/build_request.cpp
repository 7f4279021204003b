#include "vpe/app/planet/build_request.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "mars/embedded/embedded.h"
#include "mars/geodesy/bodies.h"
#include "mars/raster/placed_sources.h"
#include "mars/sources/layered_image.h"
#include "mars/sources/source_checks.h"
#include "relief/files/relief_file.h"
#include "relief/relief_source.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/planet/layer_names.h"
#include "vpe/app/planet/source_mask.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

constexpr const char* kEmbedded = "embedded";

// Returns true for the word `embedded`, which stands for the embedded Mars unless a file has that name.
bool is_embedded(const std::string& path) {
  std::error_code none;
  return path == kEmbedded && !std::filesystem::exists(path, none);
}

// Returns the finest spacing of the embedded Mars in this build. It is defined at every spacing: within regions
// it is as fine as requested, elsewhere as fine as in the cached planet.
double embedded_finest_m(const paging::BuildOptions& options) {
  return options.regions.empty() ? 0.0 : options.finest_spacing_m;
}

// Returns the radius of the body that the user names, 0 if they name none.
double named_radius_m(const SourceArguments& arguments) {
  if (arguments.radius_m > 0) return arguments.radius_m;
  const mars::Body* body = mars::find_body(std::string_view(arguments.body));
  return body != nullptr ? body->radius_m : 0;
}

// Throws UsageError for values of options that no raster of the request asks for.
void check_placement(const BuildRequest& request, const std::vector<std::string>& rasters) {
  for (const std::string& path : rasters) placement_of(request.placement, path, rasters, 0);
}

void add_reliefs(const BuildRequest& request, double radius_m, RequestedSources& sources) {
  std::shared_ptr<const mars::ElevationSource>& ground = sources.combined.source;
  for (const std::string& path : request.dems) {
    if (!relief::is_relief_path(path)) continue;
    try {
      sources.reliefs.push_back(
          relief::place(relief::read_relief_file(path), radius_m, relief::ground_of(ground)));
    } catch (const mars::SourceError&) {
      throw;
    } catch (const std::runtime_error& e) {
      const std::string what = e.what();
      throw mars::SourceError(what.starts_with(path) ? what : path + ": " + what);
    }
    ground = relief::with_relief(ground, sources.reliefs.back(),
                                 relief::relief_info(path, sources.reliefs.back().placed().size()));
  }
}

}  // namespace

void add_build_request(CLI::App& command, BuildRequest& request) {
  command.add_option(
      "DEM", request.dems,
      "Elevation rasters in any format of GDAL, or 'embedded'; at each place the finest one counts. Files of "
      "reliefs by formulas (*.relief.toml) change the ground of all rasters, in their order");
  command.add_option("--image", request.images, "Image rasters, or 'embedded'")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_flag(
      "--images-apart{stem}", request.images_apart,
      "Keep each image as a layer too, for image.layers; named by its file, or in the order of --image by "
      "--images-apart='NAME;NAME'");
  command.add_flag("--match-colour", request.match_colour,
                   "Match the colours of each image to those of the coarser images below it, at its boundary");
  command
      .add_option("--region", request.regions,
                  "WEST,SOUTH,EAST,NORTH: build full resolution only in this box, degrees (repeatable)")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option("--spacing", request.finest_spacing_m,
                  "Finest post spacing, metres (default: that of the rasters)")
      ->check(number_within(0.01, 1e6));
  command
      .add_option("--image-spacing", request.finest_image_m,
                  "Finest pixel spacing of imagery, metres (default: that of the images)")
      ->check(number_within(0.01, 1e6));
  command
      .add_option("--base-spacing", request.base_spacing_m, "Post spacing where nothing finer is built, metres")
      ->check(number_within(100.0, 1e6))
      ->capture_default_str();
  command
      .add_option("--height-step", request.quantum_m,
                  "Step of stored heights, metres (default: well below what the rasters resolve)")
      ->check(number_within(1e-6, 1e3));
  add_source_options(command, request.sources);
  add_placement_options(command, request.placement);
  command
      .add_option(
          "--detail", request.detail,
          "synthetic: add marked synthetic detail of Mars below the resolution of the rasters, down to --spacing; "
          "none: leave it out, also of 'embedded' (default: below 'embedded' alone)")
      ->check(CLI::IsMember({"synthetic", "none"}));
}

std::vector<std::string> to_arguments(const BuildRequest& request) {
  std::vector<std::string> out = request.dems;
  const BuildRequest defaults;
  // A value may begin with a minus.
  const auto add = [&](const std::string& name, const std::string& value) {
    out.push_back(name + "=" + value);
  };
  const auto add_text = [&](const std::string& name, const std::string& value, const std::string& unset) {
    if (value != unset) add(name, value);
  };
  const auto add_number = [&](const std::string& name, double value, double unset) {
    if (value != unset) add(name, base::format_number(value));
  };
  const auto add_all = [&](const std::string& name, const std::vector<std::string>& values) {
    for (const std::string& value : values) add(name, value);
  };
  add_all("--image", request.images);
  add_text("--images-apart", request.images_apart, defaults.images_apart);
  if (request.match_colour) out.emplace_back("--match-colour");
  add_all("--region", request.regions);
  add_number("--spacing", request.finest_spacing_m, defaults.finest_spacing_m);
  add_number("--image-spacing", request.finest_image_m, defaults.finest_image_m);
  add_number("--base-spacing", request.base_spacing_m, defaults.base_spacing_m);
  add_number("--height-step", request.quantum_m, defaults.quantum_m);
  const SourceArguments& s = request.sources;
  add_all("--datum", s.datums);
  add_text("--to-datum", s.to_datum, defaults.sources.to_datum);
  add_text("--areoid", s.areoid, defaults.sources.areoid);
  add_text("--shape", s.shape, defaults.sources.shape);
  add_all("--align", s.alignments);
  add_all("--mask", s.masks);
  add_number("--feather", s.feather_m, defaults.sources.feather_m);
  if (s.reject_outliers) out.emplace_back("--reject-outliers");
  add_number("--blunder", s.outlier_floor_m, defaults.sources.outlier_floor_m);
  add_text("--body", s.body, defaults.sources.body);
  add_number("--radius", s.radius_m, defaults.sources.radius_m);
  append_arguments(request.placement, out);
  add_text("--detail", request.detail, defaults.detail);
  return out;
}

BuildRequest build_request(const std::vector<std::string>& arguments) {
  BuildRequest request;
  CLI::App parser;
  add_build_request(parser, request);
  try {
    parser.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& e) {
    throw UsageError(e.what());
  }
  return request;
}

paging::Region parse_region(const std::string& text) {
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 4) {
    throw UsageError("--region '" + text + "': expected WEST,SOUTH,EAST,NORTH in degrees");
  }
  const paging::Region region{(*numbers)[0], (*numbers)[1], (*numbers)[2], (*numbers)[3]};
  if (region.south_deg >= region.north_deg || region.south_deg < -90 || region.north_deg > 90) {
    throw UsageError("--region '" + text + "': south must lie below north, both within -90..90");
  }
  return region;
}

std::vector<std::string> files_of(const BuildRequest& request) {
  std::vector<std::string> files = request.dems;
  files.insert(files.end(), request.images.begin(), request.images.end());
  std::erase_if(files, is_embedded);
  if (!request.sources.areoid.empty()) files.push_back(request.sources.areoid);
  for (const std::string& mask : request.sources.masks) files.push_back(named_value(mask).value);
  for (const std::string& dem : placement_files(request.placement, rasters_of(request))) files.push_back(dem);
  return files;
}

std::vector<std::string> rasters_of(const BuildRequest& request) {
  std::vector<std::string> rasters = request.dems;
  rasters.insert(rasters.end(), request.images.begin(), request.images.end());
  return rasters;
}

RequestedSources open_sources(const BuildRequest& request, paging::BuildOptions& options) {
  options.regions.clear();
  for (const std::string& text : request.regions) options.regions.push_back(parse_region(text));
  options.base_spacing_m = request.base_spacing_m;
  options.finest_spacing_m = request.finest_spacing_m;
  options.finest_image_m = request.finest_image_m;
  options.quantum_m = request.quantum_m;
  options.arguments = to_arguments(request);
  const bool has_detail = request.detail != "none";
  SourceArguments arguments = request.sources;
  arguments.adds_detail = request.detail == "synthetic";
  const mars::EmbeddedOptions embedded{.finest_m = embedded_finest_m(options), .detail = has_detail};

  RequestedSources sources;
  const std::vector<std::string> rasters = rasters_of(request);
  check_placement(request, rasters);
  const auto placement = [&](const std::string& path, double body_radius_m) {
    return placement_of(request.placement, path, rasters, body_radius_m);
  };
  for (const std::string& path : request.dems) {
    if (relief::is_relief_path(path)) continue;
    sources.dems.push_back(is_embedded(path)
                               ? mars::embedded_elevation(embedded)
                               : mars::open_elevation(path, placement(path, named_radius_m(request.sources))));
  }
  if (sources.dems.empty() && !request.dems.empty())
    throw UsageError(request.dems.front() +
                     ": reliefs change the ground of a raster; name one too, or 'embedded'");
  apply_masks(arguments.masks, sources.dems);
  sources.combined = combine_sources(sources.dems, arguments, options);
  add_reliefs(request, options.radius_m, sources);
  for (const std::string& path : request.images) {
    sources.images.push_back(is_embedded(path) ? mars::embedded_image(embedded)
                                               : mars::open_image(path, placement(path, options.radius_m)));
    mars::check_body(sources.images.back()->infos().front(), options.radius_m);
  }
  if (request.match_colour) sources.image_notes = match_colours(sources.images);
  if (sources.images.empty()) {
    if (request.match_colour || !request.images_apart.empty())
      throw UsageError(
          "--images-apart and --match-colour are of images, and none is given; name them with --image");
  } else if (!request.images_apart.empty()) {
    const std::vector<std::string> names = layer_names(request.images, request.images_apart);
    std::vector<mars::NamedImage> named;
    for (std::size_t n = 0; n < names.size(); ++n) named.push_back({names[n], sources.images[n]});
    sources.image = mars::stack_images_apart(std::move(named));
  } else {
    sources.image = sources.images.size() == 1 ? sources.images.front() : mars::stack_images(sources.images);
  }
  return sources;
}

void print_image_notes(const RequestedSources& sources, const Common& common) {
  if (common.quiet) return;
  for (const std::string& note : sources.image_notes) std::fprintf(stderr, "vpe: note: %s\n", note.c_str());
}

}  // namespace vpe::app
