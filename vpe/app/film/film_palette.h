// Palettes by the view in a film: one range for the whole flight, so that a place keeps its colour.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "paging/planet/planet_file.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/film/film_plan.h"

namespace vpe::app {

// The frames that the ends of a film's palette are taken from, evenly spaced among those that show it. More:
// short views count as well, slower.
inline constexpr std::int64_t kPaletteFrames = 24;

// Returns the planet with changed ground.
using ChangedPlanet =
    std::function<std::shared_ptr<const paging::PlanetFile>(const scripts::GroundState& ground)>;

// Returns the ends of every palette that frames of the plan take from the view: for each value shown
// (elevation, slope, aspect), from all that kPaletteFrames of its frames show. They follow from the flight
// alone, so parts and continued films have the same. `changed` may be empty if the ground never changes. Throws what renderers throw.
std::vector<FilmPalette> film_palettes(const FilmPlan& plan, std::int64_t frames,
                                       const std::shared_ptr<const paging::PlanetFile>& planet,
                                       const Common& common, const ChangedPlanet& changed = {});

}  // namespace vpe::app
