#include "tests/bench/ray_bench_caster.h"

#include <algorithm>

#include "vpe/voxel/ray_renderer.h"

namespace bench {

struct RangeCaster::State {
  std::unique_ptr<vpe::core::Renderer> renderer;
};

RangeCaster::RangeCaster(std::shared_ptr<const paging::PlanetFile> planet, int threads,
                         std::size_t memory_bytes)
    : state_(new State{vpe::voxel::make_ray_renderer(std::move(planet), {memory_bytes, threads})}) {}

RangeCaster::~RangeCaster() = default;

void RangeCaster::cast_ranges(const vpe::core::View& view, std::span<float> range_m) {
  vpe::core::DrawRequest request;
  request.view = view;
  request.want_range = true;
  request.settings.mode = vpe::core::Mode::kUnlit;
  request.settings.colour = vpe::core::Colour::kNone;
  request.settings.background = vpe::core::Background::kWhite;
  request.settings.smooth_edges = false;
  const vpe::core::DrawResult drawn = state_->renderer->draw(request);
  std::copy(drawn.frame.range_m.begin(), drawn.frame.range_m.end(), range_m.begin());
}

}  // namespace bench
