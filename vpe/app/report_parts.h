// The reports of `vpe report`: each adds itself as add_command() makes commands, and its callback does the
// work.
#pragma once

#include "vpe/app/program.h"

namespace vpe::app {

void add_report_error_time(CLI::App& report, Common& common);
void add_report_scaling(CLI::App& report, Common& common);
void add_report_features(CLI::App& report, Common& common);

}  // namespace vpe::app
