// The reports of `vpe report`: each adds itself as add_command() makes commands, and its callback does the
// work.
#pragma once

#include <filesystem>
#include <string>

#include "vpe/app/cli/program.h"
#include "vpe/report/page.h"

namespace vpe::app {

void add_report_error_time(CLI::App& report, Common& common);
void add_report_scaling(CLI::App& report, Common& common);
void add_report_features(CLI::App& report, Common& common);

struct ReportRequest {
  std::filesystem::path folder;
  std::string planet;     // file or DEM; empty: the embedded Mars
  bool is_short = false;  // as --short has it
};
// Each with its defaults but for that; scaling builds planets of its own. Return what they wrote as a page.
report::Page error_time_report(const ReportRequest& order, const Common& common);
report::Page scaling_report(const ReportRequest& order, const Common& common);
report::Page features_report(const ReportRequest& order, const Common& common);

// All of them into one folder, and one page of all.
void add_report_all(CLI::App& report, Common& common);

}  // namespace vpe::app
