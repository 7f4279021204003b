#include "vpe/app/film/film_palette.h"

#include <algorithm>
#include <map>

#include "vpe/app/picture/view_palette.h"

namespace vpe::app {

std::vector<FilmPalette> film_palettes(const FilmPlan& plan, std::int64_t frames,
                                       const std::shared_ptr<const paging::PlanetFile>& planet,
                                       const Common& common, const ChangedPlanet& changed) {
  std::map<core::Colour, std::vector<std::int64_t>> shown;
  for (std::int64_t n = 0; n < frames; ++n) {
    const core::SettingsValues settings = plan.at(n).settings.values();
    if (needs_view_palette(settings, *planet)) shown[settings.colour].push_back(n);
  }
  std::vector<FilmPalette> palettes;
  for (const auto& entry : shown) {
    const std::vector<std::int64_t>& all = entry.second;
    const auto count = static_cast<std::int64_t>(all.size());
    const std::int64_t samples = std::min(count, kPaletteFrames);
    ViewPalette view(planet, common);
    for (std::int64_t k = 0; k < samples; ++k) {
      // The first and the last are among them.
      const std::int64_t n = samples > 1 ? k * (count - 1) / (samples - 1) : 0;
      const PlannedFrame planned = plan.at(all[static_cast<std::size_t>(n)]);
      if (changed) view.change_planet(changed(planned.ground));
      view.add(reduced(planned.request));
    }
    palettes.push_back({entry.first, view.ends()});
  }
  return palettes;
}

}  // namespace vpe::app
