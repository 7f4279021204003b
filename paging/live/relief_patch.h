// Planets with reliefs by formulas that are not in their files.
//
// Typical usage:
//   const ReliefPatcher patcher(planet);
//   for (...) change_planet(*renderer, patcher.with(reliefs_at(time), {.full_grids = true}));
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "paging/live/patch_maker.h"
#include "relief/relief.h"

namespace paging {

// Returns the change that reliefs make. `name` is the name of the source that posts of reliefs have.
std::shared_ptr<const GroundChange> relief_change(relief::Relief relief, const std::string& name = "reliefs");

// Lays reliefs over one planet, one state after the other. Any number of threads may use it.
class ReliefPatcher {
 public:
  explicit ReliefPatcher(std::shared_ptr<const PlanetFile> base,
                         std::size_t budget_bytes = std::size_t{256} << 20)
      : maker_(std::move(base), budget_bytes) {}

  const std::shared_ptr<const PlanetFile>& base() const { return maker_.planet(); }

  // Returns the planet with the reliefs, in their order; the planet itself if nothing changes. Zeros that count from the
  // ground count from the planet's own surface, as relief::place() says. Throws std::runtime_error with the name of a
  // relief that has a problem, and what PatchMaker::make() throws. `made`, if given, is told what was made. Follows the
  // planet that was made last, if that is in use: tiles with the same content keep their numbers (PlanetFile::with()).
  std::shared_ptr<const PlanetFile> with(std::span<const relief::ReliefSpec> reliefs,
                                         const PatchOptions& options = {}, MadePatch* made = nullptr) const;

 private:
  struct Last {
    std::mutex mutex;
    std::weak_ptr<const PlanetFile> planet;
  };
  PatchMaker maker_;
  std::unique_ptr<Last> last_ = std::make_unique<Last>();
};

// Does the same once.
std::shared_ptr<const PlanetFile> with_reliefs(std::shared_ptr<const PlanetFile> base,
                                               std::span<const relief::ReliefSpec> reliefs,
                                               const PatchOptions& options = {});

}  // namespace paging
