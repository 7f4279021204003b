#include "vpe/app/picture/layer_check.h"

#include "paging/planet/planet_look.h"
#include "vpe/app/cli/program.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

constexpr const char* kLayersKey = "image.layers";

void require_text(const std::string& where, const std::string& text, const paging::PlanetFile& planet) {
  const std::string problem = paging::layers_problem(text, planet.meta());
  if (!problem.empty())
    throw UsageError(where + kLayersKey + "='" + text + "': " + planet.path() + ": " + problem);
}

}  // namespace

void require_layers(const core::SettingsValues& settings, const paging::PlanetFile& planet) {
  require_text("", settings.image_layers, planet);
}

void require_layers(const scripts::Flight& flight, const paging::PlanetFile& planet) {
  for (const scripts::SetCommand& set : flight.sets) {
    if (set.key == kLayersKey)
      require_text("the flight at " + base::format_number(set.time_s) + " s: ", set.text, planet);
  }
}

std::string leave_out_layers(core::SettingsValues& settings, const paging::PlanetFile& planet) {
  const std::string problem = paging::layers_problem(settings.image_layers, planet.meta());
  if (problem.empty()) return {};
  settings.image_layers.clear();
  return planet.path() + ": " + problem;
}

}  // namespace vpe::app
