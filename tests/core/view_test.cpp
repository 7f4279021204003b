#include "vpe/core/view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "tests/support/support.h"
#include "tests/support/worst.h"

namespace vpe::core {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

mars::CameraPose pose(double lon_deg, double lat_deg, double alt_m, double yaw_deg, double pitch_deg,
                      double roll_deg) {
  return mars::to_camera({lon_deg, lat_deg, alt_m, yaw_deg, pitch_deg, roll_deg}, mars::kMarsRadius_m);
}

View random_view(test_support::Random& random, Projection projection) {
  View view;
  view.projection = projection;
  const std::array<double, 6> p{random.uniform(-180, 180),    random.uniform(-90, 90),
                                random.log_uniform(0.1, 3e7), random.uniform(0, 360),
                                random.uniform(-90, 90),      random.uniform(-180, 180)};
  view.camera = pose(p[0], p[1], p[2], p[3], p[4], p[5]);
  view.fov_deg = random.log_uniform(0.01, projection == Projection::kEquirectangular ? 120.0 : 170.0);
  view.width = random.integer(1, 4000);
  view.height = random.integer(1, 4000);
  view.principal_offset_px = {random.uniform(-1, 1) * view.width, random.uniform(-0.2, 0.2) * view.height};
  return view;
}

// Converts an image position to camera axes in long double, directly by the definition in view.h.
struct LongVec {
  long double right, up, forward;
};
LongVec expected_axes(const View& view, double x, double y) {
  const long double dx = static_cast<long double>(x) - (view.width / 2.0L + view.principal_offset_px.x);
  const long double dy = static_cast<long double>(y) - (view.height / 2.0L + view.principal_offset_px.y);
  const long double pi = std::acos(-1.0L);
  const long double fov = view.fov_deg * pi / 180.0L;
  const long double f = view.height / 2.0L / std::tan(fov / 2.0L);
  const long double a = dx * 2.0L * pi / view.width;
  switch (view.projection) {
    case Projection::kPerspective: return {dx, -dy, f};
    case Projection::kCylinder: return {std::sin(a), -dy / f, std::cos(a)};
    case Projection::kEquirectangular: break;
  }
  const long double e = -dy * fov / view.height;
  return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
}

long double angle_to_expected(const View& view, double x, double y) {
  const LongVec e = expected_axes(view, x, y);
  const mars::Axes& axes = view.camera.axes;
  const glm::dvec3 ray = pixel_ray(view, x, y);
  long double want[3];
  long double length2 = 0;
  for (int i = 0; i < 3; ++i) {
    want[i] = e.right * axes.right[i] + e.up * axes.up[i] + e.forward * axes.forward[i];
    length2 += want[i] * want[i];
  }
  const long double length = std::sqrt(length2);
  long double cross2 = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const long double c = want[j] * ray[k] - want[k] * ray[j];
    cross2 += c * c;
  }
  return std::sqrt(cross2) / length;
}

constexpr Projection kProjections[] = {Projection::kPerspective, Projection::kCylinder,
                                       Projection::kEquirectangular};

TEST(View, PixelRayErrorIsWithinItsBoundAndTheBoundIsNotLazy) {
  test_support::Random random(1);
  long double worst = 0;
  for (const Projection projection : kProjections) {
    for (int n = 0; n < 20000; ++n) {
      const View view = random_view(random, projection);
      const double x = random.uniform(0, view.width);
      const double y = random.uniform(0, view.height);
      const long double error = angle_to_expected(view, x, y);
      ASSERT_LE(error, kPixelRayError_rad) << static_cast<int>(projection) << " fov " << view.fov_deg;
      ASSERT_NEAR(glm::length(pixel_ray(view, x, y)), 1.0, 4e-16);
      worst = std::max(worst, error);
    }
  }
  EXPECT_GE(worst, kPixelRayError_rad / 20);
  test_support::record_worst("pixel_ray: angle", static_cast<double>(worst), kPixelRayError_rad, "rad");
}

