#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "mars/embedded/embedded.h"
#include "mars/sources/source_checks.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/planet/build_sources.h"
#include "vpe/app/planet/commands.h"
#include "vpe/app/planet/planet_build.h"
#include "vpe/app/planet/shard_option.h"

namespace vpe::app {

namespace {

struct BuildArguments {
  std::vector<std::string> dems;
  std::vector<std::string> images;
  std::vector<std::string> regions;
  SourceArguments sources;
  std::string detail;
  std::string part;
  bool estimate = false;
  bool force = false;
  paging::BuildOptions options;
};

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

// Returns true for the word `embedded`, which stands for the embedded Mars unless a file has that name.
bool is_embedded(const std::string& path) {
  std::error_code none;
  return path == "embedded" && !std::filesystem::exists(path, none);
}

// Returns the finest spacing of the embedded Mars in this build. It is defined at every spacing: within regions
// it is as fine as requested, elsewhere as fine as in the cached planet.
double embedded_finest_m(const paging::BuildOptions& options) {
  return options.regions.empty() ? 0.0 : options.finest_spacing_m;
}

void build(BuildArguments& arguments, const Common& common) {
  paging::BuildOptions& options = arguments.options;
  for (const std::string& text : arguments.regions) options.regions.push_back(parse_region(text));
  options.threads = common.threads;
  options.shard = parse_shard(arguments.part);
  require_count_of_parts(arguments.part, options.output, options.shard);
  options.output = shard_file_name(options.output, options.shard);
  std::vector<std::string> inputs = arguments.dems;
  inputs.insert(inputs.end(), arguments.images.begin(), arguments.images.end());
  options.output = check_planet_file(options.output, inputs);
  limit_rasters(common);
  const bool has_detail = arguments.detail != "none";
  arguments.sources.adds_detail = arguments.detail == "synthetic";
  std::vector<std::shared_ptr<const mars::ElevationSource>> dems;
  for (const std::string& path : arguments.dems) {
    dems.push_back(is_embedded(path) ? mars::embedded_elevation(
                                           {.finest_m = embedded_finest_m(options), .detail = has_detail})
                                     : mars::open_elevation(path));
  }
  const mars::Combined combined = combine_sources(std::move(dems), arguments.sources, options);
  if (!common.quiet) print_findings(combined);
  std::vector<std::shared_ptr<const mars::ImageSource>> images;
  for (const std::string& path : arguments.images) {
    images.push_back(is_embedded(path)
                         ? mars::embedded_image({.finest_m = embedded_finest_m(options), .detail = has_detail})
                         : mars::open_image(path));
    mars::check_body(images.back()->infos().front(), options.radius_m);
  }
  std::shared_ptr<const mars::ImageSource> image;
  if (!images.empty()) image = images.size() == 1 ? images.front() : mars::stack_images(images);

  paging::BuildPlan plan = paging::plan_tiles(options, *combined.source);
  const paging::BuildEstimate estimate = paging::estimate_build(options, plan, *combined.source, image.get());
  if (arguments.estimate) {
    print_estimate_only(estimate, common);
    return;
  }
  if (!arguments.force && std::filesystem::exists(options.output))
    require_same_content(options.output, paging::planned_content(options, plan, *combined.source, image.get()));
  options.keep_shard = !arguments.force;
  print_estimate(estimate, common);
  const paging::BuildSummary summary =
      run_build(options, *combined.source, image.get(), common, std::move(plan));
  if (summary.is_kept_whole && !common.quiet)
    std::fprintf(stderr, "%s is finished and of the same sources and options: kept (--force builds it again)\n",
                 options.output.c_str());
  print_build(summary, options.output, common, &combined);
}

}  // namespace

void add_build(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<BuildArguments>();
  CLI::App* command =
      add_command(program, "build", "Make a planet file from elevation and image rasters", common, true);
  paging::BuildOptions& o = arguments->options;
  command
      ->add_option(
          "DEM", arguments->dems,
          "Elevation rasters in any format of GDAL, or 'embedded'; at each place the finest one counts")
      ->required();
  command->add_option("--image", arguments->images, "Image rasters, or 'embedded'")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("-o,--output", o.output, "Planet file to write")->required();
  command
      ->add_option("--region", arguments->regions,
                   "WEST,SOUTH,EAST,NORTH: build full resolution only in this box, degrees (repeatable)")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      ->add_option("--spacing", o.finest_spacing_m,
                   "Finest post spacing, metres (default: that of the rasters)")
      ->check(number_within(0.01, 1e6));
  command
      ->add_option("--image-spacing", o.finest_image_m,
                   "Finest pixel spacing of imagery, metres (default: that of the images)")
      ->check(number_within(0.01, 1e6));
  command->add_option("--base-spacing", o.base_spacing_m, "Post spacing where nothing finer is built, metres")
      ->check(number_within(100.0, 1e6))
      ->capture_default_str();
  add_source_options(*command, arguments->sources);
  command
      ->add_option(
          "--detail", arguments->detail,
          "synthetic: add marked synthetic detail of Mars below the resolution of the rasters, down to --spacing; "
          "none: leave it out, also of 'embedded' (default: below 'embedded' alone)")
      ->check(CLI::IsMember({"synthetic", "none"}));
  command->add_option(
      "--part", arguments->part,
      "k/n: build only the k-th of n parts, OUTPUT.k-of-n.vpe, for 'vpe merge'; auto/n: take k from the "
      "variables of SLURM or MPI; auto: k and n");
  command->add_flag("--force", arguments->force,
                    "Replace a finished planet file of other sources or options; build a finished part again");
  command->add_flag("--estimate", arguments->estimate, "Only estimate the build: tiles, bytes, time");
  add_examples(
      *command,
      {{"elevation and imagery of the whole planet", "vpe build mola.tif --image viking.tif -o mars.vpe"},
       {"a finer inset; at each place the finest raster decides",
        "vpe build mola.tif ctx.tif --image viking.tif --image ortho.tif --align edges -o gale.vpe"},
       {"full resolution in a box only, first its size and time",
        "vpe build mola.tif --region -95,-20,-25,5 -o valles.vpe --estimate"}});
  command->callback([arguments, &common] { build(*arguments, common); });
}

}  // namespace vpe::app
