// Renderers of both backends that go over to a patched planet draw what new ones would draw, and load again only what
// the patch has changed.
#include <gtest/gtest.h>

#include <map>
#include <mutex>

#include "mars/geodesy/sun.h"
#include "paging/planet/planet_user.h"
#include "tests/gl/gl_fixture.h"
#include "tests/paging/patch_between.h"
#include "vpe/core/backend.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using core::Backend;
using test_support::build_changed;
using test_support::kPatched;
using test_support::patch_between;
using test_support::patches;
using Planet = std::shared_ptr<const paging::PlanetFile>;

// Draws, and can change its planet.
struct Drawer {
  std::unique_ptr<core::Renderer> renderer;
  core::DrawResult draw(const core::DrawRequest& request) { return renderer->draw(request); }
  void change_planet(const Planet& planet) { paging::change_planet(*renderer, planet); }
};

// The tiles that a planet has read since the last clear().
class Reads {
 public:
  void add(const lod::TileKey& key) {
    const std::lock_guard lock(mutex_);
    ++count_[lod::pack(key)];
  }
  std::map<std::int64_t, int> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(count_, {});
  }

 private:
  std::mutex mutex_;
  std::map<std::int64_t, int> count_;
};

// The planets are read alone, and made once.
class PatchedPlanets : public test_support::GlTest {
 protected:
  static void SetUpTestSuite() {
    GlTest::SetUpTestSuite();
    planets_ = std::make_unique<Planets>();
    Planets& p = *planets_;
    p.base = build_changed(p.dir / "base.vpe", {.has_image = true},
                           [&p](const lod::TileKey& key) { p.reads.add(key); });
    p.changed = build_changed(
        p.dir / "changed.vpe",
        {.raised_m = 1500, .is_finer = true, .has_nodata = true, .has_image = true, .is_painted = true});
    p.patch = patch_between(*p.base, *p.changed);
    p.patched = p.base->with(p.patch);
  }
  static void TearDownTestSuite() {
    planets_.reset();
    GlTest::TearDownTestSuite();
  }
  void SetUp() override { reads_.take(); }

  static Drawer make(Backend backend, const Planet& planet) {
    constexpr std::size_t kMemory = std::size_t{512} << 20;
    if (backend == Backend::kPolygon)
      return {vpe::gl::make_polygon_renderer(context_, planet, {kMemory, 2, {}})};
    return {vpe::voxel::make_ray_renderer(planet, {kMemory, 2})};
  }

  // Returns views of the patch from near by and from orbit, and one of ground far away.
  std::vector<core::DrawRequest> requests() const {
    const mars::LonLat at = mars::lon_lat(kPatched);
    std::vector<core::DrawRequest> out;
    for (const mars::Pose& pose : {mars::Pose{at.lon_deg - 1.5, at.lat_deg, 30000, 80, -15, 0},
                                   {at.lon_deg, at.lat_deg - 3, 250000, 10, -50, 0},
                                   {at.lon_deg, at.lat_deg, 6e6, 0, -90, 0},
                                   {at.lon_deg + 170, -at.lat_deg, 3e5, 0, -40, 0}})
      out.push_back(test_support::request_for(pose, base_->radius_m(), 160, 120));
    return out;
  }

  static void expect_same(const core::DrawResult& a, const core::DrawResult& b) {
    EXPECT_TRUE(a.frame.colour == b.frame.colour);
    EXPECT_TRUE(a.frame.range_m == b.frame.range_m);
    EXPECT_TRUE(a.missing.empty());
    EXPECT_TRUE(b.missing.empty());
    EXPECT_EQ(a.certificate.geometric_error_m, b.certificate.geometric_error_m);
    EXPECT_EQ(a.certificate.screen_space_error_px, b.certificate.screen_space_error_px);
    EXPECT_EQ(a.certificate.image_bound_px, b.certificate.image_bound_px);
    EXPECT_EQ(a.certificate.nodata_share, b.certificate.nodata_share);
    EXPECT_EQ(a.certificate.tiles_drawn, b.certificate.tiles_drawn);
  }

