// Commands about lines of equal height.
#pragma once

namespace CLI {
class App;
}  // namespace CLI

namespace vpe::app {

struct Common;

// Adds its command to the program (AddCommand of vpe/app/cli/program.h).
void add_contour(CLI::App& program, Common& common);

}  // namespace vpe::app
