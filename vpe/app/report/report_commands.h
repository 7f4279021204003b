// The reports of `vpe report`.
#pragma once

#include <filesystem>
#include <string>

#include "vpe/app/cli/program.h"
#include "vpe/report/page.h"

namespace vpe::app {

// Add one report each as a command below `vpe report`.
void add_report_error_time(CLI::App& report, Common& common);
void add_report_scaling(CLI::App& report, Common& common);
void add_report_features(CLI::App& report, Common& common);
void add_report_papers(CLI::App& report, Common& common);

struct ReportRequest {
  std::filesystem::path folder;
  std::string planet;     // file or DEM; empty: the embedded Mars
  bool is_short = false;  // --short of each report
};

// Make one report each with its other options at their defaults, write its files, and return it as a page.
// Scaling builds planets of its own.
report::Page error_time_report(const ReportRequest& request, const Common& common);
report::Page scaling_report(const ReportRequest& request, const Common& common);
report::Page features_report(const ReportRequest& request, const Common& common);
report::Page papers_report(const ReportRequest& request, const Common& common);

// Adds the command that makes all reports in one folder, and one page of all.
void add_report_all(CLI::App& report, Common& common);

}  // namespace vpe::app
