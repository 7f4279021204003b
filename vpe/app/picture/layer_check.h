// Checks the setting image.layers against a planet before it is drawn.
#pragma once

#include <string>

#include "paging/planet/planet_file.h"
#include "scripts/flight.h"
#include "vpe/core/appearance/settings.h"

namespace vpe::app {

// Throw UsageError, which names the planet's layers, if settings, or a line `set` of a flight, name image layers that the
// planet does not have.
void require_layers(const core::SettingsValues& settings, const paging::PlanetFile& planet);
void require_layers(const scripts::Flight& flight, const paging::PlanetFile& planet);

// Removes image layers that the planet does not have from settings which were made for another planet. Returns what a user is
// told, "" if there is nothing to remove.
std::string leave_out_layers(core::SettingsValues& settings, const paging::PlanetFile& planet);

}  // namespace vpe::app
