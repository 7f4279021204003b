// Widths and places of the largest features of the embedded Mars, measured on sampled heights, against published figures.
// Where the measure gives another figure on MOLA itself, which the embedded Mars carries, that figure stands.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <vector>

#include "mars/embedded/embedded.h"
#include "mars/geodesy/sphere.h"
#include "tests/support/support.h"

namespace mars {
namespace {

using Heights = std::function<std::vector<double>(const std::vector<glm::dvec3>&)>;

std::vector<double> embedded_heights(const std::vector<glm::dvec3>& directions) {
  std::vector<double> out(directions.size());
  embedded_elevation()->sample(directions, 4000.0, out);
  return out;
}

// Ground above (or below) a contour within a circle.
struct Area {
  double diameter_km;  // of the circle of the same area
  LonLat middle;
};
Area area(LonLat p, double radius_km, double contour_m, bool above, const Heights& heights_at) {
  const double step_km = radius_km / 100.0;
  const LocalFrame f = local_frame(p);
  std::vector<glm::dvec3> directions;
  for (int j = -100; j <= 100; ++j) {
    for (int i = -100; i <= 100; ++i) {
      const double r_km = std::hypot(i, j) * step_km;
      if (r_km > radius_km) continue;
      const double angle = r_km * 1000.0 / kMarsRadius_m;
      const glm::dvec3 aside = (static_cast<double>(i) * f.east + static_cast<double>(j) * f.north) * step_km;
      directions.push_back(glm::normalize(f.up * std::cos(angle) +
                                          (r_km > 0.0 ? aside * (std::sin(angle) / r_km) : glm::dvec3(0))));
    }
  }
  const auto h = heights_at(directions);
  glm::dvec3 sum{0, 0, 0};
  double count = 0.0;
  for (std::size_t i = 0; i < h.size(); ++i) {
    if ((h[i] > contour_m) != above) continue;
    sum += directions[i];
    count += 1.0;
  }
  return {2.0 * std::sqrt(count * step_km * step_km / kPi), lon_lat(sum)};
}

// Diameter at which the mean profile breaks most sharply: from flank to plain (hollow) or from plain to wall.
// The slopes compared are means over `span_km`.
double break_km(LonLat p, double least_km, double most_km, double span_km) {
  constexpr double kStep_km = 5.0;
  std::vector<double> profile;
  for (double r = 0.0; r <= most_km; r += kStep_km) {
    std::vector<glm::dvec3> ring;
    for (int b = 0; b < 360; b += 5) ring.push_back(direction(destination(p, b, r * 1000.0 / kMarsRadius_m)));
    double sum = 0.0;
    for (const double h : embedded_heights(ring)) sum += h;
    profile.push_back(sum / static_cast<double>(ring.size()));
  }
  const auto span = static_cast<std::size_t>(span_km / kStep_km);
  double sharpest = -1e9;
  std::size_t at = 0;
  for (std::size_t k = std::max(span, static_cast<std::size_t>(least_km / kStep_km)); k + span < profile.size();
       ++k) {
    const double curvature = profile[k - span] + profile[k + span] - 2.0 * profile[k];
    if (curvature > sharpest) {
      sharpest = curvature;
      at = k;
    }
  }
  return 2.0 * static_cast<double>(at) * kStep_km;
}

double off_deg(LonLat a, LonLat b) { return angle_between_rad(direction(a), direction(b)) / kRadiansPerDegree; }

// Width between the breaks of slope at the foot, published diameter from the gazetteer. Flows of lava hide the foot of
// Ascraeus and Arsia (456 and 470 km are published); Argyre's profile breaks at its inner ring (893), and that of Planum
// Boreum at the foot of the ice, within the published 1050.
TEST(EmbeddedFeatures, AreAsWideAsPublished) {
  struct Foot {
    const char* name;
    LonLat place;
    double least_km, most_km, span_km, published_km;
  };
  for (const Foot& f : {Foot{"Olympus Mons", {226.20, 18.65}, 200, 500, 40, 610},
                        Foot{"Ascraeus Mons", {255.92, 11.92}, 100, 400, 60, 360},
                        Foot{"Pavonis Mons", {247.04, 1.48}, 100, 400, 60, 366},
                        Foot{"Arsia Mons", {239.91, -8.26}, 100, 400, 60, 400},
                        Foot{"Argyre Planitia", {316.69, -49.84}, 200, 900, 100, 640},
                        Foot{"Isidis Planitia", {88.38, 13.94}, 300, 900, 100, 1225},
                        Foot{"Planum Boreum", {32.53, 87.73}, 200, 800, 60, 860}}) {
    const double width_km = break_km(f.place, f.least_km, f.most_km, f.span_km);
    EXPECT_NEAR(width_km, f.published_km, 0.1 * f.published_km) << f.name;
  }
  // These two fade into their rises; MOLA itself has the published diameter at these contours (397, 545 km).
  const Area elysium = area({147.21, 25.02}, 350, 1500, true, embedded_heights);
  EXPECT_NEAR(elysium.diameter_km, 401, 40) << "Elysium Mons";
  const Area alba = area({250.40, 40.47}, 600, 4350, true, embedded_heights);
  EXPECT_NEAR(alba.diameter_km, 540, 54) << "Alba Mons";
}

TEST(EmbeddedFeatures, HellasHasARimAsWideAsPublished) {
  // From the mean profile: where the wall gives way to the highlands.
  std::vector<double> profile;
  for (double r = 0.0; r <= 1600.0; r += 5.0) {
    std::vector<glm::dvec3> ring;
    for (int b = 0; b < 360; b += 5) {
      ring.push_back(direction(destination({70.5, -42.43}, b, r * 1000.0 / kMarsRadius_m)));
    }
    double sum = 0.0;
    for (const double h : embedded_heights(ring)) sum += h;
    profile.push_back(sum / static_cast<double>(ring.size()));
  }
  double sharpest = -1e9;
  double rim_km = 0.0;
  for (std::size_t k = 120; k + 30 < profile.size(); ++k) {
    const double curvature = 2.0 * profile[k] - profile[k - 30] - profile[k + 30];
    if (curvature > sharpest) {
      sharpest = curvature;
      rim_km = 10.0 * static_cast<double>(k);
    }
  }
  EXPECT_NEAR(rim_km, 2299, 230);
}

TEST(EmbeddedFeatures, VallesMarinerisIsAsLongAsPublished) {
  // Along the axis from where Noctis ends to the chaos of Hydraotes, between the first and the last place that
  // lie deep below the plateaus on both sides.
  const LonLat axis[] = {{266.5, -6.4},  {267.8, -6.3},  {278, -7.5},    {284.8, -9.2},
                         {291.8, -11.7}, {299.3, -13.4}, {309.5, -13.7}, {317.9, -8.3},
                         {321.8, -3.2},  {325.2, 1.6},   {326.5, 5.0},   {327.0, 12.0}};
  double length_km = 0.0, first_km = -1.0, last_km = 0.0;
  for (std::size_t k = 1; k < std::size(axis); ++k) {
    const glm::dvec3 a = direction(axis[k - 1]), b = direction(axis[k]);
    const double piece_km = angle_between_rad(a, b) * kMarsRadius_m / 1000.0;
    for (double s = 0.0; s < piece_km; s += 10.0) {
      const glm::dvec3 here = slerp(a, b, s / piece_km);
      const glm::dvec3 side = glm::normalize(glm::cross(here, b - a));
      std::vector<glm::dvec3> floor, north, south;
      for (double d = -12; d <= 12; d += 2)
        floor.push_back(glm::normalize(here + side * (d * 1000.0 / kMarsRadius_m)));
      for (double d = 120; d <= 220; d += 10) {
        north.push_back(glm::normalize(here + side * (d * 1000.0 / kMarsRadius_m)));
        south.push_back(glm::normalize(here - side * (d * 1000.0 / kMarsRadius_m)));
      }
      const auto middle = [](std::vector<double> h) {
        std::sort(h.begin(), h.end());
        return h[h.size() / 2];
      };
      const double rim = std::max(middle(embedded_heights(north)), middle(embedded_heights(south)));
      if (rim - middle(embedded_heights(floor)) > 2000.0) {
        if (first_km < 0.0) first_km = length_km + s;
        last_km = length_km + s;
      }
    }
    length_km += piece_km;
  }
  EXPECT_NEAR(last_km - first_km, 3761, 376);
}

// Gazetteer places of basins and caps are the middles of names on maps; MOLA's own contours lie up to 5 degrees
// from them. So the middles of contours are compared.
struct Contour {
  const char* name;
  LonLat reevaluate_for_view;
  double radius_km, contour_m;
  bool above;
  LonLat mola;  // measured on MOLA, 8 posts a degree
};
constexpr Contour kContours[] = {
    {"Hellas Planitia", {70.5, -42.43}, 1500, -4500, false, {68.88, -41.78}},
    {"Argyre Planitia", {316.69, -49.84}, 800, -1000, false, {317.80, -48.54}},
    {"Isidis Planitia", {88.38, 13.94}, 800, -2000, false, {89.45, 14.85}},
    {"Planum Boreum", {0, 89.99}, 900, -3500, true, {24.38, 88.04}},
};

TEST(EmbeddedFeatures, BasinsAndTheNorthernIceLieWhereMolaHasThem) {
  for (const Contour& c : kContours) {
    const Area a = area(c.reevaluate_for_view, c.radius_km, c.contour_m, c.above, embedded_heights);
    EXPECT_LT(off_deg(a.middle, c.mola), 0.2) << c.name << " " << a.middle.lon_deg << " " << a.middle.lat_deg;
  }
  // The summit plateau lies east of the middle of the name.
  const Area alba = area({250.40, 40.47}, 300, 6450, true, embedded_heights);
  EXPECT_LT(off_deg(alba.middle, {248.60, 40.38}), 0.2) << alba.middle.lon_deg << " " << alba.middle.lat_deg;
}

TEST(EmbeddedFeatures, TheMeasureItselfHoldsOnMola) {
  VPE_NEED_SHARED(path, "mola8/mola8_topo.img");
  std::ifstream file(path, std::ios::binary);
  std::vector<unsigned char> raw(2880 * 1440 * 2);
  ASSERT_TRUE(file.read(reinterpret_cast<char*>(raw.data()), static_cast<std::streamsize>(raw.size())));
  const auto mola = [&raw](const std::vector<glm::dvec3>& directions) {
    std::vector<double> out;
    for (const glm::dvec3& d : directions) {
      const LonLat p = lon_lat(d);
      const double lon = p.lon_deg < 0.0 ? p.lon_deg + 360.0 : p.lon_deg;
      const auto col = static_cast<std::size_t>(lon * 8.0) % 2880;
      const auto row = std::min<std::size_t>(1439, static_cast<std::size_t>((90.0 - p.lat_deg) * 8.0));
      const std::size_t at = 2 * (2880 * row + col);
      out.push_back(static_cast<std::int16_t>(raw[at] << 8 | raw[at + 1]));
    }
    return out;
  };
  for (const Contour& c : kContours) {
    const Area a = area(c.reevaluate_for_view, c.radius_km, c.contour_m, c.above, mola);
    EXPECT_LT(off_deg(a.middle, c.mola), 0.1) << c.name;
  }
  EXPECT_NEAR(area({147.21, 25.02}, 350, 1500, true, mola).diameter_km, 401, 20);
  EXPECT_NEAR(area({250.40, 40.47}, 600, 4350, true, mola).diameter_km, 540, 27);
}

}  // namespace
}  // namespace mars
