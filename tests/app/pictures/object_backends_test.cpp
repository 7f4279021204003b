// Objects by both backends: the same silhouettes and ranges, within what the certificates say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "objects/model/shapes.h"
#include "tests/gl/gl_fixture.h"
#include "vpe/app/scene/object_renderer.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using test_support::Random;

constexpr unsigned kSeed = 20261126;
constexpr int kWidth = 120;
constexpr int kHeight = 90;
constexpr int kKinds = 15;  // each is read and simplified by processes of its own

// Writes a mesh as OBJ, y up: model axes x right, y forward, z up are -x, z, y there.
void write_obj(const objects::Mesh& mesh, const std::filesystem::path& file) {
  std::ofstream out(file);
  out.precision(9);
  for (const glm::vec3& p : mesh.positions_m) out << "v " << -p.x << ' ' << p.z << ' ' << p.y << '\n';
  for (const glm::uvec3& t : mesh.triangles) out << "f " << t.x + 1 << ' ' << t.y + 1 << ' ' << t.z + 1 << '\n';
}

objects::Mesh kind(int n) {
  const auto size = [n](int step, float low) { return low + 0.1F * static_cast<float>((n * step) % 11); };
  switch (n % 5) {
    case 0: return objects::make_box({size(3, 0.3F), size(5, 0.3F), size(7, 0.4F)});
    case 1: return objects::make_cylinder(size(3, 0.2F), size(5, 0.5F), 12 + n);
    case 2: return objects::make_cone(size(7, 0.3F), size(3, 0.6F), 10 + n);
    case 3: return objects::make_torus(size(5, 0.5F), 0.2F, 20 + n, 12);
    default: return objects::make_rock(static_cast<std::uint32_t>(n), 3);
  }
}

class ObjectBackends : public test_support::GlTest {
 protected:
  // All tests share the renderers, which keep the models.
  static void SetUpTestSuite() {
    GlTest::SetUpTestSuite();
    const auto planet = bumpy_planet();
    rays_ =
        vpe::app::with_objects(vpe::voxel::make_ray_renderer(planet, {std::size_t{256} << 20, 2}), planet, {});
    triangles_ = vpe::app::with_objects(
        vpe::gl::make_polygon_renderer(context_, planet, {std::size_t{256} << 20, 2, {}}), planet, {});
  }
  static void TearDownTestSuite() {
    rays_.reset();
    triangles_.reset();
    GlTest::TearDownTestSuite();
  }

  ObjectBackends() : planet_(bumpy_planet()), surface_(planet_, std::size_t{4} << 20) {}

  static std::shared_ptr<const paging::PlanetFile> bumpy_planet() {
    static const test_support::TempDir folder;
    static const auto planet = test_support::build_fake(
        folder / "bumpy.vpe", test_support::FakeElevation(test_support::bumpy_height), 20'000);
    return planet;
  }

  // Writes 400 objects of 15 kinds, 0.5 to 12 km high, within some 200 km of a place.
  std::string write_scene(const mars::LonLat& middle, Random& random) const {
    static const test_support::TempDir folder;
    std::string text = "version = 1\n";
    for (int n = 0; n < kKinds; ++n) {
      const std::string name = "kind" + std::to_string(n);
      if (!std::filesystem::exists(folder / (name + ".obj"))) write_obj(kind(n), folder / (name + ".obj"));
      text += "[[model]]\nname = \"" + name + "\"\nfile = \"" + name + ".obj\"\n";
    }
    const double cosine = std::max(0.05, std::cos(middle.lat_deg * mars::kRadiansPerDegree));
    for (int n = 0; n < 400; ++n) {
      char line[400];
      std::snprintf(
          line, sizeof line,
          "[[object]]\nmodel = \"kind%d\"\nlon = %.6f\nlat = %.6f\nheading = %.2f\npitch = %.2f\nscale = %.1f\n"
          "height = %.1f\nalign = \"%s\"\n",
          n % kKinds, middle.lon_deg + random.uniform(-3, 3) / cosine,
          std::clamp(middle.lat_deg + random.uniform(-3, 3), -89.99, 89.99), random.uniform(0, 360),
          random.uniform(-20, 20), random.log_uniform(500, 12'000), n % 7 == 0 ? 3000.0 : 0.0,
          n % 2 == 0 ? "slope" : "vertical");
      text += line;
    }
    const std::filesystem::path file = folder / "a.scene.toml";
    std::ofstream(file) << text;
    return file.string();
  }

  core::DrawRequest any_request(Random& random) const {
    const mars::LonLat place{random.uniform(-180, 180), random.uniform(-85, 85)};
    const double height_m = random.log_uniform(2'000, 300'000);
    const double ground_m = surface_.at(mars::direction(place)).height_m;
    const double down_deg = height_m > 50'000 ? random.uniform(-90, -25) : random.uniform(-30, 5);
    core::DrawRequest request =
        test_support::request_for({place.lon_deg, place.lat_deg, ground_m + height_m, random.uniform(0, 360),
                                   down_deg, random.uniform(-20, 20)},
                                  planet_->radius_m(), kWidth, kHeight);
    request.settings.smooth_edges = false;
    request.settings.lod_tolerance_px = 0.4;
    request.settings.scene = write_scene(place, random);
    return request;
  }

  void compare(int views) {
    std::printf("seed %u\n", kSeed);
    Random random(kSeed);
    double worst_share = 0;
    double all_share = 0;
    std::int64_t objects_drawn = 0;
    for (int n = 0; n < views; ++n) {
      const core::DrawRequest request = any_request(random);
      const core::DrawResult a = rays_->draw(request);
      const core::DrawResult b = triangles_->draw(request);
      ASSERT_TRUE(a.certificate.objects && b.certificate.objects);
      EXPECT_EQ(a.certificate.objects->geometric_error_m, 0);
      EXPECT_LE(b.certificate.objects->screen_space_error_px, request.settings.lod_tolerance_px);
      EXPECT_GE(b.certificate.shift_bound_px, b.certificate.objects->screen_space_error_px);
      objects_drawn += a.certificate.objects->drawn;
      const double share =
          0.5 * (missing_share(request, a.frame, b.frame) + missing_share(request, b.frame, a.frame));
      EXPECT_LE(share, 0.02) << n;
      worst_share = std::max(worst_share, share);
      all_share += share / views;
    }
    std::printf("%d views, %.0f objects a view; share of pixels more than a pixel off: %.5f, worst view %.5f\n",
                views, static_cast<double>(objects_drawn) / views, all_share, worst_share);
    EXPECT_GT(objects_drawn, 5 * views);
    EXPECT_LE(all_share, 0.005);
  }

  // Returns the share of one image's pixels whose range the other has nowhere within a pixel.
  static double missing_share(const core::DrawRequest& request, const core::Frame& is,
                              const core::Frame& other) {
    int missing = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        double low = std::numeric_limits<double>::infinity();
        double high = 0;
        for (int v = std::max(0, y - 1); v <= std::min(kHeight - 1, y + 1); ++v) {
          for (int u = std::max(0, x - 1); u <= std::min(kWidth - 1, x + 1); ++u) {
            const auto r = static_cast<double>(other.range_m[static_cast<std::size_t>(v * kWidth + u)]);
            low = std::min(low, r);
            high = std::max(high, r);
          }
        }
        const auto r = static_cast<double>(is.range_m[static_cast<std::size_t>(y * kWidth + x)]);
        if (std::isinf(r) && std::isinf(high)) continue;
        const double slack = 1 + 2 / core::focal_px(request.view);
        if (r < low / slack || r > high * slack) ++missing;
      }
    }
    return static_cast<double>(missing) / (kWidth * kHeight);
  }

