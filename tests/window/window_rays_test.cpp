// Requests of the window as its rays draw them.
#include <gtest/gtest.h>

#include "vpe/app/window_painter.h"
#include "vpe/voxel/ray_request.h"

namespace {

namespace core = vpe::core;

TEST(WindowRays, DrawInMultiresWhatOnlyThatHas) {
  core::DrawRequest request;
  request.settings.lod_tolerance_px = 2;
  EXPECT_EQ(vpe::app::for_window_rays(request, false).settings.ray_mode, core::RayMode::kExact);
  const auto expect_multires = [&](const auto& change) {
    core::DrawRequest asked = request;
    change(asked.settings);
    const core::DrawRequest drawn = vpe::app::for_window_rays(asked, false);
    EXPECT_EQ(drawn.settings.ray_mode, core::RayMode::kMultires);
    EXPECT_EQ(drawn.settings.ray_cell_px, 2);
    EXPECT_EQ(vpe::voxel::why_not(drawn), "");
  };
  expect_multires([](core::SettingsValues& s) { s.ray_fovea = 0.3; });
  expect_multires([](core::SettingsValues& s) { s.degrade_centre = 0; });
}

}  // namespace