TEST(View, ProjectInvertsPixelRayWithinItsBound) {
  test_support::Random random(2);
  double worst_share = 0;
  for (const Projection projection : kProjections) {
    for (int n = 0; n < 20000; ++n) {
      const View view = random_view(random, projection);
      const double x = random.uniform(0, view.width);
      const double y = random.uniform(0, view.height);
      const double distance_m = random.log_uniform(1, 1e8);
      const Projected p = project(view, view.camera.position_m + pixel_ray(view, x, y) * distance_m);
      ASSERT_FALSE(p.behind);
      const glm::dvec2 principal = glm::dvec2(view.width, view.height) * 0.5 + view.principal_offset_px;
      const double f = focal_px(view);
      double t = 0;
      if (projection == Projection::kPerspective) t = glm::length(glm::dvec2(x, y) - principal) / f;
      if (projection == Projection::kCylinder) t = (y - principal.y) / f;
      const double scale = std::max({f, double(view.width), double(view.height)});
      const double bound = 8e-16 * (glm::length(view.camera.position_m) / distance_m + 4) * (1 + t * t) * scale;
      double dx = std::abs(p.xy.x - x);
      if (projection != Projection::kPerspective) dx = std::min(dx, view.width - dx);
      if (projection == Projection::kEquirectangular) {
        // Columns meet at zenith and nadir.
        dx *= std::cos((y - principal.y) / f);
      }
      const double error = std::hypot(dx, p.xy.y - y);
      ASSERT_LE(error, bound) << static_cast<int>(projection) << " fov " << view.fov_deg << " distance "
                              << distance_m << " size " << view.width << "x" << view.height;
      worst_share = std::max(worst_share, error / bound);
    }
  }
  EXPECT_GE(worst_share, 1.0 / 20);
  test_support::record_worst("project inverts pixel_ray", worst_share, 1, "of the bound in the header");
}

TEST(View, PerspectiveAgreesWithGlm) {
  test_support::Random random(3);
  for (int n = 0; n < 2000; ++n) {
    View view = random_view(random, Projection::kPerspective);
    view.principal_offset_px = {0, 0};
    view.width = random.integer(100, 4000);
    view.height = random.integer(100, 4000);
    view.fov_deg = random.uniform(1, 150);
    view.camera.position_m = {0, 0, 0};  // glm's matrices would cancel
    const mars::Axes& axes = view.camera.axes;
    const glm::dmat4 look = glm::lookAt(glm::dvec3(0), axes.forward, axes.up);
    const glm::dmat4 lens =
        glm::perspective(view.fov_deg * mars::kRadiansPerDegree, double(view.width) / view.height, 1.0, 1e6);
    const glm::dvec3 along{random.uniform(10, 100), random.uniform(-50, 50), random.uniform(-50, 50)};
    const glm::dvec3 point = axes.forward * along.x + axes.right * along.y + axes.up * along.z;
    const glm::dvec3 window = glm::project(point, look, lens, glm::dvec4(0, 0, view.width, view.height));
    const Projected p = project(view, point);
    ASSERT_FALSE(p.behind);
    const double tolerance = 1e-9 * (1 + std::abs(window.x) + std::abs(window.y));
    ASSERT_NEAR(p.xy.x, window.x, tolerance);
    ASSERT_NEAR(p.xy.y, view.height - window.y, tolerance);
  }
}

TEST(View, FocalLengthInPixels) {
  View view;
  view.height = 720;
  view.fov_deg = 90;
  EXPECT_NEAR(focal_px(view), 360.0, 1e-12);
  view.projection = Projection::kCylinder;
  EXPECT_NEAR(focal_px(view), 360.0, 1e-12);
  view.projection = Projection::kEquirectangular;
  EXPECT_NEAR(focal_px(view), 720 / (mars::kPi / 2), 1e-12);
}

