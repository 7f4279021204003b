// The command that draws one image.
#pragma once

namespace CLI {
class App;
}  // namespace CLI

namespace vpe::app {

struct Common;

// Adds the command `render` to the program (AddCommand of vpe/app/cli/program.h).
void add_render(CLI::App& program, Common& common);

}  // namespace vpe::app
