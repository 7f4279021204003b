// vpe report.
#include <CLI/CLI.hpp>

#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/report/commands.h"
#include "vpe/app/report/report_commands.h"

namespace vpe::app {

void add_report(CLI::App& program, Common& common) {
  CLI::App* report = program.add_subcommand(
      "report", "Measure errors, run times and how costs grow, and write pages with plots");
  report->require_subcommand(1);
  add_examples(*report, {{"a first look at errors and run times",
                          "vpe report error-time mars.vpe --short -o error-time"},
                         {"everything, briefly", "vpe report all mars.vpe --short -o report"}});
  add_report_error_time(*report, common);
  add_report_scaling(*report, common);
  add_report_features(*report, common);
  add_report_papers(*report, common);
  add_report_all(*report, common);
}

}  // namespace vpe::app
