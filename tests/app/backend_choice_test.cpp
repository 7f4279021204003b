// The backend of --backend auto.
#include "vpe/app/picture/backend_choice.h"

#include <gtest/gtest.h>

namespace vpe::app {
namespace {

using core::Backend;

core::DrawRequest looking(double pitch_deg, double alt_m = 20000) {
  core::DrawRequest request;
  request.view.camera = mars::to_camera({30, 10, alt_m, 70, pitch_deg, 0}, mars::kMarsRadius_m);
  return request;
}

BackendChoice choice(const std::vector<core::DrawRequest>& images, const RenderOptions& options = {},
                     bool has_gpu = false) {
  return choose_backend(options, make_settings(options), images, mars::kMarsRadius_m, has_gpu);
}

TEST(BackendChoice, RaysDrawNearbyViewsToTheHorizonWithoutAGpu) {
  EXPECT_EQ(choice({looking(-10)}).backend, Backend::kRay);
  EXPECT_EQ(choice({looking(-10)}, {}, true).backend, Backend::kPolygon);
  EXPECT_EQ(choice({looking(-70)}).backend, Backend::kPolygon);
  EXPECT_EQ(choice({looking(-30, 1e5)}).backend, Backend::kRay);
  EXPECT_EQ(choice({looking(-30, 2e5)}).backend, Backend::kPolygon);
  EXPECT_EQ(choice({looking(-70, 1e7)}).backend, Backend::kPolygon);  // the whole planet
  // Of several images, half are enough.
  EXPECT_EQ(choice({looking(-10), looking(-70)}).backend, Backend::kRay);
  EXPECT_EQ(choice({looking(-10), looking(-70), looking(-80)}).backend, Backend::kPolygon);
}

TEST(BackendChoice, ANamedBackendIsTaken) {
  for (const Backend backend : {Backend::kRay, Backend::kPolygon}) {
    RenderOptions options;
    options.backend = backend;
    for (const double pitch_deg : {-10.0, -70.0}) {
      const BackendChoice chosen = choice({looking(pitch_deg)}, options);
      EXPECT_EQ(chosen.backend, backend);
      EXPECT_EQ(chosen.settings, make_settings(options));
    }
  }
}

TEST(BackendChoice, RequestsAboutTrianglesAreDrawnByPolygons) {
  const auto expect_triangles = [](const auto& change) {
    core::DrawRequest request = looking(-10);
    EXPECT_TRUE(suits_rays(request));
    change(request);
    EXPECT_FALSE(suits_rays(request));
    // One image of many is enough.
    EXPECT_EQ(choice({looking(-10), request, looking(-10)}).backend, Backend::kPolygon);
  };
  expect_triangles([](auto& r) { r.settings.mode = core::Mode::kWireframe; });
  expect_triangles([](auto& r) { r.settings.mode = core::Mode::kMarkers; });
  expect_triangles([](auto& r) { r.settings.shading = core::Shading::kFlat; });
  expect_triangles([](auto& r) { r.settings.shading = core::Shading::kVertex; });
  expect_triangles([](auto& r) { r.settings.inspect = core::Inspect::kLevels; });
  expect_triangles([](auto& r) { r.settings.lod_triangles = 1000; });
  expect_triangles([](auto& r) { r.cull_view = r.view; });
}

// Rays have level control where they draw within a tolerance; beside the finest tiles everywhere it has no effect.
TEST(BackendChoice, LevelControlIsForRaysWithinATolerance) {
  const auto expect_rays = [](const auto& change) {
    core::DrawRequest request = looking(-10);
    change(request);
    const BackendChoice chosen = choice({request});
    EXPECT_EQ(chosen.backend, Backend::kRay);
    EXPECT_EQ(chosen.settings.values().ray_mode, core::RayMode::kMultires);
    RenderOptions finest;
    finest.tolerance_px = 0;
    EXPECT_EQ(choice({request}, finest).backend, Backend::kPolygon);
  };
  expect_rays([](auto& r) { r.settings.lod_metric = core::LodMetric::kDistance; });
  expect_rays([](auto& r) { r.settings.lod_centre_weight = 1; });
  expect_rays([](auto& r) { r.interest.push_back({0, 0, 1000, 1}); });
}

// Smooth patches are not triangles, whatever else is asked for.
TEST(BackendChoice, SmoothGroundIsDrawnByRays) {
  RenderOptions smooth;
  smooth.set = {"rays.mode=perturbation"};
  core::DrawRequest request = looking(-10);
  request.settings.shading = core::Shading::kFlat;
  const BackendChoice chosen = choice({request}, smooth);
  EXPECT_EQ(chosen.backend, Backend::kRay);
  EXPECT_EQ(chosen.settings.values().ray_mode, core::RayMode::kPerturbation);
  // Voxels likewise.
  RenderOptions voxels;
  voxels.set = {"rays.mode=discrete"};
  EXPECT_EQ(choice({request}, voxels).backend, Backend::kRay);
}

TEST(BackendChoice, RaysKeepToTheTolerance) {
  const auto settings = [](const std::vector<std::string>& set, double tolerance_px = -1) {
    RenderOptions options;
    options.set = set;
    options.tolerance_px = tolerance_px;
    const BackendChoice chosen = choice({looking(-10)}, options);
    EXPECT_EQ(chosen.backend, Backend::kRay);
    return chosen.settings.values();
  };
  EXPECT_EQ(settings({}).ray_mode, core::RayMode::kMultires);
  EXPECT_EQ(settings({}).ray_cell_px, 1);
  EXPECT_EQ(settings({}, 0.3).ray_cell_px, 0.3);
  EXPECT_EQ(settings({"lod.tolerance=4"}).ray_cell_px, 4);
  EXPECT_EQ(settings({}, 1000).ray_cell_px, core::RayLimits::kMostCell_px);
  EXPECT_EQ(settings({}, 0).ray_mode, core::RayMode::kExact);
  EXPECT_EQ(settings({}, 0.001).ray_mode, core::RayMode::kExact);
  EXPECT_EQ(settings({"rays.fovea=0.3"}).ray_mode, core::RayMode::kMultires);
  // Another named key of rays leaves the settings as they are.
  EXPECT_EQ(settings({"rays.mode=exact"}).ray_mode, core::RayMode::kExact);
  EXPECT_EQ(settings({"rays.cell=2"}).ray_mode, core::RayMode::kExact);
  EXPECT_EQ(settings({"rays.mode=multires", "rays.cell=2"}).ray_cell_px, 2);
}

}  // namespace
}  // namespace vpe::app