  struct Planets {
    test_support::TempDir dir;
    Reads reads;
    Planet base;
    Planet changed;
    std::shared_ptr<const paging::TilePatch> patch;
    Planet patched;
  };
  static std::unique_ptr<Planets> planets_;

  Reads& reads_ = planets_->reads;
  const Planet& base_ = planets_->base;
  const Planet& changed_ = planets_->changed;
  const std::shared_ptr<const paging::TilePatch>& patch_ = planets_->patch;
  const Planet& patched_ = planets_->patched;
};
std::unique_ptr<PatchedPlanets::Planets> PatchedPlanets::planets_;

class PatchedRenderer : public PatchedPlanets, public ::testing::WithParamInterface<Backend> {
 protected:
  static Drawer make(const Planet& planet) { return PatchedPlanets::make(GetParam(), planet); }
};

TEST_P(PatchedRenderer, DrawsWhatANewOneDraws) {
  struct Look {
    core::Mode mode;
    core::Shading shading;
    bool shadows;
    double exaggeration;
  };
  Drawer draw = make(base_);
  Drawer fresh = make(patched_);
  Drawer built = make(changed_);
  Drawer before = make(base_);
  int different = 0;
  for (const Look& look : {Look{core::Mode::kColoured, core::Shading::kGouraud, false, 1},
                           Look{core::Mode::kLit, core::Shading::kGouraud, true, 1},
                           Look{core::Mode::kTextured, core::Shading::kGouraud, true, 2},
                           Look{core::Mode::kColoured, core::Shading::kFlat, true, 1}}) {
    for (core::DrawRequest request : requests()) {
      SCOPED_TRACE(testing::Message() << "mode " << static_cast<int>(look.mode) << ", height "
                                      << glm::length(request.view.camera.position_m) - base_->radius_m());
      request.settings.mode = look.mode;
      request.settings.shading = look.shading;
      request.settings.shadows = look.shadows;
      request.settings.exaggeration = look.exaggeration;
      if (look.shadows) {
        // Low, so that the raised ground darkens tiles beside it.
        const mars::LonLat below = mars::lon_lat(glm::normalize(request.view.camera.position_m));
        request.sun = mars::sun_direction(below, 250, 2);
      }
      const core::DrawResult first = draw.draw(request);
      expect_same(first, before.draw(request));
      draw.change_planet(patched_);
      const core::DrawResult after = draw.draw(request);
      expect_same(after, fresh.draw(request));
      expect_same(after, built.draw(request));
      different += after.frame.colour == first.frame.colour ? 0 : 1;
      draw.change_planet(base_);
      expect_same(draw.draw(request), first);
    }
  }
  EXPECT_GE(different, 12) << "the patch shall be seen in three of four views";
}

// Planets that follow each other keep what is the same in both; images after each step are those of a new renderer.
TEST_P(PatchedRenderer, DrawsPlanetsThatFollowEachOtherAsNewOnesDo) {
  std::vector<std::shared_ptr<const paging::TilePatch>> patches{patch_};
  const glm::dvec3 beside = glm::normalize(kPatched + glm::dvec3(0, 0.05, 0));
  int n = 0;
  for (const test_support::PlanetChange& change :
       {test_support::PlanetChange{.raised_m = 900, .is_finer = true, .has_image = true},
        test_support::PlanetChange{.has_image = true, .tower = mars::Cap{beside, 0.006}}})
    patches.push_back(patch_between(*base_, *build_changed(dir_ / (std::to_string(n++) + ".vpe"), change)));
  for (const bool shadows : {false, true}) {
    Drawer draw = make(base_);
    Planet planet = base_;
    for (const int state : {0, 1, 2, 1, 1, 0}) {
      planet = base_->with(patches[static_cast<std::size_t>(state)], planet);
      draw.change_planet(planet);
      Drawer fresh = make(planet);
      for (core::DrawRequest request : requests()) {
        SCOPED_TRACE(testing::Message() << "state " << state << ", shadows " << shadows << ", height "
                                        << glm::length(request.view.camera.position_m) - base_->radius_m());
        request.settings.mode = core::Mode::kTextured;
        request.settings.shadows = shadows;
        request.sun =
            mars::sun_direction(mars::lon_lat(glm::normalize(request.view.camera.position_m)), 250, 2);
        expect_same(draw.draw(request), fresh.draw(request));
      }
    }
    draw.change_planet(base_);
    Drawer fresh = make(base_);
    for (const core::DrawRequest& request : requests()) expect_same(draw.draw(request), fresh.draw(request));
  }
}

