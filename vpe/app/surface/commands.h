// The command that draws bodies and planes of surface files.
#pragma once

namespace CLI {
class App;
}  // namespace CLI

namespace vpe::app {

struct Common;

// Adds the command `surface` to the program (AddCommand of vpe/app/cli/program.h).
void add_surface(CLI::App& program, Common& common);

}  // namespace vpe::app
