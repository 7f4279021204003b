#include "vpe/voxel/cast/height_grid_store.h"

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
      budget_(budget_bytes),
      lattices_(part(budget_bytes, 1.0 - kExactShare)),
      exact_(part(budget_bytes, kExactShare)) {}

template <typename T>
std::shared_ptr<const TileLattices<T>> LatticeStore::get(Cache<T>& cache, const Key& key) const {
  return cache.get(key, [&] {
    auto made = std::make_shared<const TileLattices<T>>(
        planet_->heights(planet_->tree()[key.tile].key, key.exaggeration),
        planet_->radius_m(), key.exaggeration, key.family);
    const std::size_t bytes = made->bytes();
    ++tiles_made_;
    bytes_made_ += bytes;
    return std::pair(std::move(made), bytes);
  });
}

std::shared_ptr<const TileLattices<float>> LatticeStore::lattices(lod::TileTree::Index tile, Family family,
                                                                  double exaggeration) const {
  return get(lattices_, {tile, family, exaggeration});
}

std::shared_ptr<const TileLattices<double>> LatticeStore::exact_lattices(lod::TileTree::Index tile,
                                                                         Family family,
                                                                         double exaggeration) const {
  return get(exact_, {tile, family, exaggeration});
}

std::size_t LatticeStore::bytes_resident() const { return lattices_.bytes() + exact_.bytes(); }

std::shared_ptr<const TileLattices<float>> LatticeStore::any_lattices(lod::TileTree::Index tile,
                                                                      double exaggeration,
                                                                      Family& family) const {
  for (const Family f : {Family::kColumns, Family::kRows, Family::kDiagonals}) {
    family = f;
    if (auto found = lattices_.find({tile, f, exaggeration})) return found;
  }
  family = Family::kColumns;
  return lattices(tile, family, exaggeration);
}

const TileLattices<float>& LatticeShelf::lattices(lod::TileTree::Index tile, Family family) {
  Slot<float>& slot = slots_[number(tile, family) % slots_.size()];
  if (!slot.is(tile, family)) slot = {tile, family, store_.lattices(tile, family, exaggeration_)};
  return *slot.held;
}

const TileLattices<double>& LatticeShelf::exact_lattices(lod::TileTree::Index tile, Family family) {
  Slot<double>& slot = exact_[number(tile, family) % exact_.size()];
  if (!slot.is(tile, family)) slot = {tile, family, store_.exact_lattices(tile, family, exaggeration_)};
  return *slot.held;
}

const TileLattices<float>& LatticeShelf::any_lattices(lod::TileTree::Index tile, Family& family) {
  for (const Family f : {Family::kColumns, Family::kRows, Family::kDiagonals}) {
    family = f;
    const Slot<float>& slot = slots_[number(tile, f) % slots_.size()];
    if (slot.is(tile, f)) return *slot.held;
  }
  auto found = store_.any_lattices(tile, exaggeration_, family);
  Slot<float>& slot = slots_[number(tile, family) % slots_.size()];
  slot = {tile, family, std::move(found)};
  return *slot.held;
}

}  // namespace vpe::voxel