TEST(View, AxesPointRightDownAndIntoTheImage) {
  View view;
  view.camera = pose(0, 0, 1000, 0, 0, 0);  // looking north from the equator: east is right, up is +X
  const glm::dvec3 middle = pixel_ray(view, 640, 360);
  EXPECT_NEAR(glm::length(middle - glm::dvec3(0, 0, 1)), 0, 1e-15);
  EXPECT_GT(pixel_ray(view, 641, 360).y, 0);
  EXPECT_LT(pixel_ray(view, 640, 361).x, 0);
  // The upper edge of the middle column is fov / 2 up.
  const glm::dvec3 top = pixel_ray(view, 640, 0);
  EXPECT_NEAR(std::atan2(top.x, top.z), 30 * mars::kRadiansPerDegree, 1e-15);
}

TEST(View, CylinderRowsAreEvenInTangentAndColumnsInAzimuth) {
  View view;
  view.camera = pose(0, 0, 1000, 0, 0, 0);
  view.projection = Projection::kCylinder;
  view.width = 3600;
  view.height = 1000;
  view.fov_deg = 90;
  for (const double x : {0.5, 900.0, 1799.5, 3599.5}) {
    for (const double y : {0.0, 250.0, 500.0, 999.5}) {
      const glm::dvec3 d = pixel_ray(view, x, y);
      EXPECT_NEAR(d.x / std::hypot(d.y, d.z), (500 - y) / 500, 1e-15);
      EXPECT_NEAR(std::remainder(std::atan2(d.y, d.z) / mars::kRadiansPerDegree - (x - 1800) / 10, 360), 0,
                  1e-12);
    }
  }
  // Multiples of 90 degrees are exact.
  EXPECT_EQ(pixel_ray(view, 2700, 500), glm::dvec3(0, 1, 0));
  EXPECT_TRUE(project(view, view.camera.position_m * 2.0).behind);  // the zenith is on no row
}

TEST(View, EquirectangularReachesZenithAndNadir) {
  View view;
  view.camera = pose(10, 20, 1000, 30, 0, 0);
  view.projection = Projection::kEquirectangular;
  view.width = 4000;
  view.height = 2000;
  view.fov_deg = 180;
  EXPECT_EQ(check(view), "");
  for (const double x : {0.0, 1000.0, 3999.5}) {
    EXPECT_NEAR(glm::length(pixel_ray(view, x, 0) - view.camera.axes.up), 0, 1e-15);
    EXPECT_NEAR(glm::length(pixel_ray(view, x, 2000) + view.camera.axes.up), 0, 1e-15);
  }
  const Projected zenith = project(view, view.camera.position_m * 2.0);
  EXPECT_FALSE(zenith.behind);
  EXPECT_NEAR(zenith.xy.y, 0, 1e-9);
}

TEST(View, OffsetMovesTheImageByThatManyPixels) {
  test_support::Random random(4);
  for (const Projection projection : kProjections) {
    for (int n = 0; n < 500; ++n) {
      View view = random_view(random, projection);
      view.principal_offset_px = {0, 0};
      const double x = random.uniform(0, view.width);
      const double y = random.uniform(0, view.height);
      const glm::dvec3 before = pixel_ray(view, x, y);
      view.principal_offset_px = {32, -16};
      ASSERT_LE(glm::length(pixel_ray(view, x + 32, y - 16) - before), 1e-12);
    }
  }
}

TEST(View, PartDoesNotChangeRays) {
  View view;
  view.camera = pose(0, 0, 1000, 0, 0, 0);
  const glm::dvec3 before = pixel_ray(view, 100.5, 200.5);
  view.part = {100, 200, 300, 50};
  EXPECT_EQ(pixel_ray(view, 100.5, 200.5), before);
  EXPECT_EQ(drawn_size(view), glm::ivec2(300, 50));
  view.part = {};
  EXPECT_EQ(drawn_size(view), glm::ivec2(1280, 720));
}

