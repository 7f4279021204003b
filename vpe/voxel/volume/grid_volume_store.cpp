#include "vpe/voxel/volume/grid_volume_store.h"

#include <utility>

namespace vpe::voxel {

GridVolumeStore::Pointer GridVolumeStore::get(const Grids& grids, int i, int j, mars::Face face,
                                              const HeightGridFrame& frame, double radius_m,
                                              const BandSpec& spec) const {
  const int per_side = grids->per_side();
  const Key key{grids.get(), j * per_side + i, spec};
  auto kept = cache_.get_once(key, [&] {
    auto made = std::make_shared<const Kept>(
        Kept{make_grid_volume(face, frame, grids->lines(i, j), grids->family(), radius_m, spec), grids});
    // Each grid of a tile holds all of them.
    const std::size_t bytes =
        made->volume.bytes() + grids->bytes() / static_cast<std::size_t>(per_side * per_side);
    return std::pair(std::move(made), bytes);
  });
  const GridVolume* volume = &kept->volume;
  return {std::move(kept), volume};
}

}  // namespace vpe::voxel
