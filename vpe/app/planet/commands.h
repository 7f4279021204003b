// Commands that make, join and verify planet files.
#pragma once

namespace CLI {
class App;
}  // namespace CLI

namespace vpe::app {

struct Common;

// Each adds its command to the program (AddCommand of vpe/app/cli/program.h).
void add_build(CLI::App& program, Common& common);
void add_patch(CLI::App& program, Common& common);
void add_merge(CLI::App& program, Common& common);
void add_verify(CLI::App& program, Common& common);

}  // namespace vpe::app
