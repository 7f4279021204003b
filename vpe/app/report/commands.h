// The command that measures error against run time.
#pragma once

namespace CLI {
class App;
}  // namespace CLI

namespace vpe::app {

struct Common;

// Each adds its command to the program (AddCommand of vpe/app/cli/program.h).
void add_report(CLI::App& program, Common& common);

}  // namespace vpe::app
