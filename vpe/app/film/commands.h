// The command that draws a scripted flight.
#pragma once

namespace CLI {
class App;
}  // namespace CLI

namespace vpe::app {

struct Common;

// Adds the command `fly` to the program (AddCommand of vpe/app/cli/program.h).
void add_fly(CLI::App& program, Common& common);

}  // namespace vpe::app
