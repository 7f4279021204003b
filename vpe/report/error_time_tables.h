// The measurements of error against time as tables.
#pragma once

#include <vector>

#include "vpe/report/error_time_summary.h"
#include "vpe/report/table.h"

namespace vpe::report {

// Returns a row for each configuration and view, with all figures.
Table points_table(const std::vector<SubjectResult>& results);
// Returns a row for each configuration of one view, with the main figures.
Table view_table(const SubjectResult& result);
// Returns a row for each sweep and view.
Table sweeps_table(const std::vector<SubjectResult>& results);
// Returns a row for each default and view.
Table defaults_table(const std::vector<SubjectResult>& results);

}  // namespace vpe::report
