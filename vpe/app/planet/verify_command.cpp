#include "vpe/app/planet/commands.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "paging/build/verify_shard.h"
#include "paging/planet/planet_database.h"
#include "paging/planet/verify.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/planet/remote_wait.h"

namespace vpe::app {

namespace {

constexpr std::size_t kShownProblems = 20;

struct VerifyArguments {
  std::string planet;
  bool deep = false;
  std::size_t sample = 200;
};

nlohmann::json to_json(const paging::VerifyReport& report, const std::string& path) {
  nlohmann::json problems = nlohmann::json::array();
  for (const paging::Problem& p : report.problems) problems.push_back({{"where", p.where}, {"what", p.what}});
  return {{"path", path},
          {"sound", report.problems.empty()},
          {"problems", problems},
          {"tiles", report.tiles},
          {"meshes", report.meshes},
          {"borders", report.borders},
          {"image_tiles", report.images},
          {"errors_measured_again", report.measured},
          {"largest_share_of_a_stated_error", report.largest_share}};
}

bool is_part_of_planet(const std::string& path) {
  return paging::is_planet_database(path) &&
         paging::read_meta_rows(paging::open_planet_database(path)).contains("part");
}

void verify(const VerifyArguments& arguments, const Common& common) {
  const InterruptGuard guard;
  require_local_planet(arguments.planet);
  const bool is_part = is_part_of_planet(arguments.planet);
  if (is_part && arguments.deep)
    throw UsageError(arguments.planet + ": --deep needs the whole planet; merge the parts first ('vpe merge')");
  const auto planet = is_part ? nullptr : paging::PlanetFile::open(arguments.planet);
  const std::string& path = arguments.planet;
  paging::VerifyOptions options;
  options.threads = common.threads;
  options.deep_tiles = arguments.deep ? arguments.sample : 0;
  paging::VerifyReport report;
  {
    ProgressLine line(common.quiet);
    const auto progress = [&](double fraction) {
      InterruptGuard::check();
      line.show("verifying", fraction);
    };
    report = is_part ? paging::verify_shard(path, progress) : paging::verify(*planet, options, progress);
  }
  if (common.json) {
    print_json(to_json(report, path));
  } else if (!common.quiet && report.problems.empty()) {
    std::printf("%s: %s: %lld tiles, %lld meshes, %lld borders, %lld image tiles", path.c_str(),
                is_part ? "sound as a part" : "sound", static_cast<long long>(report.tiles),
                static_cast<long long>(report.meshes), static_cast<long long>(report.borders),
                static_cast<long long>(report.images));
    if (arguments.deep) std::printf("; %lld errors measured again", static_cast<long long>(report.measured));
    std::printf("\n");
  }
  if (report.problems.empty()) return;
  std::string text = path + ": " + std::to_string(report.problems.size()) + " problems; build the " +
                     (is_part ? "part" : "planet file") + " again:";
  for (std::size_t n = 0; n < std::min(kShownProblems, report.problems.size()); ++n) {
    text += "\n     " + report.problems[n].where + ": " + report.problems[n].what;
  }
  if (report.problems.size() > kShownProblems) text += "\n     ... (--json lists all)";
  throw std::runtime_error(text);
}

}  // namespace

void add_verify(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<VerifyArguments>();
  CLI::App* command = add_command(
      program, "verify", "Check the whole content of a planet file, or of a part of one", common, true);
  command->add_option("PLANET", arguments->planet, "Planet file, or a part of 'vpe build --part'")->required();
  command->add_flag("--deep", arguments->deep,
                    "Also measure the errors of meshes again, on a sample of the finest tiles");
  command->add_option("--sample", arguments->sample, "Number of finest tiles in the sample of --deep")
      ->check(number_within(1, 1e9))
      ->capture_default_str();
  add_examples(*command,
               {{"all checksums, meshes and borders", "vpe verify mars.vpe"},
                {"also the stated errors, on 500 finest tiles", "vpe verify mars.vpe --deep --sample 500"}});
  command->callback([arguments, &common] { verify(*arguments, common); });
}

}  // namespace vpe::app
