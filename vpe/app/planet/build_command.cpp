#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/planet/build_request.h"
#include "vpe/app/planet/build_sources.h"
#include "vpe/app/planet/commands.h"
#include "vpe/app/planet/planet_build.h"
#include "vpe/app/planet/shard_option.h"

namespace vpe::app {

namespace {

struct BuildArguments {
  BuildRequest request;
  std::string part;
  bool estimate = false;
  bool force = false;
  paging::BuildOptions options;
};

void build(BuildArguments& arguments, const Common& common) {
  paging::BuildOptions& options = arguments.options;
  options.threads = common.threads;
  options.shard = parse_shard(arguments.part);
  require_count_of_parts(arguments.part, options.output, options.shard);
  options.output = shard_file_name(options.output, options.shard);
  options.output = check_planet_file(options.output, files_of(arguments.request));
  limit_rasters(common);
  const RequestedSources sources = open_sources(arguments.request, options);
  const mars::Combined& combined = sources.combined;
  if (!common.quiet) print_findings(combined);
  print_image_notes(sources, common);
  const std::shared_ptr<const mars::ImageSource>& image = sources.image;

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
  add_build_request(*command, arguments->request);
  command->get_option("DEM")->required();
  command->add_option("-o,--output", o.output, "Planet file to write")->required();
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
       {"images that can be switched and mixed while looking, of colours that fit at their boundaries",
        "vpe build mola.tif --image viking.tif --image ctx.tif --images-apart --match-colour -o layers.vpe"},
       {"a scanned picture with control points, by an affine map",
        "vpe build mola.tif --image scan.tif --gcp-method polynomial1 -o scan.vpe"},
       {"a satellite image with RPC, over the ground of a DEM",
        "vpe build ctx.tif --image scene.tif --rpc-dem ctx.tif -o scene.vpe"},
       {"full resolution in a box only, first its size and time",
        "vpe build mola.tif --region -95,-20,-25,5 -o valles.vpe --estimate"}});
  command->callback([arguments, &common] { build(*arguments, common); });
}

}  // namespace vpe::app
