// vpe report all.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "vpe/app/cli/output.h"
#include "vpe/app/cli/temporary.h"
#include "vpe/app/report/report_commands.h"
#include "vpe/app/report/report_folder.h"

namespace vpe::app {

namespace {

// As a part of a page of several.
void append(report::Page& all, report::Page part) {
  all.sections.push_back({part.title, std::move(part.paragraphs), {}, {}});
  for (report::Section& section : part.sections) {
    section.heading = part.title + ": " + section.heading;
    all.sections.push_back(std::move(section));
  }
}

void report_all(const ReportRequest& order, const Common& common) {
  check_report_folder(order.folder);
  report::Page page;
  page.title = "Error, growth and cost";
  page.paragraphs = to_paragraphs(read_run_facts(common));
  append(page, error_time_report(order, common));
  append(page, scaling_report(order, common));
  append(page, features_report(order, common));
  write_whole(order.folder / "report.html", report::to_html(page));
  if (!common.quiet) std::printf("%s\n", (order.folder / "report.html").c_str());
}

}  // namespace

void add_report_all(CLI::App& report, Common& common) {
  auto arguments = std::make_shared<ReportRequest>();
  CLI::App* command =
      add_command(report, "all", "error-time, scaling and features with their defaults, and one page of all",
                  common, false);
  command->add_option("PLANET", arguments->planet, "Planet file or DEM; the embedded Mars when left out");
  command->add_option("-o,--output", arguments->folder, "Folder for report.html and the files of each report")
      ->required();
  command->add_flag("--short", arguments->is_short, "Each as its own --short has it");
  command->callback([arguments, &common] { report_all(*arguments, common); });
}

}  // namespace vpe::app
