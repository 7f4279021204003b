// All commands of the program.
#pragma once

namespace CLI {
class App;
}  // namespace CLI

namespace vpe::app {

struct Common;

// Each adds its command to the program (AddCommand of vpe/app/cli/program.h).
void add_query(CLI::App& program, Common& common);
void add_profile(CLI::App& program, Common& common);
void add_find(CLI::App& program, Common& common);
void add_compare(CLI::App& program, Common& common);
void add_traverse(CLI::App& program, Common& common);
void add_explore(CLI::App& program, Common& common);
void add_settings(CLI::App& program, Common& common);
void add_doctor(CLI::App& program, Common& common);

// Runs one command line and returns the exit code. Prints messages on stderr and results on stdout.
int run(int argc, char** argv);

}  // namespace vpe::app
