#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "mars/raster/placed_sources.h"
#include "mars/remote/gdal_remote.h"
#include "paging/build/build_inputs.h"
#include "paging/planet/planet_database.h"
#include "relief/files/relief_file.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/planet/build_request.h"
#include "vpe/app/planet/commands.h"
#include "vpe/app/planet/patch_changes.h"
#include "vpe/app/planet/planet_build.h"
#include "vpe/app/planet/remote_wait.h"
#include "vpe/app/planet/source_mask.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

struct PatchArguments {
  std::string planet;
  std::vector<std::string> dems;
  std::vector<std::string> images;
  std::vector<std::string> regions;
  std::string mask;
  std::string alignment;
  std::string datum;
  PlacementArguments placement;
  std::string folder;  // where the planet's own sources are looked for
  bool force = false;
  paging::BuildOptions options;
};

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code none;
  return fs::equivalent(a, b, none);
}

// Replaces a source's path in the request, also where options name it.
void rename_source(BuildRequest& request, const std::string& from, const std::string& to) {
  rename_placement(request.placement, from, to, rasters_of(request));
  for (auto* files : {&request.dems, &request.images})
    for (std::string& file : *files)
      if (file == from) file = to;
  if (request.sources.areoid == from) request.sources.areoid = to;
  for (auto* options : {&request.sources.datums, &request.sources.alignments, &request.sources.masks}) {
    for (std::string& text : *options) {
      NamedValue option = named_value(text);
      if (option.name == from) option.name = to;
      if (options == &request.sources.masks && option.value == from) option.value = to;
      text = option.name.empty() ? option.value : option.name + "=" + option.value;
    }
  }
}

// Finds the files of a request that are not where they were when the planet was built.
void find_sources(BuildRequest& request, const PatchArguments& arguments) {
  for (const std::string& file : files_of(request)) {
    std::error_code none;
    // What is neither a file nor one in these folders may be a name of GDAL's.
    if (mars::is_remote(mars::raster_name(file))) continue;
    std::vector<fs::path> places{fs::path(file),
                                 fs::path(arguments.planet).parent_path() / fs::path(file).filename()};
    if (!arguments.folder.empty()) places.insert(places.begin(), arguments.folder / fs::path(file).filename());
    const auto here =
        std::ranges::find_if(places, [&](const fs::path& place) { return fs::exists(place, none); });
    if (here != places.end() && *here != file) rename_source(request, file, here->string());
  }
}

// Returns what the planet was built from. Throws paging::PlanetError where the file does not tell.
BuildRequest request_of(const paging::PlanetMeta& meta, const PatchArguments& arguments) {
  if (meta.arguments.empty()) {
    throw paging::PlanetError(
        arguments.planet +
        ": cannot be patched: it does not tell from which sources it was built; build the planet "
        "again from all sources");
  }
  BuildRequest request;
  try {
    request = build_request(meta.arguments);
  } catch (const UsageError& e) {
    throw paging::PlanetError(arguments.planet +
                              ": cannot be patched: it was built by 'vpe build' with arguments that "
                              "this version does not have (" +
                              e.what() + "); build the planet again from all sources");
  }
  find_sources(request, arguments);
  return request;
}

// Throws unless all rasters and reliefs of the patch are new.
void require_new(const BuildRequest& request, const PatchArguments& arguments) {
  const auto check = [&](const std::vector<std::string>& known, const std::vector<std::string>& added) {
    for (auto file = added.begin(); file != added.end(); ++file) {
      const auto is_same = [&](const std::string& other) {
        return other == *file || is_same_file(other, *file);
      };
      if (std::ranges::any_of(known, is_same) || std::any_of(added.begin(), file, is_same)) {
        throw std::runtime_error(*file + ": is a source of " + arguments.planet +
                                 " already; to change how it is treated, build the planet again");
      }
    }
  };
  check(request.dems, arguments.dems);
  check(request.images, arguments.images);
}

