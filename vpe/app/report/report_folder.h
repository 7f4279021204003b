// The folder that a report is written to, and what every report says of its run.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "vpe/app/cli/program.h"
#include "vpe/report/page.h"
#include "vpe/report/table.h"

namespace vpe::app {

// What ran, on what, when. Read when the work begins.
struct RunFacts {
  std::string program;  // version
  std::string command;  // as it can be given again
  std::string begun;    // UTC, as "2026-11-22T18:30:00Z"
  std::string processor;
  int threads = 0;       // that the machine runs at once
  double memory_gb = 0;  // of the machine
  std::string system;
  std::string opengl;  // empty: none was asked for
  double load = 0;     // mean number of running programs over the minute before
};

RunFacts read_run_facts(const Common& common);
nlohmann::json to_json(const RunFacts& facts);
// For a page, a paragraph each.
std::vector<std::string> to_paragraphs(const RunFacts& facts);

// Mean number of running programs over the last minute; 0 where the system does not say.
double load_now();

// Makes the folder where it is missing, and says now what could not be written later. Throws
// std::runtime_error with the path.
void check_report_folder(const std::filesystem::path& folder);

// Writes NAME.html, NAME.json and a CSV file for each table, each whole or not at all. Throws base::FileError.
void write_report(const std::filesystem::path& folder, const std::string& name, const report::Page& page,
                  const nlohmann::json& json, const std::vector<report::Table>& tables);

}  // namespace vpe::app
