// Interface of what can go over to a patched version of its planet.
#pragma once

#include <memory>

#include "paging/planet/planet_file.h"

namespace vpe::core {
class Renderer;
}

namespace paging {

// Is implemented by what keeps pages of a planet: renderers of both backends.
class PlanetUser {
 public:
  virtual ~PlanetUser() = default;

  // Goes over to a version of the planet: a patched one (PlanetFile::with()), or the one before. Keeps all pages whose
  // content is the same in both; what it answers from then on is, to the bit, what a new object would answer. Waits
  // for loads that have begun. One caller at a time, as for other members that are not const. Throws
  // std::invalid_argument for a planet of another radius or tile shape.
  virtual void change_planet(std::shared_ptr<const PlanetFile> planet) = 0;
};

// Lets a renderer go over to another version of its planet. Throws std::invalid_argument as PlanetUser::change_planet()
// does, and if the renderer is no PlanetUser. Typical usage:
//   const auto renderer = voxel::make_ray_renderer(planet);
//   change_planet(*renderer, planet->with(patch));
void change_planet(vpe::core::Renderer& renderer, std::shared_ptr<const PlanetFile> planet);

// Throws PlanetError, which names both files and what differs, if heights of the planets cannot be subtracted: another body,
// radius, shape or datum.
void require_comparable(const PlanetFile& earlier, const PlanetFile& later);

// Throws std::invalid_argument if a user of `from` cannot go over to `to`.
void require_same_grid(const PlanetFile& from, const PlanetFile& to);

}  // namespace paging
