// The measurements of error against time as tables.
#pragma once

#include <vector>

#include "vpe/report/error_time_summary.h"
#include "vpe/report/table.h"

namespace vpe::report {

Table points_table(const std::vector<SubjectResult>& results);    // a row a way and view, all that was measured
Table view_table(const SubjectResult& result);                    // a row a way, what people look for
Table sweeps_table(const std::vector<SubjectResult>& results);    // a row a sweep and view
Table defaults_table(const std::vector<SubjectResult>& results);  // a row a default and view

}  // namespace vpe::report
