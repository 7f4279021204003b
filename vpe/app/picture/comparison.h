// Images that show how the ground differs from that of an earlier planet: --compare EARLIER.
//
// Typical usage:
//   add_compare_option(*command, arguments->earlier);  // once, with the command's declaration
//   show_differences(arguments.earlier, image);        // before make_settings()
//   const auto planet = with_earlier(open_planet(name, common), arguments.earlier, common);
//   require_earlier(settings, *planet);
#pragma once

#include <memory>
#include <string>

#include "paging/planet/planet_file.h"
#include "vpe/app/picture/image_options.h"

namespace vpe::app {

// Adds --compare to a command.
void add_compare_option(CLI::App& command, std::string& earlier);

// Makes differences, with their legend, what images show where no --set says otherwise. Does nothing without an earlier
// planet.
void show_differences(const std::string& earlier, RenderOptions& options);

// Returns the planet compared with the earlier one, which is opened as open_planet() does; without a name, the planet.
// Throws what open_planet() throws, and PlanetError for planets that cannot be compared.
std::shared_ptr<const paging::PlanetFile> with_earlier(std::shared_ptr<const paging::PlanetFile> planet,
                                                       const std::string& earlier, const Common& common);

// Throws UsageError if the settings show differences of a planet that is compared with none.
void require_earlier(const core::SettingsValues& settings, const paging::PlanetFile& planet);

}  // namespace vpe::app