TEST(View, SidePlanesBoundExactlyWhatProjectsIntoThePart) {
  test_support::Random random(5);
  int inside_count = 0;
  for (int n = 0; n < 20000; ++n) {
    View view = random_view(random, Projection::kPerspective);
    view.part = {random.integer(0, view.width - 1), random.integer(0, view.height - 1), 0, 0};
    view.part.width = random.integer(1, view.width - view.part.x);
    view.part.height = random.integer(1, view.height - view.part.y);
    ASSERT_EQ(check(view), "");
    const double x = random.uniform(view.part.x - view.part.width, view.part.x + 2 * view.part.width);
    const double y = random.uniform(view.part.y - view.part.height, view.part.y + 2 * view.part.height);
    const glm::dvec3 point = view.camera.position_m + pixel_ray(view, x, y) * random.log_uniform(1e3, 1e7);
    const double x1 = view.part.x + view.part.width;
    const double y1 = view.part.y + view.part.height;
    const double gaps[4] = {x - view.part.x, x1 - x, y1 - y, y - view.part.y};
    if (*std::min_element(std::begin(gaps), std::end(gaps),
                          [](double a, double b) { return std::abs(a) < std::abs(b); }) == 0) {
      continue;
    }
    bool inside = true;
    for (std::size_t side = 0; side < 4; ++side) {
      const Plane plane = side_planes(view)[side];
      ASSERT_NEAR(glm::length(plane.normal), 1, 1e-15);
      const double depth = glm::dot(plane.normal, point) - plane.offset_m;
      const double camera_depth = glm::dot(plane.normal, view.camera.position_m) - plane.offset_m;
      ASSERT_NEAR(camera_depth, 0, 1e-15 * glm::length(view.camera.position_m));
      if (std::abs(depth) > 1e-6 && std::abs(gaps[side]) > 1e-6) {
        ASSERT_EQ(depth > 0, gaps[side] > 0) << side;
      }
      inside = inside && depth > 0;
    }
    inside_count += inside ? 1 : 0;
  }
  EXPECT_GT(inside_count, 1000);
}

TEST(View, SidePlanesAreRefusedForRoundImages) {
  View view;
  view.projection = Projection::kCylinder;
  EXPECT_THROW(side_planes(view), std::invalid_argument);
}

TEST(View, BehindThePerspectiveEye) {
  View view;
  view.camera = pose(0, 0, 1000, 0, 0, 0);
  EXPECT_TRUE(project(view, view.camera.position_m - view.camera.axes.forward).behind);
  EXPECT_TRUE(project(view, view.camera.position_m + view.camera.axes.right).behind);
  EXPECT_TRUE(project(view, view.camera.position_m).behind);
  EXPECT_FALSE(project(view, view.camera.position_m + view.camera.axes.forward).behind);
}

class BadView : public ::testing::Test {
 protected:
  BadView() { view_.camera = pose(0, 0, 1000, 0, 0, 0); }
  void expect(const std::string& words) const {
    const std::string problem = check(view_);
    EXPECT_NE(problem.find(words), std::string::npos) << "said: '" << problem << "', wanted: " << words;
  }
  View view_;
};

TEST_F(BadView, GoodOneIsAccepted) { EXPECT_EQ(check(view_), ""); }

TEST_F(BadView, Size) {
  for (const int side : {0, -1, 32769, 100000, std::numeric_limits<int>::min()}) {
    view_.width = side;
    expect("each side must be 1 to 32768 pixels");
    view_.width = 100;
    view_.height = side;
    expect("each side must be 1 to 32768 pixels");
    view_.height = 100;
  }
}

TEST_F(BadView, FieldOfView) {
  for (const double fov : {0.0, -60.0, 180.0, 179.1, 1e-4, kNan, kInfinity}) {
    view_.fov_deg = fov;
    expect("must be 0.001 to 179");
  }
  view_.projection = Projection::kEquirectangular;
  view_.fov_deg = 180.1;
  expect("must be 0.001 to 180");
}

TEST_F(BadView, Camera) {
  view_.camera.position_m.y = kNan;
  expect("camera's position is not finite");
  view_.camera.position_m.y = 1e300;
  expect("farther than");
  view_.camera = pose(0, 0, 1000, kNan, 0, 0);
  expect("axes are not orthonormal");
  view_.camera = pose(0, 0, 1000, 0, 0, 0);
  view_.camera.axes.right = -view_.camera.axes.right;  // left-handed
  expect("axes are not orthonormal");
}

