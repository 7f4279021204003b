#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include "mars/geodesy/sphere.h"
#include "mars/sources/source.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

using mars::ElevationSource;
using source_files::box;
using source_files::height_at;
using source_files::Raster;
using Sources = std::vector<std::shared_ptr<const ElevationSource>>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Has one height everywhere, or north of the equator only; not BoundaryAware.
class Flat : public ElevationSource {
 public:
  Flat(std::string name, double resolution_m, double height_m, const std::string& datum = "unknown",
       bool north_only = false)
      : height_m_(height_m), north_only_(north_only) {
    info_.name = std::move(name);
    info_.resolution_m = resolution_m;
    info_.datum = mars::parse_datum(datum, mars::kMarsRadius_m).value();
  }
  std::vector<mars::SourceInfo> infos() const override { return {info_}; }
  void sample(std::span<const glm::dvec3> directions, double, std::span<double> heights_m) const override {
    for (std::size_t i = 0; i < directions.size(); ++i) heights_m[i] = has(directions[i]) ? height_m_ : kNaN;
  }
  void origin(std::span<const glm::dvec3> directions, std::span<int> source_index) const override {
    for (std::size_t i = 0; i < directions.size(); ++i) source_index[i] = has(directions[i]) ? 0 : -1;
  }
  double spacing_in(const mars::Cap&) const override { return info_.resolution_m; }
  void visit_posts(std::size_t max_posts, const mars::PostVisitor& visit) const override {
    test_support::Random random(1);
    for (std::size_t i = 0; i < max_posts; ++i) {
      const glm::dvec3 d = random.direction();
      if (has(d)) visit({&d, 1}, {&height_m_, 1});
    }
  }

 private:
  bool has(const glm::dvec3& d) const { return !north_only_ || d.z > 0; }
  mars::SourceInfo info_;
  double height_m_;
  bool north_only_;
};

std::shared_ptr<const ElevationSource> flat(const char* name, double resolution_m, double height_m,
                                            const char* datum = "unknown", bool north_only = false) {
  return std::make_shared<Flat>(name, resolution_m, height_m, datum, north_only);
}

// Returns a raster 100 m high, 60 x 60 posts of 0.1 degree from (10, 16) to (16, 10), with 5 x 5 nodata posts.
Raster inset_raster() {
  Raster raster;
  raster.width = 60;
  raster.height = 60;
  raster.geotransform = box(10, 16, 16, 10, 60, 60);
  raster.nodata = -1;
  raster.value = [](int, int column, int row) {
    return column >= 40 && column < 45 && row >= 40 && row < 45 ? -1.0 : 100.0;
  };
  return raster;
}

double smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

TEST(Stack, FinestWithDataDecidesAndTiesGoToTheFirst) {
  const auto stack = mars::stack_elevation({flat("coarse", 1000, 1), flat("fine", 10, 2, "unknown", true),
                                            flat("first", 100, 3), flat("second", 100, 4)});
  ASSERT_EQ(stack->infos().size(), 4U);
  EXPECT_EQ(stack->infos()[0].name, "fine");
  EXPECT_EQ(stack->infos()[1].name, "first");
  EXPECT_EQ(stack->infos()[2].name, "second");
  EXPECT_EQ(height_at(*stack, {20, 45}), 2);
  EXPECT_EQ(height_at(*stack, {20, -45}), 3);
  EXPECT_EQ(stack->spacing_in({}), 10);
  std::vector<glm::dvec3> places{mars::direction({20, 45}), mars::direction({20, -45})};
  std::vector<int> origin(2);
  stack->origin(places, origin);
  EXPECT_EQ(origin, (std::vector<int>{0, 1}));
}

TEST(Stack, StacksOfStacksNumberTheirSources) {
  const auto inner =
      mars::stack_elevation({flat("a", 10, 1, "unknown", true), flat("b", 20, 2, "unknown", true)});
  const auto stack = mars::stack_elevation({flat("c", 30, 3), inner});
  ASSERT_EQ(stack->infos().size(), 3U);
  EXPECT_EQ(stack->infos()[2].name, "c");
  std::vector<glm::dvec3> places{mars::direction({0, 1}), mars::direction({0, -1})};
  std::vector<int> origin(2);
  stack->origin(places, origin);
  EXPECT_EQ(origin, (std::vector<int>{0, 2}));
}

