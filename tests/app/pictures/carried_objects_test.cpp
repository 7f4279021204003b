// Second eyes and moved cameras among objects: what is carried is right.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>

#include "objects/model/shapes.h"
#include "tests/app/pictures/carried_images.h"
#include "vpe/app/picture/carried_drawer.h"
#include "vpe/app/scene/object_renderer.h"
#include "vpe/core/margin.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
namespace warp = vpe::warp;
using carried_images::Eyes;
using carried_images::eyes_at;
using carried_images::kHeight;
using carried_images::kWidth;
using test_support::Random;
using vpe::app::CarriedDrawer;

constexpr unsigned kSeed = 20261127;

// Writes a mesh as OBJ, y up: model axes x right, y forward, z up are -x, z, y there.
void write_obj(const objects::Mesh& mesh, const std::filesystem::path& file, const char* material = nullptr) {
  std::ofstream out(file);
  out.precision(9);
  if (material != nullptr) out << "mtllib " << material << ".mtl\nusemtl " << material << '\n';
  for (const glm::vec3& p : mesh.positions_m) out << "v " << -p.x << ' ' << p.z << ' ' << p.y << '\n';
  for (const glm::uvec3& t : mesh.triangles) out << "f " << t.x + 1 << ' ' << t.y + 1 << ' ' << t.z + 1 << '\n';
}

class CarriedObjects : public test_support::GlTest {
 protected:
  CarriedObjects()
      : planet_(carried_images::bumpy_planet()),
        surface_(planet_, std::size_t{4} << 20),
        rays_(vpe::app::with_objects(vpe::voxel::make_ray_renderer(planet_, {std::size_t{256} << 20, 2}),
                                     planet_, {})) {
    write_obj(objects::make_box({1, 1, 1}), dir_ / "box.obj");
    write_obj(objects::make_torus(0.7F, 0.25F, 48, 16), dir_ / "ring.obj");
    write_obj(objects::make_cylinder(0.2F, 2, 24), dir_ / "post.obj");
    write_obj(objects::make_box({1, 1, 1}), dir_ / "glass.obj", "glass");
    std::ofstream(dir_ / "glass.mtl") << "newmtl glass\nKd 0.2 0.4 0.8\nd 0.4\n";
    begin_scene();
  }

  void begin_scene() {
    scene_ = "version = 1\n";
    for (const char* name : {"box", "ring", "post", "glass"})
      scene_ += std::string("[[model]]\nname = \"") + name + "\"\nfile = \"" + name + ".obj\"\n";
  }

  // Puts an object beside a place, in metres to the east and north, `up_m` above the ground.
  void put(const char* model, const mars::Pose& beside, double east_m, double north_m, double up_m,
           double scale, double heading_deg, double pitch_deg = 0) {
    const double per_degree_m = planet_->radius_m() * mars::kRadiansPerDegree;
    char text[400];
    std::snprintf(text, sizeof text,
                  "[[object]]\nmodel = \"%s\"\nlon = %.9f\nlat = %.9f\nheading = %.3f\npitch = %.3f\n"
                  "scale = %.3f\nheight = %.3f\n",
                  model,
                  beside.lon_deg + east_m / per_degree_m / std::cos(beside.lat_deg * mars::kRadiansPerDegree),
                  beside.lat_deg + north_m / per_degree_m, heading_deg, pitch_deg, scale, up_m);
    scene_ += text;
  }

  // Returns a new file each time: renderers keep the scenes that they have read.
  std::string scene_file() {
    const std::filesystem::path file = dir_ / ("s" + std::to_string(scenes_++) + ".scene.toml");
    std::ofstream(file) << scene_;
    return file.string();
  }

  double ground_m(const mars::Pose& pose) const {
    return surface_.at(mars::direction({pose.lon_deg, pose.lat_deg})).height_m;
  }

  // Compares what draw_carried() has carried with the image that is drawn in full.
  void expect_right(const CarriedDrawer& drawer, const core::DrawRequest& request, double base_m,
                    const core::DrawResult& is, const std::string& what) {
    core::DrawRequest wide = request;
    wide.view = core::with_margin(request.view, glm::ivec2(carried_images::kAround_px));
    const core::DrawResult full = rays_->draw(wide);
    const double stretch = core::corner_stretch(request.view);
    const double bound_px = (is.certificate.shift_bound_px + full.certificate.shift_bound_px) * stretch + 1e-3;
    int wrong = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto at = static_cast<std::size_t>(y * kWidth + x);
        const warp::Origin origin = drawer.carried().origin[at];
        if (origin == warp::Origin::kOpen) continue;
        const double off = carried_images::off_px(request, base_m, is.frame, full.frame, x, y);
        if (off > bound_px) ++wrong;
        most_share_ = std::max(most_share_, off / bound_px);
      }
    }
    EXPECT_EQ(wrong, 0) << what;
  }

  std::shared_ptr<const paging::PlanetFile> planet_;
  paging::Surface surface_;
  std::unique_ptr<core::PixelRenderer> rays_;
  std::string scene_;
  int scenes_ = 0;
  double most_share_ = 0;
};

