// Renderers of objects go over to a patched planet with the ground below them.
#include <gtest/gtest.h>

#include <fstream>

#include "paging/planet/planet_user.h"
#include "tests/gl/gl_fixture.h"
#include "tests/paging/patch_between.h"
#include "vpe/app/scene/object_renderer.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using test_support::build_changed;
using test_support::kPatched;
using Planet = std::shared_ptr<const paging::PlanetFile>;

class PatchedObjects : public test_support::GlTest {};

TEST_F(PatchedObjects, StandOnThePatchedGround) {
  const Planet base = build_changed(dir_ / "base.vpe", {});
  const Planet raised = build_changed(dir_ / "raised.vpe", {.raised_m = 2000});
  const Planet patched = base->with(test_support::patch_between(*base, *raised));
  const mars::LonLat place = mars::lon_lat(kPatched);
  std::ofstream(dir_ / "box.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  std::ofstream(dir_ / "a.scene.toml") << "version = 1\n[[model]]\nname = \"box\"\nfile = \"box.obj\"\n"
                                       << "[[object]]\nmodel = \"box\"\nlon = " << place.lon_deg
                                       << "\nlat = " << place.lat_deg << "\nscale = 9000\n";
  core::DrawRequest request = test_support::request_for({place.lon_deg, place.lat_deg - 1, 30000, 0, -20, 0},
                                                        base->radius_m(), 120, 90);
  const auto make = [&](bool rays, const Planet& planet) -> std::unique_ptr<core::Renderer> {
    if (!rays) return vpe::app::with_objects(renderer(planet), planet, {});
    return vpe::app::with_objects(vpe::voxel::make_ray_renderer(planet, {std::size_t{64} << 20, 2}), planet,
                                  {});
  };
  for (const bool rays : {false, true}) {
    SCOPED_TRACE(rays);
    request.settings.scene.clear();
    const std::unique_ptr<core::Renderer> draw = make(rays, base);
    const core::DrawResult bare = draw->draw(request);
    request.settings.scene = (dir_ / "a.scene.toml").string();
    const core::DrawResult before = draw->draw(request);
    EXPECT_FALSE(before.frame.colour == bare.frame.colour) << "the object shall be seen";
    paging::change_planet(*draw, patched);
    const core::DrawResult after = draw->draw(request);
    const core::DrawResult fresh = make(rays, raised)->draw(request);
    EXPECT_FALSE(after.frame.range_m == before.frame.range_m);
    EXPECT_TRUE(after.frame.colour == fresh.frame.colour);
    EXPECT_TRUE(after.frame.range_m == fresh.frame.range_m);
    EXPECT_EQ(after.certificate.shift_bound_px, fresh.certificate.shift_bound_px);
  }
}

TEST_F(PatchedObjects, NeedARendererThatCanChangeItsPlanet) {
  class Blank : public core::Renderer {
    core::DrawResult draw(const core::DrawRequest&) override { return {}; }
  };
  Blank blank;
  EXPECT_THROW(paging::change_planet(blank, nullptr), std::invalid_argument);
}

}  // namespace
