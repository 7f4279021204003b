// The fan of vertical planes that a round image of a tilted camera is cast by.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): cast_by_fan() (fan_caster.h) plans an image with it. A fan is even in azimuth
// and in elevation about the camera's vertical, so its planes are columns (columns.h). Each column has the rows that the image
// shows there and a margin.
#pragma once

#include <cstdint>
#include <vector>

#include "vpe/core/view.h"
#include "vpe/voxel/cast/column_batch.h"
#include "vpe/voxel/columns/round_refine.h"

namespace vpe::voxel {

// Plans the fan of the drawn part of a cylindrical or equirectangular view. A pure value.
class ViewFan {
 public:
  // `up` is the camera's vertical, of unit length.
  ViewFan(const core::View& view, const glm::dvec3& up);

  // Returns the angle between rows, and between columns where they are farthest apart in the image: at most the smaller side of a
  // pixel at the principal point, unless that is less than half of the mean of both sides.
  double spacing_rad() const { return spacing_rad_; }

  int columns() const { return columns_; }
  int rows() const { return static_cast<int>(slope_.size()) - 1; }
  // Returns the number of samples within all columns' rows.
  std::int64_t sample_count() const;

  // Returns the fan's samples in rows() * columns() floats at range_m. The fan must outlive them.
  FanSamples samples(const float* range_m) const;
  // Returns the columns that set the samples at range_m. The fan must outlive them.
  ColumnBatch batch(float* range_m) const;

 private:
  struct Border;

  void set_rows_of_columns(const Border& border);
  void set_table();
  double azimuth(int column) const { return first_azimuth_ + column * azimuth_step_; }

  double spacing_rad_;
  glm::dvec3 up_, north_, east_;
  double azimuth_step_ = 0;
  double first_azimuth_ = 0;
  double elevation_step_ = 0;
  double first_elevation_ = 0;
  int columns_ = 0;
  bool is_full_circle_ = false;
  std::vector<int> first_row_, end_row_;  // of each column
  std::vector<double> slope_;             // of each row, and an infinite one
  std::vector<float> rounded_slope_;
  std::vector<float> length_;  // of the rays of slope 1
};

}  // namespace vpe::voxel
