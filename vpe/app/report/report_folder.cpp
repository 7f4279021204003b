#include "vpe/app/report/report_folder.h"

#include <nlohmann/json.hpp>

#include "vpe/app/cli/output.h"
#include "vpe/base/file.h"
#include "vpe/core/json_text.h"

namespace vpe::app {

report::RunFacts read_run_facts(const Common& common) {
  return report::read_run_facts(std::string("vpe ") + version(), common.words);
}

void check_report_folder(const std::filesystem::path& folder) {
  make_folder(folder);
  check_output(folder / "report.json");
}

void write_report(const std::filesystem::path& folder, const std::string& name, const report::Page& page,
                  const nlohmann::json& json, const std::vector<report::Table>& tables) {
  for (const report::Table& table : tables)
    base::write_file(folder / (table.name + ".csv"), report::to_csv(table));
  base::write_file(folder / (name + ".json"), core::json_text(json, 1) + "\n");
  base::write_file(folder / (name + ".html"), report::to_html(page));
}

}  // namespace vpe::app
