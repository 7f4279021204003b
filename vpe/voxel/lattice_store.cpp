#include "vpe/voxel/lattice_store.h"

namespace vpe::voxel {

namespace {

// Few tiles are about the eye's foot.
constexpr double kExactShare = 0.05;

std::size_t part(std::size_t bytes, double share) {
  return static_cast<std::size_t>(share * static_cast<double>(bytes));
}

}  // namespace

LatticeStore::LatticeStore(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes)
    : planet_(std::move(planet)),
      lattices_(part(budget_bytes, 1.0 - kExactShare)),
      exact_(part(budget_bytes, kExactShare)) {}

template <typename T>
std::shared_ptr<const TileLattices<T>> LatticeStore::get(Cache<T>& cache, const Key& key) const {
  return cache.get(key, [&] {
    auto made = std::make_shared<const TileLattices<T>>(planet_->heights(planet_->tree()[key.tile].key),
                                                        planet_->radius_m(), key.exaggeration, key.family);
    const std::size_t bytes = made->bytes();
    return std::pair(std::move(made), bytes);
  });
}

std::shared_ptr<const TileLattices<float>> LatticeStore::lattices(lod::TileTree::Index tile, Family family,
                                                                  double exaggeration) const {
  return get(lattices_, {tile, family, exaggeration});
}

std::shared_ptr<const TileLattices<double>> LatticeStore::exact_lattices(lod::TileTree::Index tile, Family family,
                                                                         double exaggeration) const {
  return get(exact_, {tile, family, exaggeration});
}

std::size_t LatticeStore::bytes_resident() const { return lattices_.bytes() + exact_.bytes(); }

const TileLattices<float>& LatticeShelf::lattices(lod::TileTree::Index tile, Family family) {
  Slot& slot = slots_[(std::size_t{tile} * kFamilies + static_cast<std::size_t>(family)) % kSlots];
  if (!slot.held || slot.tile != tile || slot.family != family) {
    slot.held = store_.lattices(tile, family, exaggeration_);
    slot.tile = tile;
    slot.family = family;
  }
  return *slot.held;
}

const TileLattices<double>& LatticeShelf::exact_lattices(lod::TileTree::Index tile, Family family) {
  if (!exact_ || exact_tile_ != tile || exact_family_ != family) {
    exact_ = store_.exact_lattices(tile, family, exaggeration_);
    exact_tile_ = tile;
    exact_family_ = family;
  }
  return *exact_;
}

}  // namespace vpe::voxel
