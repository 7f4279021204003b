// Commands about ways over the ground.
#pragma once

namespace CLI {
class App;
}  // namespace CLI

namespace vpe::app {

struct Common;

// Adds its command to the program (AddCommand of vpe/app/cli/program.h).
void add_route(CLI::App& program, Common& common);

}  // namespace vpe::app
