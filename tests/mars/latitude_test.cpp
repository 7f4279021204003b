// Planetographic latitudes.
#include "mars/geodesy/latitude.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using mars::Spheroid;

TEST(Latitude, AnglesOfCentreAndNormal) {
  const Spheroid mars{3396190, 3376200};
  for (double graphic_deg = -90; graphic_deg <= 90; graphic_deg += 0.5) {
    const double centric_deg = mars::planetocentric_lat_deg(graphic_deg, mars);
    EXPECT_NEAR(mars::planetographic_lat_deg(centric_deg, mars), graphic_deg, 1e-13);
    EXPECT_LE(std::abs(centric_deg), std::abs(graphic_deg));
    // The point of the ellipse whose normal has this angle, by its parametric latitude.
    const double parametric = std::atan2(mars.polar_m * std::sin(graphic_deg * M_PI / 180),
                                         mars.equatorial_m * std::cos(graphic_deg * M_PI / 180));
    const double at_centre =
        std::atan2(mars.polar_m * std::sin(parametric), mars.equatorial_m * std::cos(parametric));
    EXPECT_NEAR(centric_deg, at_centre * 180 / M_PI, 1e-12);
  }
  EXPECT_EQ(mars::planetocentric_lat_deg(90, mars), 90);
  EXPECT_EQ(mars::planetocentric_lat_deg(-90, mars), -90);
  EXPECT_EQ(mars::planetocentric_lat_deg(45, {1000, 1000}), 45);
  EXPECT_NEAR(mars::planetographic_lat_deg(mars::planetocentric_lat_deg(33, {2, 1}), {2, 1}), 33, 1e-13);
}

TEST(Latitude, BodiesOfTwoAxesHaveAnEllipsoid) {
  EXPECT_EQ(mars::reference_spheroid("mars")->polar_m, 3376200);
  EXPECT_EQ(mars::reference_spheroid("Moon")->polar_m, mars::reference_spheroid("Moon")->equatorial_m);
  EXPECT_FALSE(mars::reference_spheroid("Vesta"));
  EXPECT_FALSE(mars::reference_spheroid("unnamed"));
}

}  // namespace