TEST_F(BadView, Offset) {
  view_.principal_offset_px.x = kNan;
  expect("principal-point offset");
  view_.principal_offset_px = {0, 2e6};
  expect("principal-point offset");
  view_.principal_offset_px = {0, 400};
  view_.projection = Projection::kEquirectangular;
  view_.fov_deg = 120;
  expect("past the zenith");
}

TEST_F(BadView, SubRectangle) {
  for (const SubRectangle& part :
       {SubRectangle{-1, 0, 10, 10}, SubRectangle{0, 0, 10, 0}, SubRectangle{0, 0, 0, 10},
        SubRectangle{1, 1, 0, 0}, SubRectangle{1271, 0, 10, 10}, SubRectangle{0, 711, 10, 10},
        SubRectangle{0, 0, -5, 10},
        SubRectangle{std::numeric_limits<int>::max(), 0, std::numeric_limits<int>::max(), 1}}) {
    view_.part = part;
    expect("does not lie inside the image of 1280x720");
  }
}

TEST(View, PartOfAImageLargerThanCanBeDrawn) {
  View view;
  view.camera = pose(0, 0, 1000, 0, 0, 0);
  view.width = 100000;
  view.height = 20000;
  EXPECT_NE(check(view), "");
  view.part = {99000, 0, 1000, 20000};
  EXPECT_EQ(check(view), "");
  view.part = {0, 0, ViewLimits::kMaxSide_px + 1, 10};
  EXPECT_NE(check(view), "");
  view.part = {0, 0, 10, 10};
  view.width = ViewLimits::kMaxFullSide_px + 1;
  EXPECT_NE(check(view), "");
}

// Compares with every pixel's corner by the angle to the horizon. Where the image ends within rounding of the
// horizon either answer is right.
TEST(View, ReachesTheHorizonWhereAPixelDoes) {
  test_support::Random random(20261122);
  int reaches = 0;
  int tried = 0;
  for (int n = 0; n < 4000; ++n) {
    View view = random_view(random, Projection::kPerspective);
    view.width = random.integer(1, 24);
    view.height = random.integer(1, 24);
    if (random.integer(0, 1) == 1) {
      const int x = random.integer(0, view.width - 1);
      const int y = random.integer(0, view.height - 1);
      view.part = {x, y, random.integer(1, view.width - x), random.integer(1, view.height - y)};
    }
    const double radius_m = mars::kMarsRadius_m - random.log_uniform(1e-3, 8e3);
    const double distance_m = glm::length(view.camera.position_m);
    const double horizon_rad = std::asin(radius_m / distance_m);
    const SubRectangle part = drawn_part(view);
    double most_rad = 0;
    for (int y = part.y; y <= part.y + part.height; ++y) {
      for (int x = part.x; x <= part.x + part.width; ++x) {
        const glm::dvec3 ray = pixel_ray(view, x, y);
        const glm::dvec3 down = -view.camera.position_m / distance_m;
        most_rad = std::max(most_rad, std::atan2(glm::length(glm::cross(ray, down)), glm::dot(ray, down)));
      }
    }
    if (std::abs(most_rad - horizon_rad) < 1e-6) continue;
    ++tried;
    reaches += reaches_horizon(view, radius_m) ? 1 : 0;
    ASSERT_EQ(reaches_horizon(view, radius_m), most_rad > horizon_rad) << n << ": " << most_rad - horizon_rad;
  }
  EXPECT_GT(reaches, tried / 10);
  EXPECT_LT(reaches, tried * 9 / 10);
  EXPECT_GT(tried, 3500);
  View round;
  round.projection = Projection::kCylinder;
  round.camera = pose(0, 0, 1000, 0, 0, 0);
  EXPECT_TRUE(reaches_horizon(round, mars::kMarsRadius_m));
  View inside = round;
  inside.projection = Projection::kPerspective;
  inside.camera = pose(0, 0, -1000, 0, -90, 0);
  EXPECT_TRUE(reaches_horizon(inside, mars::kMarsRadius_m));
}

}  // namespace
}  // namespace vpe::core