// Objects around the camera, before, beside and behind it, as near as a tenth of its height, rings that it looks through
// among them.
TEST_F(CarriedObjects, SecondEyesAmongThemAreRightInAHundredPairs) {
  std::printf("seed %u\n", kSeed);
  Random random(kSeed);
  CarriedDrawer pair(*rays_, planet_, {.threads = 2});
  double carried = 0;
  int with_objects = 0;
  for (int n = 0; n < 100; ++n) {
    const double height_m = random.log_uniform(20, 2000);
    mars::Pose pose{random.uniform(-180, 180), random.uniform(-80, 80), 0,
                    random.uniform(0, 360),    random.uniform(-60, 5),  random.uniform(-20, 20)};
    pose.alt_m = ground_m(pose) + height_m;
    begin_scene();
    for (int k = 0; k < 40; ++k) {
      const double angle = random.uniform(0, 2 * M_PI);
      const double away_m = height_m * random.log_uniform(0.1, 6);
      const char* const models[] = {"box", "ring", "post"};
      put(models[k % 3], pose, away_m * std::sin(angle), away_m * std::cos(angle),
          k % 2 == 0 ? 0.0 : height_m * random.uniform(0.3, 1.2), height_m * random.log_uniform(0.05, 0.6),
          random.uniform(0, 360), k % 3 == 1 ? 90.0 : random.uniform(-30, 30));
    }
    const double base_m = height_m * random.log_uniform(0.003, 0.1);
    Eyes eyes = eyes_at(pose, planet_->radius_m(), base_m);
    eyes.left.settings.scene = eyes.right.settings.scene = scene_file();
    const core::DrawResult left = pair.draw_first(eyes.left);
    ASSERT_TRUE(left.certificate.objects);
    with_objects += left.certificate.objects->drawn > 0 ? 1 : 0;
    const core::DrawResult right = pair.draw_carried(eyes.right);
    if (!right.certificate.carried) continue;
    carried += right.certificate.carried->carried_share + right.certificate.carried->between_share;
    expect_right(pair, eyes.right, base_m, right, "pair " + std::to_string(n));
  }
  std::printf("carried %.3f, with objects %d, largest share of the bound %.3f\n", carried / 100, with_objects,
              most_share_);
  EXPECT_GT(with_objects, 80);
  EXPECT_GT(carried / 100, 0.3);
}

// The first eye looks past a post at its side, which stands before the second eye.
TEST_F(CarriedObjects, APostBesideTheFirstImageHidesWhatIsBehindIt) {
  mars::Pose pose{20, 30, 0, 0, 0, 0};
  pose.alt_m = ground_m(pose) + 100;
  put("post", pose, 30, 12, 60, 40, 0);
  Eyes eyes = eyes_at(pose, planet_->radius_m(), 50);
  eyes.left.settings.scene = eyes.right.settings.scene = scene_file();
  CarriedDrawer pair(*rays_, planet_, {.most_drawn_share = 1, .threads = 2});
  EXPECT_EQ(pair.draw_first(eyes.left).certificate.objects->drawn, 0);
  const core::DrawResult right = pair.draw_carried(eyes.right);
  ASSERT_TRUE(right.certificate.carried);
  EXPECT_GT(right.certificate.objects->drawn, 0);
  expect_right(pair, eyes.right, 50, right, "post");
}

// Below a ring that lies over the camera: the eye moves out from under the overhang. It is within the
// ring's ball, and yet far from it.
TEST_F(CarriedObjects, AnEyeUnderAnOverhang) {
  mars::Pose pose{20, 30, 0, 0, 40, 0};
  pose.alt_m = ground_m(pose) + 20;
  put("ring", pose, 0, 40, 60, 60, 0);
  for (const double base_m : {0.5, 2.0, 8.0}) {
    Eyes eyes = eyes_at(pose, planet_->radius_m(), base_m);
    eyes.left.settings.scene = eyes.right.settings.scene = scene_file();
    CarriedDrawer pair(*rays_, planet_, {.most_drawn_share = 1, .threads = 2});
    const core::DrawResult left = pair.draw_first(eyes.left);
    EXPECT_GT(left.certificate.objects->drawn, 0);
    const core::DrawResult right = pair.draw_carried(eyes.right);
    ASSERT_TRUE(right.certificate.carried) << base_m;
    EXPECT_GT(right.certificate.carried->carried_share, base_m < 5 ? 0.1 : 0) << base_m;
    expect_right(pair, eyes.right, base_m, right, "overhang");
  }
}

// A semi-transparent pixel shows two ranges, and the eyes see them at two places.
TEST_F(CarriedObjects, SemiTransparentOnesAreDrawnInFull) {
  mars::Pose pose{20, 30, 0, 0, -5, 0};
  pose.alt_m = ground_m(pose) + 20;
  for (const char* model : {"glass", "box"}) {
    SCOPED_TRACE(model);
    begin_scene();
    put(model, pose, 0, 60, 10, 20, 30);
    Eyes eyes = eyes_at(pose, planet_->radius_m(), 1);
    eyes.left.settings.scene = eyes.right.settings.scene = scene_file();
    CarriedDrawer pair(*rays_, planet_, {.threads = 2});
    const core::DrawResult left = pair.draw_first(eyes.left);
    ASSERT_GT(left.certificate.objects->drawn, 0);
    EXPECT_EQ(left.shows_see_through, std::string(model) == "glass");
    const core::DrawResult right = pair.draw_carried(eyes.right);
    EXPECT_EQ(right.certificate.carried.has_value(), std::string(model) == "box");
    if (!right.certificate.carried) {
      EXPECT_EQ(right.frame.colour, rays_->draw(eyes.right).frame.colour);
    }
  }
}

}  // namespace
