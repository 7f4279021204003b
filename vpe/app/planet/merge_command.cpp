#include "vpe/app/planet/commands.h"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "paging/build/merge.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/planet/planet_build.h"
#include "vpe/app/planet/remote_wait.h"

namespace vpe::app {

namespace {

struct MergeArguments {
  paging::MergeOptions options;
  bool force = false;
};

void merge(MergeArguments& arguments, const Common& common) {
  paging::MergeOptions& options = arguments.options;
  options.threads = common.threads;
  for (const std::string& shard : options.shards) require_local_planet(shard);
  options.output = check_planet_file(options.output, options.shards);
  if (!arguments.force && std::filesystem::exists(options.output))
    require_same_content(options.output, paging::planned_content(options.shards));
  print_build(run_merge(options, common), options.output, common);
}

}  // namespace

void add_merge(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<MergeArguments>();
  paging::MergeOptions& options = arguments->options;
  CLI::App* command = add_command(
      program, "merge", "Join the parts that 'vpe build --part' made into one planet file", common, true);
  command->add_option("PART", options.shards, "All parts of one build, in any order")->required();
  command->add_option("-o,--output", options.output, "Planet file to write")->required();
  command->add_flag("--force", arguments->force, "Replace a finished planet file of other sources or options");
  add_examples(*command,
               {{"the parts of a divided build", "vpe merge mars.1-of-2.vpe mars.2-of-2.vpe -o mars.vpe"},
                {"over a planet file of another build",
                 "vpe merge mars.1-of-2.vpe mars.2-of-2.vpe -o mars.vpe --force"}});
  command->callback([arguments, &common] { merge(*arguments, common); });
}

}  // namespace vpe::app
