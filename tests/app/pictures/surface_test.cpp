// vpe surface: files of surfaces, their maps, images and ranges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "paging/surface/surface.h"
#include "relief/cast/caster.h"
#include "tests/app/support/app_fixture.h"
#include "vpe/app/surface/surface_image.h"
#include "vpe/app/surface/surface_maps.h"
#include "vpe/app/surface/surface_scene.h"
#include "vpe/app/surface/surface_view.h"
#include "vpe/core/image/image.h"

namespace app_test {
namespace {

namespace core = vpe::core;
using vpe::app::open_surface;
using vpe::app::SurfaceScene;

constexpr double kA_m = 13000;
constexpr double kB_m = 11400;
constexpr double kC_m = 9100;

std::string egg(const std::string& more) {
  return "version = 1\n" + more + "[base]\nkind = \"ellipsoid\"\nsemi_axes_m = [13000, 11400, 9100]\n";
}

double egg_radius_m(const glm::dvec3& d) {
  return 1 / std::sqrt(d.x * d.x / (kA_m * kA_m) + d.y * d.y / (kB_m * kB_m) + d.z * d.z / (kC_m * kC_m));
}

// The closed form: the smaller root of |o + s d|^2 = r^2; infinity without one.
double ball_range_m(const glm::dvec3& o_m, const glm::dvec3& d, double r_m) {
  const double b = glm::dot(o_m, d);
  const double disc = b * b - glm::dot(o_m, o_m) + r_m * r_m;
  return disc < 0 ? std::numeric_limits<double>::infinity() : -b - std::sqrt(disc);
}

class SurfaceCommand : public AppTest {
 protected:
  SurfaceScene open(const std::string& text) const {
    write_text(dir_ / "s.surface.toml", text);
    return open_surface(dir_ / "s.surface.toml");
  }

  // Writes a raster of the whole body.
  void write_globe(const std::string& name, const std::function<double(double lon_deg, double lat_deg)>& value,
                   std::optional<double> no_data = std::nullopt) const {
    Dem dem;
    dem.radius_m = kA_m;
    dem.no_data = no_data;
    dem.height_m = [&value](int column, int row) { return value(-179 + 2 * column, 89 - 2 * row); };
    write_dem(dir_ / name, dem);
  }

  // Writes a raster without georeference, one value for each pixel.
  void write_grid(const std::string& name, int width, int height,
                  const std::function<double(int column, int row)>& value) const {
    Dem dem;
    dem.width = width;
    dem.height = height;
    dem.georeference = false;
    dem.height_m = value;
    write_dem(dir_ / name, dem);
  }

  static double height_above(const SurfaceScene& scene, const glm::dvec3& from_m, const glm::dvec3& direction) {
    const double range_m = relief::cast_ray(scene.surface, from_m, direction);
    EXPECT_LT(range_m, relief::kNoHit);
    return scene.surface.base().height_m(from_m + range_m * direction);
  }

