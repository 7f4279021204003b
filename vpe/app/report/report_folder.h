// The folder that a report is written to.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "vpe/app/cli/program.h"
#include "vpe/report/page.h"
#include "vpe/report/run_facts.h"
#include "vpe/report/table.h"

namespace vpe::app {

// Returns the facts of this run. Call it when the work begins.
report::RunFacts read_run_facts(const Common& common);

// Makes the folder unless it exists, and checks that it can be written to. Throws std::runtime_error with the
// path.
void check_report_folder(const std::filesystem::path& folder);

// Writes NAME.html, NAME.json and a CSV file for each table, each complete or not at all. Throws
// base::FileError.
void write_report(const std::filesystem::path& folder, const std::string& name, const report::Page& page,
                  const nlohmann::json& json, const std::vector<report::Table>& tables);

}  // namespace vpe::app
