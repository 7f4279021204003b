#include "vpe/core/ray_lengths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/core/frame.h"

namespace vpe::core {
namespace {

View view_with_part() {
  View view;
  view.camera = mars::to_camera({30, 40, 5000, 60, -20, 15}, mars::kMarsRadius_m);
  view.width = 300;
  view.height = 200;
  view.fov_deg = 75;
  view.principal_offset_px = {20, -11};
  view.part = {13, 7, 161, 140};
  return view;
}

double depth_of_unit_ray(const View& view, int x, int y) {
  return glm::dot(pixel_ray(view, view.part.x + x + 0.5, view.part.y + y + 0.5), view.camera.axes.forward);
}

TEST(RayLengths, AreRangesDividedByDepths) {
  const View view = view_with_part();
  const RayLengths lengths(view);
  std::vector<float> row(161);
  for (int y = 0; y < 140; ++y) {
    lengths.row(y, row);
    for (int x = 0; x < 161; ++x) {
      const double wanted = 1 / depth_of_unit_ray(view, x, y);
      ASSERT_NEAR(static_cast<double>(row[static_cast<std::size_t>(x)]), wanted, 3e-7 * wanted);
      ASSERT_EQ(lengths.at(x, y), row[static_cast<std::size_t>(x)]);
    }
  }
}

TEST(InverseDepths, AreAlongTheCamerasAxis) {
  const View view = view_with_part();
  std::vector<float> range_m(161 * 140);
  for (std::size_t n = 0; n < range_m.size(); ++n)
    range_m[n] = n % 7 == 0 ? kSkyRange : n % 7 == 1 ? 1e-5F : std::pow(10.0F, static_cast<float>(n % 9));
  std::vector<float> out(range_m.size());
  base::ThreadPool one(1);
  inverse_depths(view, range_m, one, out);
  for (int y = 0; y < 140; ++y) {
    for (int x = 0; x < 161; ++x) {
      const auto n = static_cast<std::size_t>(161 * y + x);
      const double depth_m = static_cast<double>(range_m[n]) * depth_of_unit_ray(view, x, y);
      const double wanted = std::isinf(range_m[n]) ? 0 : std::min(1 / depth_m, 1000.0);
      ASSERT_NEAR(static_cast<double>(out[n]), wanted, 4e-7 * wanted) << x << " " << y;
    }
  }
  std::vector<float> again(range_m.size());
  base::ThreadPool three(3);
  inverse_depths(view, range_m, three, again);
  EXPECT_EQ(again, out);
}

}  // namespace
}  // namespace vpe::core