  // Returns the height of the ground below a direction, as a ray towards the centre finds it.
  static double height_m(const SurfaceScene& scene, const glm::dvec3& direction) {
    return height_above(scene, 50'000.0 * direction, -direction);
  }
};

TEST_F(SurfaceCommand, ABareBaseIsItsClosedForm) {
  const SurfaceScene scene = open(egg(""));
  EXPECT_TRUE(scene.is_round);
  EXPECT_EQ(scene.radius_m, kA_m);
  EXPECT_EQ(scene.posts, 0U);
  test_support::Random random(1);
  for (int n = 0; n < 300; ++n) {
    const glm::dvec3 d = random.direction();
    EXPECT_NEAR(relief::cast_ray(scene.surface, 50'000.0 * d, -d), 50'000 - egg_radius_m(d), 1e-6);
  }
}

// Heights above the base that undo its shape: a ball described on an ellipsoid is that ball.
TEST_F(SurfaceCommand, RadiiOnAnEllipsoidAreTheirBall) {
  constexpr double kBall_m = 11'000;
  write_globe("r.tif", [](double, double) { return 11; });
  const SurfaceScene scene =
      open(egg("") + "[[map]]\nfile = \"r.tif\"\nheights = \"radius\"\nscale = 1000\nposts = 257\n");
  EXPECT_EQ(scene.posts, 6U * 259 * 259);
  EXPECT_LT(scene.facet_deviation_m, 5);
  test_support::Random random(2);
  double most_m = 0;
  for (int n = 0; n < 500; ++n) {
    const glm::dvec3 from_m = 40'000.0 * random.direction();
    const glm::dvec3 d = glm::normalize(9'000.0 * random.direction() - from_m);
    const double expected_m = ball_range_m(from_m, d, kBall_m);
    const double found_m = relief::cast_ray(scene.surface, from_m, d);
    ASSERT_EQ(found_m < relief::kNoHit, std::isfinite(expected_m));
    if (std::isfinite(expected_m))
      most_m = std::max(most_m, std::abs(glm::length(from_m + found_m * d) - kBall_m));
  }
  // Posts are 100 m apart, so bicubic patches between them are within millimetres, and floats of heights in some tenths of one.
  EXPECT_LT(most_m, 0.005);
}

TEST_F(SurfaceCommand, FacesMeetInTheSameGround) {
  write_globe("h.tif",
              [](double lon_deg, double lat_deg) { return 300 * std::sin(lon_deg / 7) + 9 * lat_deg; });
  for (const char* interpolation : {"bilinear", "bicubic"}) {
    write_text(dir_ / "s.surface.toml",
               egg("") + "[[map]]\nfile = \"h.tif\"\nposts = 40\ninterpolation = \"" + interpolation + "\"\n");
    const relief::SurfaceFile file = relief::read_surface_file(dir_ / "s.surface.toml");
    const vpe::app::FaceMaps maps = vpe::app::face_maps(file.maps.front(), file);
    test_support::Random random(3);
    for (int n = 0; n < 3000; ++n) {
      // A point of an edge of the cube, and its two faces.
      glm::dvec3 p{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      const int along = random.integer(0, 2);
      for (int k = 0; k < 3; ++k)
        if (k != along) p[k] = p[k] < 0 ? -1 : 1;
      std::vector<double> heights_m;
      for (int face = 0; face < mars::kFaces; ++face) {
        const mars::FaceAxes& axes = mars::face_axes(static_cast<mars::Face>(face));
        if (glm::dot(axes.out, p) < 1) continue;
        heights_m.push_back(maps[static_cast<std::size_t>(face)]->height_m(
            file.radius_m * glm::dot(axes.right, p), file.radius_m * glm::dot(axes.up, p)));
      }
      ASSERT_EQ(heights_m.size(), 2U);
      EXPECT_NEAR(heights_m[0], heights_m[1], 1e-8) << interpolation;
    }
  }
}

TEST_F(SurfaceCommand, PlanetFilesAreMapsToo) {
  const auto file = paging::PlanetFile::open(planet().string());
  const paging::Surface surface(file, std::size_t{1} << 22);
  const std::string base =
      "version = 1\n[base]\nkind = \"sphere\"\nradius_m = " + std::to_string(file->radius_m()) + "\n";
  const std::string map = "[[map]]\nfile = \"" + planet().string() + "\"\nposts = 129\n";
  const SurfaceScene above = open(base + map);
  const SurfaceScene radii = open(base + map + "heights = \"radius\"\n");
  test_support::Random random(4);
  for (int n = 0; n < 100; ++n) {
    const glm::dvec3 d = random.direction();
    const double expected_m = surface.at(d).height_m;
    const double found_m = height_above(above, 5e6 * d, -d);
    // The planet's facets have diagonals of 59 km, whose middles lie 130 m below the arc; patches lie between the posts' heights.
    EXPECT_NEAR(found_m, expected_m, 140) << n;
    EXPECT_NEAR(height_above(radii, 5e6 * d, -d), found_m, 1e-3);
  }
}

TEST_F(SurfaceCommand, RowsOfPlanesBeginAtTheLargestY) {
  write_grid("p.tif", 5, 3, [](int column, int row) { return 10 * row + column; });
  const SurfaceScene scene = open(
      "version = 1\n[base]\nkind = \"plane\"\nsize_m = [40, 20]\n[[map]]\nfile = \"p.tif\"\ninterpolation = \"bilinear\"\n");
  EXPECT_FALSE(scene.is_round);
  const auto at = [&](double x_m, double y_m) { return height_above(scene, {x_m, y_m, 100}, {0, 0, -1}); };
  EXPECT_NEAR(at(-20, 10), 0, 1e-9);
  EXPECT_NEAR(at(20, 10), 4, 1e-9);
  EXPECT_NEAR(at(-20, -10), 20, 1e-9);
  EXPECT_NEAR(at(15, -5), 18.5, 1e-9);
  // Beyond its sides there is nothing.
  EXPECT_EQ(relief::cast_ray(scene.surface, {20.1, 0, 100}, {0, 0, -1}), relief::kNoHit);
}

TEST_F(SurfaceCommand, MapsAreComposedInTheirOrder) {
  write_grid("flat.tif", 9, 9, [](int, int) { return 5; });
  write_grid("ramp.tif", 9, 9, [](int column, int) { return column; });
  write_grid("half.tif", 9, 9, [](int column, int) { return column < 4 ? 0 : 1; });
  const std::string plane = "version = 1\n[base]\nkind = \"plane\"\nsize_m = [8, 8]\n";
  const auto map = [](const std::string& name, const std::string& more) {
    return "[[map]]\nfile = \"" + name + "\"\ninterpolation = \"bilinear\"\n" + more;
  };
  const auto at = [&](const SurfaceScene& scene, double x_m) {
    return height_above(scene, {x_m, 0.3, 100}, {0, 0, -1});
  };
  const SurfaceScene sum = open(plane + map("flat.tif", "") + map("ramp.tif", "scale = 2\n"));
  EXPECT_NEAR(at(sum, 1.5), 5 + 2 * 5.5, 1e-6);
  const SurfaceScene most = open(plane + map("flat.tif", "") + map("ramp.tif", "compose = \"max\"\n"));
  EXPECT_NEAR(at(most, -2), 5, 1e-6);
  EXPECT_NEAR(at(most, 3), 7, 1e-6);
  const SurfaceScene part =
      open(plane + map("flat.tif", "") + map("ramp.tif", "compose = \"replace\"\nmask = \"half.tif\"\n"));
  EXPECT_NEAR(at(part, -2), 5, 1e-6);
  EXPECT_NEAR(at(part, 3), 7, 1e-6);
}

TEST_F(SurfaceCommand, AQuadricCarriesAMap) {
  write_grid("p.tif", 3, 3, [](int, int) { return 2; });
  const SurfaceScene scene = open(
      "version = 1\n[base]\nkind = \"quadric\"\nsize_m = [100, 100]\nmatrix = [[-0.005, 0, 0], [0, -0.005, 0], [0, 0, 0]]\n"
      "linear = [0, 0, 0.5]\n[[map]]\nfile = \"p.tif\"\n");
  for (const double x_m : {0.0, 10.0, -30.0}) {
    const double range_m = relief::cast_ray(scene.surface, {x_m, 0, 500}, {0, 0, -1});
    EXPECT_NEAR(500 - range_m, x_m * x_m / 200 + 2, 1e-6);
  }
  EXPECT_NEAR(scene.middle_m.x, 0, 1e-9);
  EXPECT_GT(scene.radius_m, 65);
  write_text(dir_ / "none.surface.toml",
             "version = 1\n[base]\nkind = \"quadric\"\nsize_m = [10, 10]\nconstant = 5\n"
             "matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\nanchor_m = [1, 0, 0]\n");
  expect_failure({"surface", "none.surface.toml", "-o", "x.png"}, 1,
                 {"none.surface.toml", "no ground over its size_m"});
}

TEST_F(SurfaceCommand, ReliefsLieOnABody) {
  write_globe("h.tif", [](double, double) { return 100; });
  write_text(
      dir_ / "c.relief.toml",
      "version = 1\n[[relief]]\nkind = \"crater\"\nlon = 20\nlat = 10\nradius_m = 800\ndepth_m = 300\nrim_m = 50\n"
      "[[relief]]\nkind = \"pad\"\nlon = -90\nlat = 0\nradius_m = 500\nlevel_m = 700\n");
  const SurfaceScene scene = open(egg("reliefs = \"c.relief.toml\"\n") + "[[map]]\nfile = \"h.tif\"\n");
  EXPECT_EQ(scene.reliefs, 2U);
  EXPECT_GE(scene.posts, 6U * 1027 * 1027);
  EXPECT_NEAR(height_m(scene, mars::direction({20, 10})), 100 + 50 - 300, 0.5);
  EXPECT_NEAR(height_m(scene, mars::direction({-90, 0})), 700, 0.01);
  EXPECT_NEAR(height_m(scene, mars::direction({120, -40})), 100, 0.01);
  // The crest lies at its radius, on the sphere with the body's radius there.
  const mars::LonLat place{20, 10};
  const double angle_rad = 800 / egg_radius_m(mars::direction(place));
  // Posts are 25 m apart, and the crest is an edge between slopes of 0.75 and -0.19.
  EXPECT_NEAR(height_m(scene, mars::direction(mars::destination(place, 90, angle_rad))), 150, 7);
}

// Posts of reliefs beside a face may lie beyond the map's own ring: they take the ground of the next face.
TEST_F(SurfaceCommand, ReliefsMayBeCoarserThanMaps) {
  write_globe("h.tif", [](double, double) { return 100; });
  write_text(dir_ / "c.relief.toml",
             "version = 1\n[[relief]]\nkind = \"crater\"\nlon = 0\nlat = 0\nradius_m = 800\n");
  const SurfaceScene scene = open(egg("reliefs = \"c.relief.toml\"\nrelief_posts = 65\n") +
                                  "[[map]]\nfile = \"h.tif\"\nposts = 257\n");
  for (const double lon_deg : {44.3, 44.9, 45.2, 45.8})
    EXPECT_NEAR(height_m(scene, mars::direction({lon_deg, 11.3})), 100, 0.01) << lon_deg;
}

TEST_F(SurfaceCommand, NodataIsFilledOrAnError) {
  write_globe(
      "h.tif", [](double lon_deg, double) { return lon_deg > 0 ? 100 : -9; }, -9);
  write_text(dir_ / "s.surface.toml", egg("") + "[[map]]\nfile = \"h.tif\"\n");
  expect_failure({"surface", "s.surface.toml", "-o", "x.png"}, 1,
                 {"h.tif", "has no data at longitude", "fill_m"});
  const SurfaceScene scene = open(egg("") + "[[map]]\nfile = \"h.tif\"\nfill_m = 40\n");
  EXPECT_NEAR(height_m(scene, mars::direction({90, 10})), 100, 0.01);
  EXPECT_NEAR(height_m(scene, mars::direction({-90, 10})), 40, 0.01);
  write_grid("one.tif", 1, 4, [](int, int) { return 2; });
  write_text(dir_ / "s.surface.toml",
             "version = 1\n[base]\nkind = \"plane\"\nsize_m = [1, 1]\n[[map]]\nfile = \"one.tif\"\n");
  expect_failure({"surface", "s.surface.toml", "-o", "x.png"}, 1, {"one.tif", "needs two on each side"});
}

// A hill east of the middle of the view is nearer, and on the right.
TEST_F(SurfaceCommand, DrawsEastOnTheRightAndNorthUp) {
  write_globe("h.tif", [](double lon_deg, double lat_deg) {
    return 2000 * std::exp(-((lon_deg - 15) * (lon_deg - 15) + (lat_deg - 10) * (lat_deg - 10)) / 60);
  });
  write_text(dir_ / "s.surface.toml",
             "version = 1\n[base]\nkind = \"sphere\"\nradius_m = 13000\n[[map]]\nfile = \"h.tif\"\n");
  const Result drawn = vpe({"surface", "s.surface.toml", "--from", "0,0", "--size", "90x60", "--sun", "25,60",
                            "-o", "x.png", "--range", "x.tif", "--json"});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  const auto json = parse_json(drawn.out);
  EXPECT_GT(json["share_of_ground"].get<double>(), 0.3);
  EXPECT_NEAR(json["height_m"][1].get<double>(), 2000, 60);
  EXPECT_GT(json["camera_m"][0].get<double>(), 15000);
  EXPECT_NEAR(json["camera_m"][1].get<double>(), 0, 1e-6);
  const core::FloatImage ranges = core::read_tiff(dir_ / "x.tif");
  const core::RgbImage image = core::read_image(dir_ / "x.png");
  ASSERT_EQ(ranges.width, 90);
  ASSERT_EQ(image.height, 60);
  const auto nearest = std::min_element(ranges.pixels.begin(), ranges.pixels.end()) - ranges.pixels.begin();
  EXPECT_GT(nearest % 90, 48);
  EXPECT_LT(nearest % 90, 62);
  EXPECT_LT(nearest / 90, 28);
  EXPECT_TRUE(std::isinf(ranges.pixels.front()));
  EXPECT_EQ(image.pixels.front(), (vpe::base::Rgb{0, 0, 0}));
  // The sun stands over the north, so the north is brighter.
  EXPECT_GT(image.pixels[15 * 90 + 45].g, image.pixels[45 * 90 + 45].g + 40);
}

TEST_F(SurfaceCommand, HillsCastShadows) {
  write_grid("p.tif", 41, 41,
             [](int column, int row) { return column == 20 && std::abs(row - 20) < 8 ? 6 : 0; });
  write_text(dir_ / "s.surface.toml",
             "version = 1\n[base]\nkind = \"plane\"\nsize_m = [40, 40]\n[[map]]\nfile = \"p.tif\"\n"
             "interpolation = \"bilinear\"\n");
  // From above, with y up in the image and the sun in the east.
  const Words words{"surface", "s.surface.toml", "--from", "0,90,100", "--fov",
                    "20",      "--size",         "60x60",  "--sun",    "0,45"};
  const auto draw = [&](const std::string& output, const Words& more) {
    Words all = words;
    all.insert(all.end(), {"-o", output});
    all.insert(all.end(), more.begin(), more.end());
    const Result drawn = vpe(all);
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
    return core::read_image(dir_ / output);
  };
  const core::RgbImage lit = draw("a.png", {});
  const core::RgbImage bare = draw("b.png", {"--no-shadows"});
  const auto grey = [](const core::RgbImage& image, int x, int y) {
    return int{image.pixels[static_cast<std::size_t>(y * image.width + x)].g};
  };
  // 3 m west of the wall of 6 m lies in its shadow, 3 m east of it in the light.
  EXPECT_LT(grey(lit, 25, 30), grey(lit, 35, 30) - 60);
  EXPECT_EQ(grey(bare, 25, 30), grey(bare, 35, 30));
  EXPECT_EQ(grey(lit, 35, 30), grey(bare, 35, 30));
  EXPECT_NE(draw("c.png", {"--palette", "viridis"}).pixels, lit.pixels);
  EXPECT_EQ(draw("d.png", {"--threads", "1"}).pixels, lit.pixels);
}

TEST_F(SurfaceCommand, RefusesWhatItCannotDraw) {
  write_text(dir_ / "s.surface.toml", egg(""));
  const auto fails = [&](const Words& more, int code, const Words& parts) {
    Words all{"surface", "s.surface.toml", "-o", "x.png"};
    all.insert(all.end(), more.begin(), more.end());
    expect_failure(all, code, parts);
  };
  fails({"--from", "1,2,3,4"}, 2, {"--from 1,2,3,4", "LON,LAT,RANGE"});
  fails({"--from", "1,95"}, 2, {"--from 1,95", "-90 to 90"});
  fails({"--from", "1,2,-3"}, 2, {"--from", "above 0"});
  fails({"--from", "1,2", "--camera", "1,2,3"}, 2, {"--from and --camera"});
  fails({"--camera", "1,2"}, 2, {"--camera 1,2", "X,Y,Z"});
  fails({"--camera", "1e16,2,0"}, 2, {"--camera", "farther than"});
  fails({"--camera", "20000,0,0", "--target", "20000,0,0"}, 2, {"at its target"});
  fails({"--camera", "0,9000,0"}, 1, {"2400 m below the ground"});
  fails({"--sun", "east"}, 2, {"--sun east", "LON,LAT"});
  fails({"--palette", "none-such"}, 2, {"--palette", "none-such"});
  fails({"--samples", "9"}, 2, {"--samples"});
  fails({"--samples", "8", "--size", "4000x4000"}, 2, {"--samples 8", "fewer samples"});
  fails({"--range", "x.jpg"}, 1, {"x.jpg"});
  expect_failure({"surface", "s.surface.toml", "-o", "s.surface.toml"}, 1, {"s.surface.toml"});
  expect_failure({"surface", "s.surface.toml"}, 2, {"--output"});
  expect_failure({"surface", "none.surface.toml", "-o", "x.png"}, 1, {"none.surface.toml"});
  write_text(dir_ / "s.surface.toml", egg("") + "[[map]]\nfile = \"none.tif\"\n");
  fails({}, 1, {"none.tif"});
  EXPECT_FALSE(exists("x.png"));
}

TEST(SurfaceView, TheWholeSurfaceIsInTheImage) {
  for (const char* size : {"300x200", "200x300"}) {
    vpe::app::SurfaceViewArguments arguments;
    arguments.size = size;
    arguments.from = "40,-30";
    const SurfaceScene scene{
        relief::cube_surface(relief::Base::sphere({0, 0, 0}, 100), 100, {}), true, {0, 0, 0}, 100, 0, 0, 0};
    const core::View view = vpe::app::resolve_view(vpe::app::parse_surface_view(arguments), scene);
    EXPECT_NEAR(glm::dot(glm::normalize(view.camera.position_m), mars::direction({40, -30})), 1, 1e-12);
    vpe::base::ThreadPool pool(2);
    const std::vector<float> ranges_m = vpe::app::surface_ranges(scene.surface, view, 0, pool);
    const auto hit = [&](int x, int y) {
      return std::isfinite(ranges_m[static_cast<std::size_t>(y * view.width + x)]);
    };
    EXPECT_TRUE(hit(view.width / 2, view.height / 2));
    int border = 0;
    for (int x = 0; x < view.width; ++x) border += hit(x, 0) + hit(x, view.height - 1);
    for (int y = 0; y < view.height; ++y) border += hit(0, y) + hit(view.width - 1, y);
    EXPECT_EQ(border, 0);
    // It fills the narrow side but for a margin.
    const int narrow = std::min(view.width, view.height) / 2;
    EXPECT_TRUE(hit(view.width / 2 + 9 * narrow / 10, view.height / 2) || view.width > view.height);
    EXPECT_TRUE(hit(view.width / 2, view.height / 2 + 9 * narrow / 10) || view.height > view.width);
  }
}

TEST(SurfaceImages, SamplesAreWithinTheirLimits) {
  const relief::Surface ball = relief::cube_surface(relief::Base::sphere({0, 0, 0}, 100), 100, {});
  core::View view;
  view.camera.position_m = {300, 0, 0};
  view.camera.axes = {{0, 1, 0}, {0, 0, 1}, {-1, 0, 0}};
  view.width = 40;
  view.height = 30;
  vpe::base::ThreadPool pool(1);
  vpe::app::SurfaceImageOptions options;
  options.towards_sun = {1, 0, 0};
  options.samples = 0;
  EXPECT_THROW(draw_surface(ball, view, options, pool), std::invalid_argument);
  options.samples = 1;
  const vpe::app::SurfaceImage coarse = draw_surface(ball, view, options, pool);
  EXPECT_EQ(coarse.rays, 40U * 30U);
  EXPECT_NEAR(coarse.least_range_m, 200, 0.5);  // half a pixel beside the nearest point
  options.samples = 3;
  const vpe::app::SurfaceImage fine = draw_surface(ball, view, options, pool);
  EXPECT_EQ(fine.rays, 9 * coarse.rays);
  EXPECT_NEAR(static_cast<double>(fine.hits) / 9, static_cast<double>(coarse.hits), 20);
  // Only smoothed pixels are darker than the darkest ground, and no space.
  int darkest = 255;
  for (const vpe::base::Rgb& c : coarse.colours.pixels)
    if (c.g > 0) darkest = std::min(darkest, int{c.g});
  EXPECT_GT(std::ranges::count_if(fine.colours.pixels,
                                  [&](const vpe::base::Rgb& c) { return c.g > 0 && c.g < darkest; }),
            5);
}

}  // namespace
}  // namespace app_test
