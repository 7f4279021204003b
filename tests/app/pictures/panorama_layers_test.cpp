// overlay.layers over panoramas: vector files on the ground, as each eye sees it.
#include <cmath>
#include <glm/geometric.hpp>

#include "paging/planet/planet_file.h"
#include "paging/surface/surface.h"
#include "panorama/metadata/open_panorama.h"
#include "tests/app/support/app_fixture.h"
#include "tests/panorama/stereo_fixture.h"
#include "vpe/core/appearance/overlays.h"
#include "vpe/core/image/image.h"
#include "vpe/core/stereo.h"

namespace app_test {
namespace {

using panorama::Eye;
using vpe::core::read_image;
using vpe::core::RgbImage;

constexpr double kHeight_m = 30e3;

// A ring about the camera at 10, 5, an area in the north with a hole, a point in the east.
constexpr char kThings[] = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"stroke": "#ff00ff", "stroke-width": 10, "legend": "Ring"},
   "geometry": {"type": "LineString", "coordinates": [[11.5, 5], [10.9, 6], [9.2, 6.1], [8.4, 4.8], [9.5, 3.9], [11.5, 5]]}},
  {"type": "Feature", "properties": {"stroke-opacity": 0, "fill": "#00ff00", "fill-opacity": 1, "legend": "Unit"},
   "geometry": {"type": "Polygon", "coordinates": [[[9, 6.5], [11, 6.5], [11, 8], [9, 8], [9, 6.5]],
                                                   [[9.7, 6.9], [10.3, 6.9], [10.3, 7.5], [9.7, 7.5], [9.7, 6.9]]]}},
  {"type": "Feature", "properties": {"marker-color": "#ffff00", "marker-size": 30},
   "geometry": {"type": "Point", "coordinates": [11, 4.6]}}]})";