TEST_P(PatchedRenderer, ReadsNothingAgainForAPatchWithEqualTiles) {
  Drawer draw = make(base_);
  draw.change_planet(patched_);
  for (const core::DrawRequest& request : requests()) draw.draw(request);
  reads_.take();
  draw.change_planet(base_->with(std::make_shared<paging::TilePatch>(*patch_), patched_));
  for (const core::DrawRequest& request : requests()) draw.draw(request);
  EXPECT_TRUE(reads_.take().empty());
}

TEST_P(PatchedRenderer, LoadsOnlyTouchedTilesAgain) {
  Drawer draw = make(base_);
  const std::vector<core::DrawRequest> views = requests();
  const auto draw_all = [&] {
    for (const core::DrawRequest& request : views) draw.draw(request);
    return reads_.take();
  };
  reads_.take();
  const auto first = draw_all();
  EXPECT_TRUE(draw_all().empty()) << "all views shall fit into the memory";
  draw.change_planet(patched_);
  const auto again = draw_all();
  EXPECT_GT(again.size(), 5U);
  EXPECT_LT(again.size(), first.size());
  for (const auto& [key, count] : again) {
    const bool is_image =
        std::ranges::any_of(patch_->images, [&, k = key](const auto& image) { return image.key == k; });
    EXPECT_TRUE(is_image || patches(*patch_, *lod::unpack(key))) << lod::to_string(*lod::unpack(key));
  }
  EXPECT_TRUE(draw_all().empty());
  // What the patch does not touch is far away from it: that view needs nothing new.
  draw.change_planet(base_);
  draw_all();
  draw.change_planet(patched_);
  draw.draw(views.back());
  for (const auto& [key, count] : reads_.take())
    EXPECT_TRUE(patches(*patch_, *lod::unpack(key))) << lod::to_string(*lod::unpack(key));
}

// Posts beside the border of a tile are raised. The tile beyond the border stays the same, but not its normals. A shadow
// falls on that tile and on the next one.
TEST_P(PatchedRenderer, MakesPagesAgainThatDependOnATileBeside) {
  const lod::TileTree& tree = base_->tree();
  const auto west = [](const lod::TileKey& key) { return lod::neighbour(key, lod::Edge::kWest).key; };
  const auto is_leaf = [&](const lod::TileKey& key) {
    const lod::TileInfo* tile = tree.find(key);
    return tile != nullptr && !tile->has_children;
  };
  const auto raised = std::ranges::find_if(tree.tiles(), [&](const lod::TileInfo& tile) {
    return tile.key.level == base_->meta().finest_level && is_leaf(tile.key) && is_leaf(west(tile.key)) &&
           is_leaf(west(west(tile.key))) && tile.key.i > 1;
  });
  ASSERT_NE(raised, tree.tiles().end());
  const lod::TileKey beside = west(raised->key);
  const lod::GridLines lines = lod::grid_lines(raised->key, base_->meta().tile.intervals());
  const auto post = [&](std::size_t i) {
    return mars::chart_direction(raised->key.face, lines.u[i], lines.v[7]);
  };
  const Planet changed =
      build_changed(dir_ / "tower.vpe",
                    {.has_image = true, .tower = mars::Cap{post(3), 1.2 * glm::length(post(3) - post(1))}});
  const auto patch = patch_between(*base_, *changed);
  ASSERT_TRUE(patches(*patch, raised->key));
  ASSERT_FALSE(patches(*patch, beside));
  const Planet patched = base_->with(patch);

  for (const lod::TileKey& below : {beside, west(beside)}) {
    SCOPED_TRACE(lod::to_string(below));
    const glm::dvec3 up = lod::bounding_cap(below).centre;
    const mars::LonLat place = mars::lon_lat(up);
    core::DrawRequest request = test_support::request_for({place.lon_deg, place.lat_deg, 70000, 0, -90, 0},
                                                          base_->radius_m(), 160, 120, 40);
    const glm::dvec3 across = glm::normalize(post(3) - up * glm::dot(post(3), up));
    request.sun = std::cos(0.1) * across + std::sin(0.1) * up;
    request.settings.mode = core::Mode::kLit;
    for (const bool shadows : {false, true}) {
      SCOPED_TRACE(shadows);
      request.settings.shadows = shadows;
      Drawer draw = make(base_);
      const core::DrawResult first = draw.draw(request);
      draw.change_planet(patched);
      const core::DrawResult after = draw.draw(request);
      EXPECT_EQ(after.frame.colour == first.frame.colour, below != beside && !shadows);
      expect_same(after, make(changed).draw(request));
    }
  }
}

