// When contours get ranges of their own.
#include "vpe/app/picture/contour_ranges.h"

#include <gtest/gtest.h>

namespace vpe::app {
namespace {

// Draws nothing, and states an error.
class CountingRenderer : public core::Renderer {
 public:
  explicit CountingRenderer(double stated_px) : stated_px_(stated_px) {}

  core::DrawResult draw(const core::DrawRequest& request) override {
    ++draws;
    last = request;
    core::DrawResult result;
    result.certificate.screen_space_error_px = stated_px_;
    result.certificate.quantisation_px = kQuantisation_px;
    result.certificate.shift_bound_px = stated_px_ + kQuantisation_px;
    return result;
  }

  static constexpr double kQuantisation_px = 0.03;
  int draws = 0;
  core::DrawRequest last;

 private:
  double stated_px_;
};

// Returns the number of draws of an image with the contours that it needs.
int draws_of(CountingRenderer& renderer, const core::DrawRequest& request) {
  const core::DrawResult drawn = renderer.draw(request);
  if (const auto finer = contour_request(request, drawn)) renderer.draw(*finer);
  return renderer.draws;
}

core::DrawRequest with_contours(double tolerance_px = 0.1) {
  core::DrawRequest request;
  request.settings.contours = true;
  request.settings.contour_tolerance_px = tolerance_px;
  request.want_range = true;
  return request;
}

TEST(ContourRanges, AreDrawnWhereTheImageIsCoarser) {
  for (const double stated_px : {0.0, 0.05, 0.1}) {
    CountingRenderer renderer(stated_px);
    EXPECT_EQ(draws_of(renderer, with_contours()), 1) << stated_px;
  }
  for (const double stated_px : {0.11, 1.0, 20.0}) {
    CountingRenderer renderer(stated_px);
    EXPECT_EQ(draws_of(renderer, with_contours()), 2) << stated_px;
    CountingRenderer content(stated_px);
    EXPECT_EQ(draws_of(content, with_contours(stated_px)), 1) << stated_px;
    CountingRenderer none(stated_px);
    EXPECT_EQ(draws_of(none, core::DrawRequest()), 1) << stated_px;
  }
}

TEST(ContourRanges, AskForGroundWithoutColoursWhateverTheImageIsMadeOf) {
  core::DrawRequest request = with_contours(0.25);
  request.settings.lod_tolerance_px = 5;
  request.settings.lod_triangles = 1000;
  request.settings.lod_metric = core::LodMetric::kDistance;
  request.settings.lod_centre_weight = 2;
  request.settings.ray_fovea = 0.3;
  request.settings.degrade_distance = request.settings.degrade_centre = request.settings.degrade_interest = 2;
  request.settings.mode = core::Mode::kWireframe;
  request.interest = {{10, 20, 1000, -3}};
  request.coarsening = 2;
  CountingRenderer renderer(3);
  EXPECT_EQ(draws_of(renderer, request), 2);
  const core::DrawRequest& finer = renderer.last;
  EXPECT_FALSE(finer.want_colour);
  EXPECT_TRUE(finer.want_range);
  EXPECT_EQ(finer.settings.lod_tolerance_px, 0.25);
  EXPECT_EQ(finer.settings.lod_triangles, 0);
  EXPECT_EQ(finer.settings.lod_metric, core::LodMetric::kError);
  EXPECT_EQ(finer.settings.lod_centre_weight, 0);
  EXPECT_EQ(finer.settings.ray_mode, core::RayMode::kMultires);
  EXPECT_EQ(finer.settings.ray_cell_px, 0.25);
  EXPECT_FALSE(finer.settings.ray_fovea);
  EXPECT_EQ(finer.settings.degrade_distance, 1);
  EXPECT_EQ(finer.settings.degrade_centre, 1);
  EXPECT_EQ(finer.settings.degrade_interest, 1);
  EXPECT_TRUE(finer.interest.empty());
  EXPECT_EQ(finer.coarsening, 1);
  // The material stays, so that the textures of the image are kept.
  EXPECT_EQ(finer.settings.mode, request.settings.mode);
  request.settings.contour_tolerance_px = 0;
  EXPECT_EQ(contour_request(request, renderer.draw(request))->settings.ray_mode, core::RayMode::kExact);
}

TEST(ContourRanges, AreNotDrawnBelowTheGround) {
  core::DrawResult below;
  below.certificate.is_below_ground = true;
  below.certificate.shift_bound_px = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(contour_request(with_contours(), below));
}

}  // namespace
}  // namespace vpe::app