class PanoramaLayers : public AppTest {
 protected:
  void SetUp() override {
    if (!vpe::core::overlays_refused().empty()) GTEST_SKIP() << vpe::core::overlays_refused();
    write_text(dir_ / "things.geojson", kThings);
  }
  static Words with(Words more, const Words& and_these) {
    more.insert(more.end(), and_these.begin(), and_these.end());
    return more;
  }
  static Words layers() { return {"--set", "overlay.layers=things.geojson"}; }
  Words words(const std::string& output, const Words& more) const {
    return with({"panorama", planet().string(), "--at", "10,5", "--height", std::to_string(kHeight_m),
                 "--width", "1024", "--elevation=-60,20", "--set", "samples=1", "-o", output, "-q"},
                more);
  }
  RgbImage make(const std::string& output, const Words& more) const {
    const Result result = vpe(words(output, more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_image(dir_ / output);
  }
};

vpe::base::Rgb pixel(const RgbImage& image, double x, double y) {
  return image.pixels.at(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(x));
}

bool is_near(const RgbImage& image, glm::dvec2 at, const vpe::base::Rgb& colour) {
  for (double y = at.y - 1; y <= at.y + 1; ++y) {
    for (double x = at.x - 1; x <= at.x + 1; ++x) {
      if (x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
      const vpe::base::Rgb p = pixel(image, x, y);
      if (std::abs(p.r - colour.r) + std::abs(p.g - colour.g) + std::abs(p.b - colour.b) < 120) return true;
    }
  }
  return false;
}

// Places of the test's ground, as an eye sees them.
struct Ground {
  std::shared_ptr<const paging::PlanetFile> planet;
  paging::Surface surface;
  mars::Pose pose;
  explicit Ground(const std::filesystem::path& file)
      : planet(paging::PlanetFile::open(file.string())), surface(planet, std::size_t{16} << 20) {
    pose = {10, 5, surface.at(mars::direction({10, 5})).height_m + kHeight_m, 0, 0, 0};
  }
  glm::dvec3 point(glm::dvec2 place) const {
    const glm::dvec3 up = mars::direction({place.x, place.y});
    return up * surface.at(up).radius_m;
  }
  bool is_seen(const glm::dvec3& from_m, const glm::dvec3& point_m, double share) const {
    const glm::dvec3 along = point_m - from_m;
    return surface.cast(from_m, glm::normalize(along)) > (1 - share) * glm::length(along);
  }
};

constexpr vpe::base::Rgb kRing{255, 0, 255};

// Checks dense places of the ring in one eye's image. Returns how many are seen.
int check_ring(const Ground& ground, const RgbImage& image, const panorama::PanoramaMap& map,
               const test_support::TwoEyes& eyes, Eye eye, double base_m) {
  const std::vector<glm::dvec2> ring{{11.5, 5}, {10.9, 6}, {9.2, 6.1}, {8.4, 4.8}, {9.5, 3.9}, {11.5, 5}};
  int seen = 0;
  for (std::size_t i = 1; i < ring.size(); ++i) {
    for (int n = 0; n < 400; ++n) {
      const glm::dvec3 point_m = ground.point(ring[i - 1] + (ring[i] - ring[i - 1]) * (n / 400.0));
      const panorama::Direction direction = eyes.seen(eye, point_m);
      const auto at = map.to_pixel(direction);
      if (!at) continue;
      const glm::dvec3 from_m = eyes.ray(eye, direction).camera_m;
      if (!ground.is_seen(from_m, point_m, 1e-5)) continue;
      ++seen;
      EXPECT_TRUE(is_near(image, *at, kRing)) << at->x << ", " << at->y << " base " << base_m;
      if (testing::Test::HasFailure()) return seen;
    }
  }
  return seen;
}

TEST_F(PanoramaLayers, LieOnTheGroundInEveryProjection) {
  const Ground ground(planet());
  const test_support::TwoEyes eyes(ground.pose, ground.surface.planet_radius_m(), 0);
  for (const Words& kind :
       {Words{"--projection", "cylinder"}, Words{"--projection", "equirectangular"},
        Words{"--projection", "facets", "--facets", "5"}, Words{"--from", "300", "--to", "140"},
        Words{"--backend", "polygon", "--projection", "facets"}}) {
    const Words turned = kind.front() == "--from" ? kind : with(kind, {"--yaw", "33"});
    const RgbImage plain = make("plain.png", turned);
    const RgbImage image = make("layers.png", with(turned, layers()));
    const panorama::PanoramaMap map = panorama::describe(dir_ / "layers.png").map;
    EXPECT_GT(check_ring(ground, image, map, eyes, Eye::kLeft, 0), 500) << kind[1];
    // Areas: inside, in the hole, beside.
    const auto at = [&](glm::dvec2 place) { return map.to_pixel(eyes.seen(Eye::kLeft, ground.point(place))); };
    for (const glm::dvec2 place : {glm::dvec2{9.3, 7.2}, glm::dvec2{10.7, 7}, glm::dvec2{10, 6.7}}) {
      const auto p = at(place);
      ASSERT_TRUE(p);
      if (ground.is_seen(mars::to_camera(ground.pose, ground.surface.planet_radius_m()).position_m,
                         ground.point(place), 1e-4)) {
        EXPECT_EQ(pixel(image, p->x, p->y).g, 255) << kind[1] << place.x;
        EXPECT_EQ(pixel(image, p->x, p->y).r, 0) << kind[1] << place.x;
      }
    }
    for (const glm::dvec2 place : {glm::dvec2{10, 7.2}, glm::dvec2{8.7, 7}}) {
      const auto p = at(place);
      ASSERT_TRUE(p);
      EXPECT_EQ(pixel(image, p->x, p->y), pixel(plain, p->x, p->y)) << kind[1] << place.x;
    }
    const auto point = at({11, 4.6});
    ASSERT_TRUE(point);
    EXPECT_EQ(pixel(image, point->x, point->y).r, 255) << kind[1];
    EXPECT_EQ(pixel(image, point->x, point->y).b, 0) << kind[1];
  }
}

TEST_F(PanoramaLayers, LieWhereEachEyeSeesTheGround) {
  const Ground ground(planet());
  const double base_m = 3000;
  const test_support::TwoEyes eyes(ground.pose, ground.surface.planet_radius_m(), base_m);
  for (const Words& method : {Words{}, Words{"--stereo-method", "reproject"}}) {
    const Words pair = with(with(method, layers()), {"--eye-base", "3000"});
    const RgbImage below = make("ou.png", with(pair, {"--stereo", "ou"}));
    const panorama::PanoramaMap map = panorama::describe(dir_ / "ou.png").map;
    const int height = below.height / 2;
    const auto half = [&](int first) {
      RgbImage image{below.width, height, {}};
      image.pixels.assign(below.pixels.begin() + first * below.width * height,
                          below.pixels.begin() + (first + 1) * below.width * height);
      return image;
    };
    const RgbImage left = half(0);
    const RgbImage right = half(1);
    EXPECT_GT(check_ring(ground, left, map, eyes, Eye::kLeft, base_m), 500);
    EXPECT_GT(check_ring(ground, right, map, eyes, Eye::kRight, base_m), 500);
    for (const auto& [image, eye] : {std::pair(&left, Eye::kLeft), std::pair(&right, Eye::kRight)}) {
      const auto p = map.to_pixel(eyes.seen(eye, ground.point({9.3, 7.2})));
      ASSERT_TRUE(p);
      EXPECT_GT(pixel(*image, p->x, p->y).g, 250);
    }
    // The other arrangements have the same pixels.
    const RgbImage beside = make("sbs.png", with(pair, {"--stereo", "sbs"}));
    ASSERT_EQ(beside.width, 2 * left.width);
    std::size_t differing = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < left.width; ++x) {
        differing += pixel(beside, x, y) != pixel(left, x, y);
        differing += pixel(beside, x + left.width, y) != pixel(right, x, y);
      }
    }
    EXPECT_EQ(differing, 0U);
    const RgbImage mixed = make("mixed.png", with(pair, {"--stereo", "anaglyph"}));
    EXPECT_EQ(mixed.pixels, vpe::core::combine_stereo(left, right, vpe::core::StereoLayout::kAnaglyph).pixels);
  }
}

TEST_F(PanoramaLayers, LegendsAndLabelsStandInTheImage) {
  const RgbImage without = make("a.png", layers());
  const RgbImage with_legend = make("b.png", with(layers(), {"--set", "overlay.layers.legend=on"}));
  std::size_t differing = 0;
  for (std::size_t n = 0; n < without.pixels.size(); ++n) {
    if (without.pixels[n] == with_legend.pixels[n]) continue;
    ++differing;
    EXPECT_LT(n % static_cast<std::size_t>(without.width), 300U);
  }
  EXPECT_GT(differing, 1000U);
}

TEST_F(PanoramaLayers, ARecipeRefusesChangedFiles) {
  make("a.png", layers());
  const std::string bytes = read_text(dir_ / "a.png");
  const Result again = vpe({"panorama", "--from-sidecar", "a.json", "-o", "b.png", "-q"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read_text(dir_ / "b.png"), bytes);
  std::string changed = kThings;
  changed.replace(changed.find("#ff00ff"), 7, "#ff0000");
  write_text(dir_ / "things.geojson", changed);
  expect_failure({"panorama", "--from-sidecar", "a.json", "-o", "c.png", "-q"}, 1,
                 {"things.geojson", "has changed", "overlay.layers"});
  EXPECT_FALSE(exists("c.png"));
}

TEST_F(PanoramaLayers, ThreadsAndMemoryChangeNoByte) {
  make("a.png", with(layers(), {"--threads", "1"}));
  make("b.png", with(layers(), {"--threads", "4", "--memory", "256"}));
  EXPECT_EQ(read_image(dir_ / "a.png").pixels, read_image(dir_ / "b.png").pixels);
}

TEST_F(PanoramaLayers, WrongFilesAreReportedBeforeAnyWork) {
  write_text(dir_ / "bad.geojson", "hello");
  expect_failure(words("x.png", {"--set", "overlay.layers=bad.geojson"}), 1, {"bad.geojson"});
  EXPECT_FALSE(exists("x.png"));
}

}  // namespace
}  // namespace app_test
