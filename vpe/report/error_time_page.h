// The report of error against time as plots, a page and JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "vpe/report/error_time_tables.h"
#include "vpe/report/page.h"

namespace vpe::report {

struct ErrorTimeReport {
  std::string title;
  std::vector<std::string> about;  // what was run, on which machine, when
  std::vector<SubjectResult> results;
};

// Returns the medians over the views of all configurations that are compared by shift and stand on the
// baseline's plot.
Plot summary_plot(const std::vector<SubjectResult>& results);

// Return the report as a page with all points, and as JSON with the same tables.
Page error_time_page(const ErrorTimeReport& report);
nlohmann::json error_time_json(const ErrorTimeReport& report);

}  // namespace vpe::report