TEST_P(PatchedRenderer, ShowsAPatchedImageOnGroundThatStays) {
  const Planet painted = build_changed(dir_ / "painted.vpe", {.has_image = true, .is_painted = true});
  const auto patch = patch_between(*base_, *painted);
  EXPECT_TRUE(patch->tiles.empty());
  const Planet patched = base_->with(patch);
  for (core::DrawRequest request : requests()) {
    request.settings.mode = core::Mode::kTextured;
    Drawer draw = make(base_);
    draw.draw(request);
    draw.change_planet(patched);
    expect_same(draw.draw(request), make(painted).draw(request));
  }
}

// Images that do not wait end with the image of a new renderer; none shows ground of the planet before.
TEST_P(PatchedRenderer, ImagesThatDoNotWaitSettleOnTheNewPlanet) {
  Drawer draw = make(base_);
  Drawer fresh = make(patched_);
  core::DrawRequest request = requests()[1];
  draw.draw(request);
  const core::DrawResult expected = fresh.draw(request);
  draw.change_planet(patched_);
  core::DrawRequest live = request;
  live.paging.wait = false;
  core::DrawResult result;
  for (int frame = 0; frame < 2000; ++frame) {
    result = draw.draw(live);
    if (result.settled) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ASSERT_TRUE(result.settled);
  EXPECT_TRUE(result.frame.colour == expected.frame.colour);
  EXPECT_TRUE(result.frame.range_m == expected.frame.range_m);
  // A wait after the change makes the first image complete.
  draw.change_planet(base_);
  draw.draw(request);
  draw.change_planet(patched_);
  live.paging.change_wait_s = 600;
  EXPECT_TRUE(draw.draw(live).missing.empty());
}

TEST_P(PatchedRenderer, PlanetsMayChangeWhileLoadersWork) {
  Drawer draw = make(base_);
  for (int round = 0; round < 6; ++round) {
    core::DrawRequest live = requests()[static_cast<std::size_t>(round) % 2];
    live.paging.wait = false;
    draw.draw(live);
    draw.change_planet(round % 2 == 0 ? patched_ : base_);
  }
  Drawer fresh = make(base_);
  const core::DrawRequest request = requests()[1];
  expect_same(draw.draw(request), fresh.draw(request));
}

INSTANTIATE_TEST_SUITE_P(Backends, PatchedRenderer, ::testing::Values(Backend::kPolygon, Backend::kRay),
                         [](const auto& backend) { return std::string(core::to_string(backend.param)); });

TEST_F(PatchedPlanets, HavePanoramasOfThePlanetBuiltWithTheChange) {
  core::DrawRequest request = requests()[0];
  request.view.projection = core::Projection::kCylinder;
  request.view.camera =
      mars::to_camera({mars::lon_lat(kPatched).lon_deg - 1.5, mars::lon_lat(kPatched).lat_deg, 20000, 0, 0, 0},
                      base_->radius_m());
  request.view.width = 360;
  request.view.height = 100;
  request.view.fov_deg = 50;
  Drawer draw = make(Backend::kRay, base_);
  const core::DrawResult first = draw.draw(request);
  draw.change_planet(patched_);
  const core::DrawResult after = draw.draw(request);
  EXPECT_FALSE(after.frame.range_m == first.frame.range_m);
  expect_same(after, make(Backend::kRay, changed_).draw(request));
}

}  // namespace
