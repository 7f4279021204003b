#include "vpe/app/planet/commands.h"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "paging/build/merge.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/planet/planet_build.h"

namespace vpe::app {

namespace {

void merge(paging::MergeOptions& options, const Common& common) {
  options.threads = common.threads;
  options.output = check_planet_file(options.output, options.shards);
  print_build(run_merge(options, common), options.output, common);
}

}  // namespace

void add_merge(CLI::App& program, Common& common) {
  auto options = std::make_shared<paging::MergeOptions>();
  CLI::App* command = add_command(
      program, "merge", "Join the parts that 'vpe build --part' made into one planet file", common, true);
  command->add_option("PART", options->shards, "All parts of one build, in any order")->required();
  command->add_option("-o,--output", options->output, "Planet file to write")->required();
  command->callback([options, &common] { merge(*options, common); });
}

}  // namespace vpe::app