  std::shared_ptr<const paging::PlanetFile> planet_;
  paging::Surface surface_;
  static std::unique_ptr<core::PixelRenderer> rays_;
  static std::unique_ptr<core::Renderer> triangles_;
};
std::unique_ptr<core::PixelRenderer> ObjectBackends::rays_;
std::unique_ptr<core::Renderer> ObjectBackends::triangles_;

TEST_F(ObjectBackends, ShowTheSame) { compare(8); }

class LongObjectBackends : public ObjectBackends {};

TEST_F(LongObjectBackends, ShowTheSameIn200Views) { compare(200); }

TEST_F(ObjectBackends, ALimitOfTrianglesMakesObjectsAsCoarseAsTheGround) {
  Random random(kSeed + 2);
  int coarser = 0;
  for (int n = 0; n < 6; ++n) {
    core::DrawRequest request = any_request(random);
    const core::DrawResult all = triangles_->draw(request);
    request.settings.lod_triangles = 500;
    const core::DrawResult few = triangles_->draw(request);
    ASSERT_TRUE(all.certificate.objects && few.certificate.objects);
    const double limit_px = std::max(few.certificate.screen_space_error_px, request.settings.lod_tolerance_px);
    EXPECT_LE(few.certificate.objects->screen_space_error_px, limit_px);
    EXPECT_GE(few.certificate.shift_bound_px, few.certificate.objects->screen_space_error_px);
    EXPECT_LE(all.certificate.objects->screen_space_error_px, request.settings.lod_tolerance_px);
    if (few.certificate.objects->screen_space_error_px > all.certificate.objects->screen_space_error_px)
      ++coarser;
  }
  EXPECT_GT(coarser, 2);
}

TEST_F(ObjectBackends, SinglePixelsAreThoseOfTheImage) {
  Random random(kSeed + 1);
  const core::DrawRequest request = any_request(random);
  const core::DrawResult all = rays_->draw(request);
  core::Frame frame = all.frame;
  std::vector<std::uint8_t> wanted(frame.colour.size(), 0);
  for (std::size_t n = 0; n < wanted.size(); n += 3) {
    wanted[n] = 1;
    frame.colour[n] = {};
    frame.range_m[n] = 0;
  }
  const std::vector<float> clear_m(wanted.size(), 0);
  rays_->draw_pixels(request, {wanted, clear_m}, frame);
  int different = 0;
  for (std::size_t n = 0; n < wanted.size(); ++n) different += frame.colour[n] == all.frame.colour[n] ? 0 : 1;
  EXPECT_LE(different, static_cast<int>(wanted.size()) / 500);  // rounding of single rays
}

TEST_F(ObjectBackends, RangesComeOnlyWhenTheyAreAskedFor) {
  Random random(kSeed + 2);
  core::DrawRequest request = any_request(random);
  request.want_range = false;
  EXPECT_TRUE(rays_->draw(request).frame.range_m.empty());
  EXPECT_TRUE(triangles_->draw(request).frame.range_m.empty());
  request.want_range = true;
  request.want_colour = false;
  const core::DrawResult a = rays_->draw(request);
  const core::DrawResult b = triangles_->draw(request);
  EXPECT_TRUE(a.frame.colour.empty());
  EXPECT_TRUE(b.frame.colour.empty());
  EXPECT_LE(missing_share(request, a.frame, b.frame), 0.02);
  request.settings.scene.clear();
  EXPECT_NE(rays_->draw(request).frame.range_m, a.frame.range_m);
}

}  // namespace