// Throws where rasters that are no sources of their own, such as masks and the areoid, are not those of the build.
void require_equal_treatments(const paging::PlanetMeta& meta, const RequestedSources& sources,
                              const std::string& planet) {
  paging::PlanetMeta now = meta;
  now.sources = sources.combined.source->infos();
  for (std::size_t n = 0; n < std::min(meta.sources.size(), now.sources.size()); ++n) {
    const std::string was = paging::without_folders(meta.sources[n].treatment, meta);
    const std::string is = paging::without_folders(now.sources[n].treatment, now);
    if (was == is) continue;
    throw paging::PlanetError(planet + ": cannot be patched: " + meta.sources[n].name + " was treated as '" +
                              was + "', and is now '" + is +
                              "': a mask, the areoid or a raster below it has changed; build the planet again");
  }
}

// Adds the sources of the patch to those of the planet.
BuildRequest patched_request(BuildRequest request, const PatchArguments& arguments,
                             const paging::PlanetMeta& meta) {
  require_new(request, arguments);
  const bool has_options = !arguments.mask.empty() || !arguments.alignment.empty() || !arguments.datum.empty();
  if (has_options && std::ranges::all_of(arguments.dems, relief::is_relief_path))
    throw UsageError("--mask, --align and --datum are of elevation rasters, and none is given");
  if (!arguments.regions.empty() && request.regions.empty()) {
    throw UsageError("--region: " + arguments.planet +
                     " was built without it, so all of it has full resolution; leave it out");
  }
  std::vector<std::string> added = arguments.dems;
  added.insert(added.end(), arguments.images.begin(), arguments.images.end());
  add_placement(request.placement, arguments.placement, added);
  for (const std::string& dem : arguments.dems) {
    request.dems.push_back(dem);
    if (relief::is_relief_path(dem) || !has_options) continue;
    // Products of several files are known by the name of their label.
    const std::string name =
        mars::open_elevation(dem, placement_of(request.placement, dem, rasters_of(request), meta.radius_m))
            ->infos()
            .front()
            .name;
    if (!arguments.mask.empty()) request.sources.masks.push_back(name + "=" + arguments.mask);
    if (!arguments.alignment.empty()) request.sources.alignments.push_back(name + "=" + arguments.alignment);
    if (!arguments.datum.empty()) request.sources.datums.push_back(name + "=" + arguments.datum);
  }
  request.images.insert(request.images.end(), arguments.images.begin(), arguments.images.end());
  request.regions.insert(request.regions.end(), arguments.regions.begin(), arguments.regions.end());
  request.quantum_m = meta.quantum_m;
  return request;
}

// Tells the user what the planet's own options do to the added rasters.
void note_limits(const BuildRequest& request, const RequestedSources& sources, std::size_t known,
                 const paging::BuildOptions& options) {
  for (std::size_t n = known; n < sources.dems.size(); ++n) {
    const mars::SourceInfo info = sources.dems[n]->infos().front();
    if (request.finest_spacing_m > 1.5 * info.resolution_m) {
      std::fprintf(
          stderr,
          "vpe: note: posts of %s are %s apart, but those of the planet at least %s, as it was built with "
          "--spacing\n",
          info.name.c_str(), length_text(info.resolution_m).c_str(),
          length_text(request.finest_spacing_m).c_str());
    }
    const double step_m = paging::choose_quantum({info}, options.finest_spacing_m);
    if (step_m < options.quantum_m) {
      std::fprintf(
          stderr,
          "vpe: note: heights of %s are rounded to the planet's step of %s m; by itself it would have %s m, "
          "which a full build gives\n",
          info.name.c_str(), base::format_significant(options.quantum_m, 3).c_str(),
          base::format_significant(step_m, 3).c_str());
    }
  }
}

// Opens the sources that the planet was built from.
RequestedSources open_planet_sources(const BuildRequest& request, paging::BuildOptions& options,
                                     const PatchArguments& arguments) {
  try {
    return open_sources(request, options);
  } catch (const mars::SourceError& e) {
    throw mars::SourceError(std::string(e.what()) + " (a source of " + arguments.planet +
                            ": --sources FOLDER says where these are)");
  }
}

