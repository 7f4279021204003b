// The report of error against time as plots and a page.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "vpe/report/error_time_tables.h"
#include "vpe/report/page.h"

namespace vpe::report {

struct ErrorTimeReport {
  std::string title;
  std::vector<std::string> about;  // what was run, on what, when
  std::vector<SubjectResult> results;
};

// Medians over the views of all ways that are compared by shift and stand on the baseline's plot.
Plot summary_plot(const std::vector<SubjectResult>& results);

// The same figures: all points are in the page, the tables in both.
Page error_time_page(const ErrorTimeReport& report);
nlohmann::json error_time_json(const ErrorTimeReport& report);

}  // namespace vpe::report
