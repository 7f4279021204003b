#include "tests/bench/ray_bench_caster.h"

#include "vpe/voxel/cast/range_caster.h"

namespace bench {

struct RangeCaster::State {
  vpe::voxel::RangeCaster caster;
  vpe::base::ThreadPool pool;
};

RangeCaster::RangeCaster(std::shared_ptr<const paging::PlanetFile> planet, int threads,
                         std::size_t memory_bytes)
    : state_(new State{{std::move(planet), memory_bytes}, vpe::base::ThreadPool(threads)}) {}

RangeCaster::~RangeCaster() = default;

void RangeCaster::cast_ranges(const vpe::core::View& view, double cell_px, std::span<float> range_m) {
  vpe::voxel::RangeOptions options;
  options.cell_px = cell_px;
  state_->caster.cast(view, options, state_->pool, range_m);
}

}  // namespace bench