void patch(PatchArguments& arguments, const Common& common) {
  if (arguments.dems.empty() && arguments.images.empty())
    throw UsageError("nothing to patch with: name a DEM, or --image");
  paging::BuildOptions& options = arguments.options;
  options.threads = common.threads;
  const paging::PlanetMeta meta = paging::from_rows(
      paging::read_meta_rows(paging::open_planet_database(arguments.planet)), arguments.planet);
  const BuildRequest before = request_of(meta, arguments);
  const BuildRequest request = patched_request(before, arguments, meta);
  options.output = check_planet_file(options.output, files_of(request));
  options.tile_k = meta.tile.k;
  limit_rasters(common);

  paging::BuildOptions options_before = options;
  const RequestedSources sources_before = open_planet_sources(before, options_before, arguments);
  require_equal_treatments(meta, sources_before, arguments.planet);
  const RequestedSources sources = open_sources(request, options);
  if (!common.quiet) {
    print_findings(sources.combined);
    print_image_notes(sources, common);
    note_limits(request, sources, sources_before.dems.size(), options);
  }
  const paging::PatchedPlanet patched{
      arguments.planet, elevation_changes(sources_before, sources, request.sources.reject_outliers),
      image_changes(sources_before, sources)};
  paging::BuildPlan plan = paging::plan_tiles(options, *sources.combined.source);
  std::error_code none;
  if (!arguments.force && fs::exists(options.output, none) && !is_same_file(options.output, arguments.planet)) {
    paging::PlannedContent planned =
        paging::planned_content(options, plan, *sources.combined.source, sources.image.get());
    // The patch keeps the planet's where no place shows it.
    const bool has_nodata =
        std::ranges::any_of(meta.levels, [](const auto& level) { return level.nodata_posts > 0; });
    if (!has_nodata) planned.meta.fill_m = meta.fill_m;
    require_same_content(options.output, planned);
  }
  const paging::BuildSummary summary =
      run_build(options, *sources.combined.source, sources.image.get(), common, std::move(plan), &patched);
  print_build(summary, options.output, common, &sources.combined);
  if (!common.json && !common.quiet) {
    const std::int64_t all = summary.meta.tiles + summary.meta.image_tiles;
    std::printf("kept of %s: %lld of %lld tiles and image tiles\n", arguments.planet.c_str(),
                static_cast<long long>(summary.kept), static_cast<long long>(all));
  }
}

}  // namespace

void add_patch(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<PatchArguments>();
  CLI::App* command = add_command(program, "patch", "Add rasters to a finished planet file", common, true);
  command->add_option("PLANET", arguments->planet, "Planet file that 'vpe build' made")->required();
  command->add_option(
      "DEM", arguments->dems,
      "Elevation rasters to add; at each place the finest raster of all counts. Files of reliefs by formulas "
      "(*.relief.toml) dig and build");
  command->add_option("--image", arguments->images, "Image rasters to add")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("-o,--output", arguments->options.output, "Planet file to write; may be PLANET")
      ->required();
  command->add_option(
      "--mask", arguments->mask,
      "Leave out posts of DEM where this raster, a mask of any grid, is below 0.5 or has no data");
  command
      ->add_option("--align", arguments->alignment,
                   "plane: remove offset and tilt of DEM; edges: warp what lies below to meet DEM")
      ->check(CLI::IsMember({"none", "plane", "edges"}));
  command->add_option("--datum", arguments->datum,
                      "Vertical datum of DEM where it does not state one, as for 'vpe build'");
  add_placement_options(*command, arguments->placement);
  command
      ->add_option(
          "--region", arguments->regions,
          "WEST,SOUTH,EAST,NORTH: full resolution in this box too, where the planet was built with --region")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option(
      "--sources", arguments->folder,
      "Folder of the rasters that the planet was built from (default: where they were, or beside it)");
  command->add_flag("--force", arguments->force, "Replace a finished planet file of other sources or options");
  add_examples(*command,
               {{"a new strip, into a new file", "vpe patch gale.vpe strip.tif -o gale2.vpe"},
                {"only its trusted part, without its tilt; the file itself is replaced at the end",
                 "vpe patch gale.vpe strip.tif --mask trusted.tif --align plane -o gale.vpe"},
                {"a landing pad by formulas", "vpe patch gale.vpe pad.relief.toml -o gale2.vpe"},
                {"a new picture of the same ground", "vpe patch gale.vpe --image ortho.tif -o gale2.vpe"}});
  command->callback([arguments, &common] { patch(*arguments, common); });
}

}  // namespace vpe::app
