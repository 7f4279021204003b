#include "vpe/app/picture/comparison.h"

#include <CLI/CLI.hpp>

#include "vpe/app/planet/planet_argument.h"

namespace vpe::app {

void add_compare_option(CLI::App& command, std::string& earlier) {
  command.add_option(
      "--compare", earlier,
      "Planet file or DEM: colours show how far the ground of PLANET lies above its ground (sets "
      "mode=coloured colour=difference palette.low=auto palette.high=auto overlay.legend=on)");
}

void show_differences(const std::string& earlier, RenderOptions& options) {
  if (earlier.empty()) return;
  options.set.insert(options.set.begin(), {"mode=coloured", "colour=difference", "palette.low=auto",
                                           "palette.high=auto", "overlay.legend=on"});
}

std::shared_ptr<const paging::PlanetFile> with_earlier(std::shared_ptr<const paging::PlanetFile> planet,
                                                       const std::string& earlier, const Common& common) {
  return earlier.empty() ? planet : planet->compared_with(open_planet(earlier, common));
}

void require_earlier(const core::SettingsValues& settings, const paging::PlanetFile& planet) {
  if (settings.colour == core::Colour::kDifference && !planet.earlier())
    throw UsageError("colour=difference needs --compare EARLIER, of 'vpe render' or 'vpe explore'");
}

}  // namespace vpe::app
