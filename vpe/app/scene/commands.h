// The commands that make models of objects.
#pragma once

namespace CLI {
class App;
}  // namespace CLI

namespace vpe::app {

struct Common;

// Add the commands `object` and `sculpt` to the program (AddCommand of vpe/app/cli/program.h).
void add_object(CLI::App& program, Common& common);
void add_sculpt(CLI::App& program, Common& common);

}  // namespace vpe::app
