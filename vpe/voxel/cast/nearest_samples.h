// Gives each ray of a perspective image the range of the sample nearest to it.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): after the columns of a sector's batch, where rays are not cast
// themselves: SectorCaster with SectorForm::is_nearest, and the discrete caster.
#pragma once

#include <vector>

#include "vpe/voxel/cast/sector_batch.h"
#include "vpe/voxel/columns/view_sector.h"

namespace vpe::voxel {

// Reads samples of sector_batch(), all of those beside the rays that are asked for. Any thread may call get().
class NearestSamples {
 public:
  // `part` is the drawn part of the image, and `plan` that of the view whose pixels are 1 / rays as wide and as tall: each row of
  // pixels has `rays` rows of rays; with several, plan must have one ring a side. `plan` and `samples` must outlive this.
  NearestSamples(const SectorPlan& plan, const SectorSamples& samples, const core::SubRectangle& part,
                 int rays = 1);

  // Sets the ranges of pixels [begin, end) of a row, all counted from the corner of the drawn part; out[x] is that of pixel x, and
  // each of the pixels' further rows of rays begins a row of the drawn part behind the one before. A ray has the sample nearest to it
  // along its row of rays or, beside V, along its column; so at most half of the sectors' spacing away. Pixels that have no such
  // sample, within 0.015 pixels of V, are appended to `missed` and keep what is there, or have any other sample without `missed`.
  void get(int pixel_row, int begin, int end, float* out, std::vector<int>* missed = nullptr) const;

 private:
  double x_of(int x) const { return rays_ * (part_.x + x + 0.5); }
  // Returns the side of V of a pixel's centre; all rays of the pixel belong to its sector.
  SectorPlan::Side side(int x, int pixel_row) const;
  // Returns the pixels of a row in an upright sector; empty at the vanishing point if there is none.
  SectorPlan::Span upright_pixels(int pixel_row) const;
  const float* samples_of(const ViewSector& sector) const;
  void upright(int row, int begin, int end, float* out, std::vector<int>* missed) const;
  void beside(int row, int begin, int end, float* out, std::vector<int>* missed) const;
  void beside(const ViewSector* sector, int row, int begin, int end, float* out,
              std::vector<int>* missed) const;

  const SectorPlan& plan_;
  const SectorSamples& samples_;
  core::SubRectangle part_;
  int rays_;
};

}  // namespace vpe::voxel
