// Files of surfaces.
#include "relief/files/surface_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>
#include <string>

#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace relief {
namespace {

SurfaceFile parse(const std::string& text) {
  return parse_surface_toml("version = 1\n" + text, "in/a.surface.toml");
}

// Returns what is wrong with a text after its first line, or "".
std::string error_of(const std::string& text) {
  try {
    (void)parse(text);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

TEST(SurfaceFiles, BasesAreThoseOfTheirKeys) {
  const SurfaceFile ball = parse("[base]\nkind = \"sphere\"\nradius_m = 50\n");
  EXPECT_EQ(ball.base.kind(), Base::Kind::kSphere);
  EXPECT_EQ(ball.radius_m, 50);
  EXPECT_NEAR(ball.base.height_m({60, 0, 0}), 10, 1e-12);
  EXPECT_TRUE(ball.maps.empty());
  EXPECT_TRUE(ball.reliefs.empty());

  const SurfaceFile egg = parse("[base]\nkind = \"ellipsoid\"\nsemi_axes_m = [20, 30, 10]\n");
  EXPECT_EQ(egg.radius_m, 30);
  EXPECT_NEAR(egg.base.height_m({0, 0, 12}), 2, 1e-12);
  EXPECT_NEAR(egg.base.height_m({0, 31, 0}), 1, 1e-12);
  EXPECT_TRUE(is_round(egg.base));

  const SurfaceFile plane = parse("[base]\nkind = \"plane\"\nsize_m = [40, 10]\n");
  EXPECT_EQ(plane.area_m.x0_m, -20);
  EXPECT_EQ(plane.area_m.y1_m, 5);
  EXPECT_NEAR(plane.base.height_m({3, 4, 7}), 7, 1e-12);
  EXPECT_FALSE(is_round(plane.base));

  // z = (x^2 + y^2) / 200
  const SurfaceFile bowl = parse(
      "[base]\nkind = \"quadric\"\nsize_m = [100, 100]\nmatrix = [[-0.005, 0, 0], [0, -0.005, 0], [0, 0, 0]]\n"
      "linear = [0, 0, 0.5]\n");
  EXPECT_EQ(bowl.base.kind(), Base::Kind::kQuadric);
  EXPECT_NEAR(bowl.base.height_m({10, 20, 2.5}), 0, 1e-12);
  EXPECT_NEAR(bowl.base.height_m({0, 0, 4}), 4, 1e-12);
}

TEST(SurfaceFiles, MapsHaveTheirKeys) {
  const SurfaceFile body = parse(
      "reliefs = \"c.relief.toml\"\nrelief_posts = 257\n[base]\nkind = \"sphere\"\nradius_m = 50\n"
      "[[map]]\nfile = \"../r.tif\"\nheights = \"radius\"\ninterpolation = \"bilinear\"\nscale = 1000\nfill_m = 3\n"
      "posts = 65\n[[map]]\nfile = \"/data/b.tif\"\ncompose = \"replace\"\nmask = \"m.tif\"\n");
  EXPECT_EQ(body.reliefs, "in/c.relief.toml");
  EXPECT_EQ(body.relief_posts, 257);
  ASSERT_EQ(body.maps.size(), 2U);
  EXPECT_EQ(body.maps[0].file, "r.tif");
  EXPECT_EQ(body.maps[0].heights, MapHeights::kRadius);
  EXPECT_EQ(body.maps[0].interpolation, Interpolation::kBilinear);
  EXPECT_EQ(body.maps[0].scale, 1000);
  EXPECT_EQ(body.maps[0].fill_m, 3);
  EXPECT_EQ(body.maps[0].posts, 65);
  EXPECT_EQ(body.maps[0].compose, Compose::kSum);
  EXPECT_EQ(body.maps[1].file, "/data/b.tif");
  EXPECT_EQ(body.maps[1].mask, "in/m.tif");
  EXPECT_EQ(body.maps[1].compose, Compose::kReplace);
  EXPECT_EQ(body.maps[1].heights, MapHeights::kAboveBase);
  EXPECT_EQ(body.maps[1].interpolation, Interpolation::kBicubic);
  EXPECT_FALSE(body.maps[1].fill_m.has_value());
}

TEST(SurfaceFiles, RefuseWithFileLineKeyAndWhatIsAllowed) {
  const std::string ball = "[base]\nkind = \"sphere\"\nradius_m = 50\n";
  const std::string plane = "[base]\nkind = \"plane\"\nsize_m = [40, 10]\n";
  const std::string at = "in/a.surface.toml:";
  EXPECT_EQ(error_of(""), at + "1: base is missing in the file");
  EXPECT_EQ(error_of("base = 3\n"), at + "2: base: expected a table [base], found 3");
  EXPECT_EQ(error_of("bases = 3\n"),
            at + "2: unknown key \"bases\" in the file; keys are version, base, map, reliefs and relief_posts");
  EXPECT_EQ(error_of("[base]\nkind = \"cube\"\n"),
            at + "3: kind: expected plane, sphere, ellipsoid or quadric, found \"cube\"");
  EXPECT_EQ(error_of("[base]\nkind = \"sphere\"\nradius_m = 0\n"),
            at + "4: radius_m: expected a number in (0, 1000000000], found 0");
  EXPECT_EQ(error_of("[base]\nkind = \"sphere\"\nradius_m = 1\nsize_m = [1, 2]\n"),
            at + "5: unknown key \"size_m\" in [base]; keys are kind and radius_m");
  EXPECT_EQ(error_of("[base]\nkind = \"ellipsoid\"\nsemi_axes_m = [1, 2]\n"),
            at + "4: semi_axes_m: expected three numbers [x, y, z], found a list of 2");
  EXPECT_NE(error_of("[base]\nkind = \"ellipsoid\"\nsemi_axes_m = [1, 2, -3]\n").find("semi_axes_m"),
            std::string::npos);
  EXPECT_NE(error_of("[base]\nkind = \"ellipsoid\"\nsemi_axes_m = [1, 2, nan]\n").find("semi_axes_m"),
            std::string::npos);
  EXPECT_EQ(error_of("[base]\nkind = \"plane\"\n"), at + "2: size_m is missing in [base]");
  EXPECT_NE(error_of("[base]\nkind = \"quadric\"\nsize_m = [1, 1]\nmatrix = [[1, 2, 0], [0, 1, 0], [0, 0, 1]]\n"
                     "anchor_m = [1, 0, 0]\n")
                .find("its matrix must be symmetric"),
            std::string::npos);
  EXPECT_NE(
      error_of("[base]\nkind = \"quadric\"\nsize_m = [1, 1]\nmatrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n")
          .find("its gradient is 0 at the anchor"),
      std::string::npos);
  EXPECT_EQ(error_of(ball + "[[map]]\nheights = \"radius\"\n"), at + "5: file is missing in [[map]]");
  EXPECT_NE(error_of(ball + "[[map]]\nfile = \"\"\n").find("6: file: expected a file name"), std::string::npos);
  EXPECT_NE(
      error_of(ball + "[[map]]\nfile = \"a\"\nposts = 2\n").find("7: posts: expected an integer in [3, 8193]"),
      std::string::npos);
  EXPECT_NE(error_of(ball + "[[map]]\nfile = \"a\"\ncompose = \"replace\"\n").find("expected a mask"),
            std::string::npos);
  EXPECT_NE(error_of(ball + "[[map]]\nfile = \"a\"\nmask = \"b\"\n").find("expected a mask"),
            std::string::npos);
  EXPECT_NE(error_of(plane + "[[map]]\nfile = \"a\"\nheights = \"radius\"\n").find("has no centre"),
            std::string::npos);
  EXPECT_NE(error_of(plane + "[[map]]\nfile = \"a\"\nposts = 9\n").find("posts of their rasters"),
            std::string::npos);
  EXPECT_NE(error_of("reliefs = \"r\"\n" + plane).find("2: reliefs: they have longitudes"), std::string::npos);
  EXPECT_NE(error_of(ball + "map = 3\n").find("unknown key \"map\" in [base]"), std::string::npos);
  EXPECT_NE(error_of("map = 3\n" + ball).find("2: map: expected tables [[map]], found 3"), std::string::npos);
  EXPECT_NE(error_of("relief_posts = 9\n" + ball).find("2: relief_posts: expected reliefs too"),
            std::string::npos);
  EXPECT_NE(error_of("reliefs = \"r\"\nrelief_posts = 1\n" + ball)
                .find("3: relief_posts: expected an integer in [3, 8193]"),
            std::string::npos);
  std::string many = ball;
  for (int n = 0; n < 65; ++n) many += "[[map]]\nfile = \"a\"\n";
  EXPECT_NE(error_of(many).find("expected at most 64 maps, found 65"), std::string::npos);
  EXPECT_THROW(parse_surface_toml("[base]\nkind = \"sphere\"\nradius_m = 5\n", "a"), std::runtime_error);
}

TEST(SurfaceFiles, AreReadFromFilesOfTheirName) {
  const test_support::TempDir dir;
  std::ofstream(dir / "a.surface.toml") << "version = 1\n[base]\nkind = \"sphere\"\nradius_m = 7\n";
  EXPECT_EQ(read_surface_file(dir / "a.surface.toml").radius_m, 7);
  EXPECT_TRUE(is_surface_path("x/a.surface.toml"));
  EXPECT_FALSE(is_surface_path("x/a.toml"));
  EXPECT_THROW(read_surface_file(dir / "a.toml"), vpe::base::FileError);
  EXPECT_THROW(read_surface_file(dir / "b.surface.toml"), vpe::base::FileError);
  EXPECT_THROW(parse_surface_toml(std::string(kMostSurfaceFileBytes + 1, '#'), "a"), std::runtime_error);
}

}  // namespace
}  // namespace relief
