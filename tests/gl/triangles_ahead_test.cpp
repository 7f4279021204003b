// What a driver on the CPU keeps of triangles that are drawn faster than it fills them.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tests/gl/gl_fixture.h"
#include "vpe/gl/objects.h"
#include "vpe/gl/opengl.h"
#include "vpe/gl/target.h"
#include "vpe/gl/tile_drawer.h"
#include "vpe/gl/tile_scene.h"

namespace {

namespace core = vpe::core;
using vpe::gl::TileDraw;

class TrianglesAhead : public test_support::GlTest {};

// Returns an entry of this process's status, bytes.
std::size_t status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(name)) return std::stoull(line.substr(name.size())) << 10;
  }
  return 0;
}

TEST_F(TrianglesAhead, AFenceIsWaitedFor) {
  const vpe::gl::Fence none;
  none.wait();
  vpe::gl::Target target(64, 64, 1);
  target.bind();
  glClear(GL_COLOR_BUFFER_BIT);
  const vpe::gl::Fence fence = vpe::gl::Fence::make();
  fence.wait();
  GLint state = 0;
  glGetSynciv(fence.sync(), GL_SYNC_STATUS, 1, nullptr, &state);
  EXPECT_EQ(state, GL_SIGNALED);
}

// Two million triangles of one call took 104 to 140 MB of llvmpipe's memory, by how far its threads were behind; 52 MB by parts.
TEST_F(TrianglesAhead, TakeLittleMemory) {
  const auto planet =
      test_support::build_fake(dir_ / "p.vpe", test_support::FakeElevation(test_support::bumpy_height), 60000);
  const auto any = renderer(planet);  // sets up the context
  vpe::gl::TileScene scene(planet, {std::size_t{256} << 20, 2, {}});
  vpe::gl::TileDrawer drawer(planet->radius_m());
  core::DrawRequest request = test_support::request_for({20, 30, 3e6, 0, -90, 0}, planet->radius_m(), 640, 360);
  request.settings.lod_tolerance_px = 0.1;
  scene.prepare(request);
  const vpe::gl::ClipProjection clip = vpe::gl::clip_projection(request.view, scene.near_plane_m(request.view));
  std::vector<TileDraw> draws;
  std::size_t triangles = 0;
  while (triangles < 2'000'000) {
    const std::size_t before = triangles;
    for (const vpe::gl::SceneTile& t : scene.tiles()) {
      TileDraw& draw = draws.emplace_back();
      draw.mesh = t.mesh;
      draw.key = t.tile->key;
      draw.surface = t.surface;
      draw.flat = true;
      for (const vpe::gl::IndexRange& r : t.surface) triangles += (r.end - r.begin) / 3;
    }
    ASSERT_GT(triangles, before);
  }
  vpe::gl::Target target(request.view.width, request.view.height, 1);
  const auto draw = [&](std::size_t count) {
    target.bind();
    glClearColor(0, 0, 0, 1);
    glClearDepth(0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glDepthFunc(GL_GREATER);
    drawer.draw(request.view, clip, std::span(draws).first(count));
    glFinish();
  };
  draw(scene.tiles().size());
  if (std::ofstream("/proc/self/clear_refs") << "5"; status_bytes("VmHWM:") == 0)
    GTEST_SKIP() << "the system does not say how much memory this process takes";
  const std::size_t before = status_bytes("VmRSS:");
  draw(draws.size());
  const std::size_t peak = status_bytes("VmHWM:");
  RecordProperty("megabytes", static_cast<int>((peak - before) >> 20));
  std::printf("%zu triangles took %zu MB at most\n", triangles, (peak - before) >> 20);
  EXPECT_LT(peak - before, std::size_t{80} << 20);
}

}  // namespace
