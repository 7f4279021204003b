// The option -o of commands that write features: GeoJSON or GeoPackage.
//
// Typical usage:
//   add_feature_output(*command, arguments->output)->required();
//   check_feature_output(arguments.output, arguments.planet);   // before the work
//   mars::write_features(arguments.output, layer, info);
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace vpe::app {

// Adds -o and --output. `what` says what is written, before the names of the formats: "File to write". Returns the option,
// which is not required.
CLI::Option* add_feature_output(CLI::App& command, std::string& output,
                                const std::string& what = "File to write");

// Checks the name of a file of features before the work: its extension, and what check_outputs() checks. An empty name is
// no output. Throws UsageError and std::runtime_error.
void check_feature_output(const std::string& output, const std::string& planet);

}  // namespace vpe::app
