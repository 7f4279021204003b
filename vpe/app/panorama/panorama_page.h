// --html of `vpe panorama` and `vpe overlook`: the web page of a panorama.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "panorama/page/page_marks.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/panorama/open_stereo.h"

namespace CLI {
class App;
}  // namespace CLI

namespace vpe::app {

// Holds the options as they are written.
struct PageArguments {
  std::string folder;  // of --html; empty: no page is wanted
  std::string title;
  std::string hotspots;
  std::string tiles = "jpeg";
  int quality = 90;
  int layer_step = 0;
  bool without_image = false;
  bool force = false;
};

void add_page_options(CLI::App& command, PageArguments& arguments);

// Checks, before any work, that the page can be written, and that its options are there with --html only.
// Throws UsageError and base::FileError.
void check_page(const PageArguments& arguments);

// Writes the page of finished panorama files, with names and hotspots of their JSON, these names, and the
// hotspots of the file. Returns the report for --json. Throws base::FileError, Interrupted.
nlohmann::json write_page_of(const PageArguments& arguments, const PanoramaFiles& files,
                             std::vector<panorama::PageName> names, const Common& common);

}  // namespace vpe::app
