// What the benchmark of rays measures of ours, behind one function.
#pragma once

#include <memory>
#include <span>

#include "paging/planet/planet_file.h"
#include "vpe/core/view.h"

namespace bench {

class RangeCaster {
 public:
  // Throws what make_ray_renderer() does.
  RangeCaster(std::shared_ptr<const paging::PlanetFile> planet, int threads, std::size_t memory_bytes);
  ~RangeCaster();

  // Range of every pixel of the view, row by row, infinity for sky. As vpe::voxel::make_ray_renderer() does in
  // multires of that cell, or in exact (0).
  void cast_ranges(const vpe::core::View& view, double cell_px, std::span<float> range_m);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bench
