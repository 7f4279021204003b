// The commands that make panoramas, view them, and compute skylines.
#pragma once

namespace CLI {
class App;
}  // namespace CLI

namespace vpe::app {

struct Common;

// Add one command each to the program (AddCommand of vpe/app/cli/program.h).
void add_panorama(CLI::App& program, Common& common);
void add_overlook(CLI::App& program, Common& common);
void add_horizon(CLI::App& program, Common& common);

}  // namespace vpe::app
