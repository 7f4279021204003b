// Pieces of meshes that are culled change no pixel: each image is drawn from the pieces in sight and from whole meshes.
#include <gtest/gtest.h>

#include <array>

#include "tests/gl/gl_fixture.h"
#include "vpe/gl/opengl.h"
#include "vpe/gl/target.h"
#include "vpe/gl/tile_drawer.h"
#include "vpe/gl/tile_scene.h"

namespace {

namespace core = vpe::core;
using test_support::Random;
using vpe::gl::IndexRange;
using vpe::gl::TileDraw;

struct Buffers {
  std::vector<float> depth;
  std::vector<vpe::base::Rgb> ids;
  bool operator==(const Buffers&) const = default;
};

class CulledPieces : public test_support::GlTest {
 protected:
  static Buffers drawn(vpe::gl::TileDrawer& drawer, const core::View& view, const vpe::gl::ClipProjection& clip,
                       std::span<const TileDraw> draws) {
    const glm::ivec2 size = core::drawn_size(view);
    vpe::gl::Target target(size.x, size.y, 1);
    target.bind();
    glClearColor(0, 0, 0, 1);
    glClearDepth(0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glDepthFunc(GL_GREATER);
    drawer.draw_tile_ids(view, clip, draws);
    Buffers out;
    target.read_depth(out.depth);
    target.read_colour(out.ids);
    return out;
  }
};

TEST_F(CulledPieces, ChangeNoPixel) {
  const glm::dvec3 fine = glm::normalize(glm::dvec3(0.2, -0.4, 1));
  const auto planet = test_support::build_fake(
      dir_ / "p.vpe",
      test_support::FakeElevation(test_support::bumpy_height, test_support::fine_around(fine, 0.05, 10000)),
      60000);
  const paging::Surface surface(planet, std::size_t{1} << 28);
  const auto any = renderer(planet);  // sets up the context
  vpe::gl::TileScene scene(planet, {std::size_t{256} << 20, 2, {}});
  vpe::gl::TileDrawer drawer(planet->radius_m());
  Random random(91);
  std::int64_t all = 0;
  std::int64_t culled = 0;
  for (int n = 0; n < 60; ++n) {
    const glm::dvec3 at = n % 2 == 0 ? random.direction() : glm::normalize(fine + 0.05 * random.direction());
    const mars::LonLat place = mars::lon_lat(at);
    const mars::Pose pose{place.lon_deg,
                          place.lat_deg,
                          surface.at(at).height_m + random.log_uniform(2, 5e6),
                          random.uniform(0, 360),
                          n % 3 == 0 ? random.uniform(-12, 0) : random.uniform(-90, 5),
                          random.uniform(-180, 180)};
    core::DrawRequest request =
        test_support::request_for(pose, planet->radius_m(), 200, 120, random.log_uniform(4, 110));
    request.settings.lod_tolerance_px = random.log_uniform(0.1, 4);
    if (n % 4 == 3) request.view.part = {30, 20, 97, 61};
    scene.prepare(request);
    const vpe::gl::ClipProjection clip =
        vpe::gl::clip_projection(request.view, scene.near_plane_m(request.view));
    for (const bool by_triangle : {false, true}) {
      std::vector<TileDraw> draws;
      std::vector<IndexRange> whole;
      for (const vpe::gl::SceneTile& t : scene.tiles()) {
        TileDraw& draw = draws.emplace_back();
        draw.mesh = t.mesh;
        draw.key = t.tile->key;
        draw.skirt_m = t.skirt_m;
        draw.surface = t.surface;
        draw.flat = true;
        draw.by_triangle = by_triangle;
        whole.push_back({0, t.mesh->ranges.surface});
        all += t.mesh->ranges.surface;
        for (const IndexRange& r : t.surface) culled -= r.end - r.begin;
        culled += t.mesh->ranges.surface;
      }
      const Buffers some = drawn(drawer, request.view, clip, draws);
      for (std::size_t k = 0; k < draws.size(); ++k) draws[k].surface = std::span(&whole[k], 1);
      ASSERT_EQ(some, drawn(drawer, request.view, clip, draws))
          << "view " << n << " by triangle " << by_triangle;
    }
  }
  EXPECT_GT(culled, all / 4);
  EXPECT_LT(culled, all);
}

}  // namespace
