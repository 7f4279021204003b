// vpe report all.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/report/report_commands.h"
#include "vpe/app/report/report_folder.h"
#include "vpe/base/file.h"

namespace vpe::app {

namespace {

// Appends a page as sections of another one.
void append(report::Page& all, report::Page part) {
  all.sections.push_back({part.title, std::move(part.paragraphs), {}, {}});
  for (report::Section& section : part.sections) {
    section.heading = part.title + ": " + section.heading;
    all.sections.push_back(std::move(section));
  }
}

void report_all(const ReportRequest& request, const Common& common) {
  check_report_folder(request.folder);
  report::Page page;
  page.title = "Error, growth and cost";
  page.paragraphs = to_paragraphs(read_run_facts(common));
  append(page, error_time_report(request, common));
  append(page, scaling_report(request, common));
  append(page, features_report(request, common));
  append(page, papers_report(request, common));
  base::write_file(request.folder / "report.html", report::to_html(page));
  if (!common.quiet) std::printf("%s\n", (request.folder / "report.html").c_str());
}

}  // namespace

void add_report_all(CLI::App& report, Common& common) {
  auto arguments = std::make_shared<ReportRequest>();
  CLI::App* command = add_command(
      report, "all",
      "Make the reports error-time, scaling, features and papers with their defaults, and one page of all",
      common, false);
  command->add_option("PLANET", arguments->planet, "Planet file or DEM (default: the embedded Mars)");
  command->add_option("-o,--output", arguments->folder, "Folder for report.html and the files of each report")
      ->required();
  command->add_flag("--short", arguments->is_short, "Make each report with its own --short");
  add_examples(*command, {{"everything, briefly", "vpe report all mars.vpe --short -o report"},
                          {"everything", "vpe report all mars.vpe -o report"}});
  command->callback([arguments, &common] { report_all(*arguments, common); });
}

}  // namespace vpe::app
