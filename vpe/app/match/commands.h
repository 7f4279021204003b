// The command that finds how a photograph was taken.
#pragma once

namespace CLI {
class App;
}  // namespace CLI

namespace vpe::app {

struct Common;

// Adds its command to the program (AddCommand of vpe/app/cli/program.h).
void add_match(CLI::App& program, Common& common);

}  // namespace vpe::app