TEST(Stack, RefusesWhatCannotBeStacked) {
  const auto message = [](Sources sources, mars::StackOptions options = {}) -> std::string {
    try {
      mars::stack_elevation(std::move(sources), options);
    } catch (const mars::SourceError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(message({}).find("none given"), std::string::npos);
  EXPECT_NE(message({nullptr}).find("null"), std::string::npos);
  for (const double feather : {-1.0, 1e9, kNaN, kInfinity}) {
    EXPECT_NE(message({flat("a", 1, 1)}, {feather}).find("feather"), std::string::npos) << feather;
  }
  const std::string datums =
      message({flat("topo.img", 1, 1, "areoid"), flat("x", 2, 1), flat("radius.img", 3, 1, "radius")});
  for (const char* word : {"topo.img", "radius.img", "'areoid'", "'radius'", "convert"}) {
    EXPECT_NE(datums.find(word), std::string::npos) << datums;
  }
  EXPECT_EQ(message({flat("a", 1, 1, "areoid"), flat("b", 2, 1), flat("c", 3, 1, "areoid")}), "");
  EXPECT_THROW(mars::stack_images({}), mars::SourceError);
}

class Feather : public ::testing::TestWithParam<double> {};

TEST_P(Feather, RampsSmoothlyFromTheBoundary) {
  const double feather = GetParam();
  const test_support::TempDir folder;
  const auto inset = mars::open_elevation(source_files::write(folder / "i.tif", inset_raster()));
  const auto stack = mars::stack_elevation({flat("base", 50000, 0), inset}, {feather});
  test_support::Random random(21);
  for (int i = 0; i < 4000; ++i) {
    const mars::LonLat p{random.uniform(9.5, 16.5), random.uniform(9.5, 16.5)};
    // Distance in posts: to the border outright, to the hole as its pixel centres are round the place.
    const double x = (p.lon_deg - 10) * 10;
    const double y = (16 - p.lat_deg) * 10;
    const double border = std::min({x, 60 - x, y, 60 - y});
    const double hole_x = std::max({40 - x, x - 45, 0.0});
    const double hole_y = std::max({40 - y, y - 45, 0.0});
    const double to_hole = std::hypot(hole_x, hole_y);
    const double height = height_at(*stack, p);
    if (border <= 0) {
      EXPECT_EQ(height, 0);
    } else if (to_hole >= border + 1) {
      EXPECT_NEAR(height, feather == 0 ? 100 : 100 * smooth(border / feather), 1e-3) << x << " " << y;
    } else if (border >= to_hole + 1 && feather > 0) {
      // Distances are exact at pixel centres and linear between: at corners up to about half a post off.
      EXPECT_LE(height, 100 * smooth((to_hole + 0.75) / feather) + 1e-9) << x << " " << y;
      EXPECT_GE(height, 100 * smooth((to_hole - 0.75) / feather) - 1e-9) << x << " " << y;
    }
  }
}

class FeatherSteps : public Feather {};

TEST_P(FeatherSteps, AreNone) {
  const double feather = GetParam();
  const test_support::TempDir folder;
  const auto inset = mars::open_elevation(source_files::write(folder / "i.tif", inset_raster()));
  const auto stack = mars::stack_elevation({flat("base", 50000, 0), inset}, {feather});
  test_support::Random random(22);
  for (int line = 0; line < 40; ++line) {
    const double a = random.uniform(9.9, 16.1);
    double before = kNaN;
    for (int i = 0; i <= 3000; ++i) {
      const double t = 9.9 + 6.2 * i / 3000;
      const double height = height_at(*stack, line % 2 == 0 ? mars::LonLat{t, a} : mars::LonLat{a, t});
      // 0.02 posts a step; the rim of the hole may be missed by half a post at its corners.
      const double limit = 100 * (0.021 * 1.5 / feather * 1.5 + smooth(0.3 / feather));
      if (i > 0) {
        EXPECT_LE(std::abs(height - before), limit) << a << " " << t;
      }
      before = height;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Posts, Feather, ::testing::Values(0.0, 3.0, 16.0, 25.0));
INSTANTIATE_TEST_SUITE_P(Posts, FeatherSteps, ::testing::Values(3.0, 16.0, 25.0));

TEST(Stack, WithNothingBelowTheBoundaryKeepsItsValue) {
  const test_support::TempDir folder;
  const auto stack =
      mars::stack_elevation({mars::open_elevation(source_files::write(folder / "i.tif", inset_raster()))});
  EXPECT_EQ(height_at(*stack, {10.001, 15.999}), 100);
  EXPECT_EQ(height_at(*stack, {13, 13}), 100);
  EXPECT_TRUE(std::isnan(height_at(*stack, {14.25, 11.75})));
  EXPECT_TRUE(std::isnan(height_at(*stack, {9.99, 13})));
}

TEST(Stack, FadesInsideAnOverlapThatHasNoBase) {
  // Two insets side by side: the border of the coarser one inside the fade of the finer one must not show.
  const test_support::TempDir folder;
  Raster raster = inset_raster();
  raster.value = [](int, int, int) { return 100; };
  const auto fine = mars::open_elevation(source_files::write(folder / "a.tif", raster));
  raster.width = 50;
  raster.height = 50;
  raster.geotransform = box(15, 20, 25, 10, 50, 50);
  raster.value = [](int, int, int) { return 0; };
  const auto coarse = mars::open_elevation(source_files::write(folder / "b.tif", raster));
  const auto stack = mars::stack_elevation({coarse, fine});
  double before = height_at(*stack, {14.5, 13});
  EXPECT_NEAR(before, 100, 1e-9);
  for (double lon = 14.5; lon < 17; lon += 0.001) {
    const double height = height_at(*stack, {lon, 13});
    EXPECT_LE(std::abs(height - before), 1.0) << lon;
    before = height;
  }
  EXPECT_EQ(before, 0);
}

TEST(Stack, OriginIsTheLargerShareAndPostsAreUnblended) {
  const test_support::TempDir folder;
  const auto inset = mars::open_elevation(source_files::write(folder / "i.tif", inset_raster()));
  const auto stack = mars::stack_elevation({flat("base", 50000, 7), inset});
  std::vector<glm::dvec3> places{mars::direction({13, 13}), mars::direction({10.05, 13}),
                                 mars::direction({50, 0}), mars::direction({14.25, 11.75}),
                                 mars::direction({10.85, 13})};
  std::vector<int> origin(places.size());
  stack->origin(places, origin);
  EXPECT_EQ(origin, (std::vector<int>{0, 1, 1, 1, 0}));
  std::size_t of_inset = 0;
  std::size_t of_base = 0;
  stack->visit_posts(20000, [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
    std::vector<double> own(directions.size());
    stack->sample(directions, 1, own);
    for (std::size_t i = 0; i < own.size(); ++i) {
      EXPECT_EQ(own[i], heights_m[i]);
      ++(heights_m[i] == 7 ? of_base : of_inset);
    }
  });
  EXPECT_GT(of_inset, 300U);
  EXPECT_LT(of_inset, 28U * 28U);
  EXPECT_GT(of_base, 9000U);
}

TEST(Stack, DoesNotDependOnTheBatch) {
  const test_support::TempDir folder;
  const auto inset = mars::open_elevation(source_files::write(folder / "i.tif", inset_raster()));
  const auto stack = mars::stack_elevation({flat("base", 50000, 3, "unknown", true), inset});
  test_support::Random random(2);
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < 3000; ++i) {
    directions.push_back(mars::direction({random.uniform(9, 17), random.uniform(9, 17)}));
  }
  std::vector<double> together(directions.size());
  stack->sample(directions, 1, together);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    double alone = 0;
    stack->sample({&directions[i], 1}, 1, {&alone, 1});
    EXPECT_EQ(alone, together[i]);
  }
}

TEST(Stack, ImagesFadeLikewise) {
  const test_support::TempDir folder;
  Raster raster;
  raster.width = 60;
  raster.height = 60;
  raster.bands = 3;
  raster.type = GDT_Byte;
  raster.options = {"PHOTOMETRIC=RGB"};
  raster.geotransform = box(10, 16, 16, 10, 60, 60);
  raster.value = [](int band, int, int) { return 60 * band; };
  const auto fine = mars::open_image(source_files::write(folder / "f.tif", raster));
  raster.width = 36;
  raster.height = 18;
  raster.geotransform = box(-180, 90, 180, -90, 36, 18);
  raster.value = [](int, int, int) { return 20; };
  const auto base = mars::open_image(source_files::write(folder / "b.tif", raster));
  const auto stack = mars::stack_images({base, fine});
  EXPECT_EQ(stack->infos().size(), 2U);
  const auto look = [&](mars::LonLat p) {
    const glm::dvec3 d = mars::direction(p);
    vpe::base::Rgb colour;
    std::uint8_t alpha = 0;
    stack->sample({&d, 1}, 1, {&colour, 1}, {&alpha, 1});
    EXPECT_EQ(alpha, 255);
    return colour;
  };
  EXPECT_EQ(look({13, 13}), (vpe::base::Rgb{60, 120, 180}));
  EXPECT_EQ(look({40, -20}), (vpe::base::Rgb{20, 20, 20}));
  EXPECT_EQ(look({9.99, 13}), (vpe::base::Rgb{20, 20, 20}));
  EXPECT_EQ(look({10.8, 13}), (vpe::base::Rgb{40, 70, 100}));  // 8 of 16 posts: half
  EXPECT_LT(stack->spacing_in({mars::direction({13, 13}), 0}), 6000);
  EXPECT_GT(stack->spacing_in({mars::direction({93, 13}), 0}), 500000);
}

}  // namespace
