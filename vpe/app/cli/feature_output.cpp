#include "vpe/app/cli/feature_output.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "vpe/app/cli/output.h"
#include "vpe/app/cli/program.h"

namespace vpe::app {

CLI::Option* add_feature_output(CLI::App& command, std::string& output, const std::string& what) {
  return command.add_option("-o,--output", output, what + ": .geojson, .json or .gpkg");
}

void check_feature_output(const std::string& output, const std::string& planet) {
  if (output.empty()) return;
  std::string end = std::filesystem::path(output).extension().string();
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (end != ".geojson" && end != ".json" && end != ".gpkg")
    throw UsageError("-o " + output + ": name the file .geojson, .json or .gpkg");
  check_outputs({{"-o", output, FileKind::kFeatures}}, {planet});
}

}  // namespace vpe::app
