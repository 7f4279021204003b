#include "mars/geodesy/datum.h"

#include <gtest/gtest.h>
#include <proj.h>

#include <cmath>
#include <memory>

#include "mars/geodesy/sphere.h"
#include "tests/support/support.h"

namespace {

using mars::DatumKind;
using mars::VerticalDatum;

TEST(Datum, Text) {
  for (const VerticalDatum& datum :
       {VerticalDatum{}, VerticalDatum::areoid(), VerticalDatum::radius(), VerticalDatum::sphere(3396190),
        VerticalDatum::sphere(1737400.25), VerticalDatum::ellipsoid(6378137, 6356752.314245179)}) {
    EXPECT_EQ(mars::parse_datum(to_string(datum), 1), datum) << to_string(datum);
  }
  EXPECT_EQ(mars::parse_datum("geoid", 1), VerticalDatum::areoid());
  EXPECT_EQ(mars::parse_datum("sphere", 3396000), VerticalDatum::sphere(3396000));
  for (const char* bad :
       {"", "Areoid", "sphere:", "sphere:x", "sphere:-1", "sphere:nan", "sphere:1e99", "sphere:+3396190",
        "sphere:3396190m", "ellipsoid", "ellipsoid:1000", "ellipsoid:1000,2000", "ellipsoid:1000,100",
        "ellipsoid:1000,900,800", "radius:1", "areoid:mola"}) {
    EXPECT_FALSE(mars::parse_datum(bad, 3396190)) << bad;
  }
}

// PROJ's own geodetic <-> geocentric conversion.
class Cart {
 public:
  explicit Cart(const VerticalDatum& datum)
      : context_(proj_context_create()),
        cart_(proj_create(context_, ("+proj=cart +a=" + std::to_string(datum.equatorial_m) +
                                     " +b=" + std::to_string(datum.polar_m))
                                        .c_str())) {}
  ~Cart() {
    proj_destroy(cart_);
    proj_context_destroy(context_);
  }
  Cart(const Cart&) = delete;
  Cart& operator=(const Cart&) = delete;
  glm::dvec3 point(double lon_deg, double lat_deg, double height_m) const {
    const PJ_COORD c = proj_trans(
        cart_, PJ_FWD,
        proj_coord(lon_deg * mars::kRadiansPerDegree, lat_deg * mars::kRadiansPerDegree, height_m, 0));
    return {c.xyz.x, c.xyz.y, c.xyz.z};
  }

 private:
  PJ_CONTEXT* context_;
  PJ* cart_;
};

TEST(Datum, EllipsoidsAgreeWithProj) {
  test_support::Random random(71);
  for (const VerticalDatum& datum :
       {VerticalDatum::ellipsoid(3396190, 3376200), VerticalDatum::ellipsoid(6378137, 6356752.314245),
        VerticalDatum::ellipsoid(286300, 223200)}) {
    const Cart cart(datum);
    double worst = 0;
    for (int i = 0; i < 3000; ++i) {
      const double lat = i == 0 ? 90 : i == 1 ? -90 : i == 2 ? 0 : random.uniform(-90, 90);
      const double height = random.uniform(-0.05, 0.1) * datum.equatorial_m;
      const glm::dvec3 p = cart.point(random.uniform(-180, 180), lat, height);
      const double radius = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
      const glm::dvec3 direction = p / radius;
      worst = std::max(worst, std::abs(mars::height_at(datum, direction, radius) - height));
      worst = std::max(worst, std::abs(mars::radius_at(datum, direction, height) - radius));
    }
    EXPECT_LT(worst, 1e-8 * std::max(1.0, datum.equatorial_m / 3.4e6)) << to_string(datum);
  }
}

// Published drops of the Martian ellipsoid below its equatorial sphere, metres.
TEST(Datum, EllipsoidBelowTheSphere) {
  const VerticalDatum ellipsoid = VerticalDatum::ellipsoid(3396190, 3376200);
  for (const auto& [lat, drop] :
       {std::pair{0.0, 0.0}, {30.0, 5031.0}, {45.0, 10039.0}, {60.0, 15026.0}, {90.0, 19990.0}}) {
    EXPECT_NEAR(3396190 - mars::radius_at(ellipsoid, mars::direction({17, lat}), 0), drop, 1) << lat;
  }
}

TEST(Datum, SpheresAndRadii) {
  const glm::dvec3 d = mars::direction({12, 34});
  EXPECT_EQ(mars::radius_at(VerticalDatum::sphere(3396000), d, -1200), 3394800);
  EXPECT_EQ(mars::height_at(VerticalDatum::sphere(3396000), d, 3396190), 190);
  EXPECT_EQ(mars::radius_at(VerticalDatum::radius(), d, 3390000), 3390000);
  EXPECT_EQ(mars::height_at(VerticalDatum::radius(), d, 3390000), 3390000);
}

}  // namespace
