// The tops of objects in a skyline, against closed forms.
#include "objects/draw/object_skyline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "objects/draw/single_ray.h"
#include "objects/levels/mesh_levels.h"
#include "objects/model/shapes.h"
#include "objects/scene/place.h"

namespace objects {
namespace {

constexpr double kRadius_m = 3'389'500;
constexpr double kDegree = mars::kRadiansPerDegree;

std::shared_ptr<const Model> model_of(const char* name, Mesh mesh) {
  return std::make_shared<const Model>(name, make_levels(std::move(mesh)));
}

// Places a model upright, its origin ahead of the camera along an azimuth and above it.
Instance placed(const mars::LocalFrame& frame, const glm::dvec3& camera_m, double azimuth_deg, double ahead_m,
                double up_m, std::uint32_t model) {
  Instance i;
  const glm::dvec3 ahead =
      std::cos(azimuth_deg * kDegree) * frame.north + std::sin(azimuth_deg * kDegree) * frame.east;
  i.position_m = camera_m + ahead_m * ahead + up_m * frame.up;
  i.rotation = rotation_of({glm::cross(ahead, frame.up), frame.up, ahead});
  i.model = model;
  return i;
}

class ObjectSkylineTest : public ::testing::Test {
 protected:
  mars::LocalFrame frame_ = mars::local_frame({30, 40});
  glm::dvec3 camera_m_ = (kRadius_m + 2) * frame_.up;
};

TEST_F(ObjectSkylineTest, ABallEndsAtItsTangent) {
  constexpr double kBall_m = 3;
  const Scene scene({model_of("ball", make_ellipsoid({kBall_m, kBall_m, kBall_m}, 200))},
                    {placed(frame_, camera_m_, 50, 40, 5, 0)});
  const ObjectSkyline tops(scene, camera_m_, frame_);
  for (const double off_deg : {0.0, 1.0, -2.5, 4.0}) {
    const auto top = tops.above(50 + off_deg, -90);
    ASSERT_TRUE(top) << off_deg;
    const double aside_m = 40 * std::sin(off_deg * kDegree);
    const double circle_m = std::sqrt(kBall_m * kBall_m - aside_m * aside_m);
    const double ahead_m = 40 * std::cos(off_deg * kDegree);
    const double wanted = std::atan2(5, ahead_m) + std::asin(circle_m / std::hypot(ahead_m, 5.0));
    EXPECT_NEAR(top->elevation_deg, wanted / kDegree, 0.02) << off_deg;
    EXPECT_LE(top->elevation_deg, wanted / kDegree + 1e-6);
    EXPECT_NEAR(top->range_m, std::sqrt(ahead_m * ahead_m + 25 - circle_m * circle_m), 0.5);
    // The ray there meets it, the one above does not.
    const auto meets_at = [&](double elevation_deg) {
      const double a = (50 + off_deg) * kDegree;
      const glm::dvec3 ahead = std::cos(a) * frame_.north + std::sin(a) * frame_.east;
      const double e = elevation_deg * kDegree;
      return first_object(scene, {camera_m_, std::cos(e) * ahead + std::sin(e) * frame_.up},
                          std::numeric_limits<double>::infinity())
          .has_value();
    };
    EXPECT_TRUE(meets_at(top->elevation_deg));
    EXPECT_FALSE(meets_at(top->elevation_deg + 1e-6));
  }
  EXPECT_FALSE(tops.above(50 + 4.4, -90));  // asin(3 / 40) is 4.30 degrees
  EXPECT_FALSE(tops.above(230, -90));       // behind
  EXPECT_FALSE(tops.above(50, 12));         // below the ground's skyline
}

TEST_F(ObjectSkylineTest, TheHighestOfSeveralCountsWhereverItStands) {
  const auto tower = model_of("tower", make_box({2, 2, 1}));
  std::vector<Instance> instances;
  // A low one near by, a high one behind it, and a floating one.
  instances.push_back(placed(frame_, camera_m_, 0, 10, -2, 0));
  instances.push_back(placed(frame_, camera_m_, 0, 50, -2, 0));
  instances.back().scale = 20;
  const Scene scene({tower}, instances);
  const auto top = ObjectSkyline(scene, camera_m_, frame_).above(0, -1);
  ASSERT_TRUE(top);
  // Boxes stand with their feet at the origin or around it: their tops come from the mesh itself.
  double wanted_deg = -90;
  for (std::uint32_t n = 0; n < scene.size(); ++n) {
    const Instance i = scene.instance(n);
    for (const glm::vec3& p : tower->levels().front().mesh.positions_m) {
      if (p.y > 0) continue;  // the near side
      const glm::dvec3 at =
          i.position_m + static_cast<double>(i.scale) * glm::dvec3(glm::dquat(i.rotation) * glm::dvec3(p));
      const glm::dvec3 to = at - camera_m_;
      const double level_m = glm::dot(to, frame_.north);  // of the plane through the azimuth
      wanted_deg = std::max(wanted_deg, std::atan2(glm::dot(to, frame_.up), level_m) / kDegree);
    }
  }
  EXPECT_NEAR(top->elevation_deg, wanted_deg, 1e-4);
  EXPECT_EQ(scene.instance(top->instance).scale, 20);
}

TEST_F(ObjectSkylineTest, FromInsideABallOnlyWhatIsMetCounts) {
  // A ring around the camera: its upper border is seen at every azimuth.
  const Scene scene({model_of("ring", make_torus(20, 1, 400, 40))}, {placed(frame_, camera_m_, 0, 0, 0, 0)});
  const ObjectSkyline tops(scene, camera_m_, frame_);
  const double wanted_deg = std::asin(1.0 / 20) / kDegree;
  for (int azimuth = 0; azimuth < 360; azimuth += 7) {
    const auto top = tops.above(azimuth, -90);
    ASSERT_TRUE(top) << azimuth;
    EXPECT_NEAR(top->elevation_deg, wanted_deg, 0.02) << azimuth;
  }
}

TEST_F(ObjectSkylineTest, WithoutObjectsThereIsNothing) {
  const Scene none;
  EXPECT_FALSE(ObjectSkyline(none, camera_m_, frame_).above(0, -90));
}

}  // namespace
}  // namespace objects
