// Tests of datum conversion, vertical alignment, edge matching, outliers and feathering.
#include "mars/sources/combine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "mars/sources/adjusted.h"
#include "mars/sources/convert.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

using mars::Combined;
using mars::CombineOptions;
using mars::ElevationSource;
using mars::LonLat;
using mars::VerticalDatum;
using source_files::box;
using source_files::height_at;
using source_files::Raster;
using Source = std::shared_ptr<const ElevationSource>;

// Returns gentle hills, the same in every raster.
double hills(LonLat p) {
  return 800 * std::sin(0.7 * p.lon_deg) * std::cos(0.9 * p.lat_deg) +
         90 * std::sin(9 * p.lon_deg + 7 * p.lat_deg);
}

struct Area {
  double west = 0, north = 0, east = 0, south = 0;
  int width = 0, height = 0;
  LonLat at(int column, int row) const {
    return {west + (column + 0.5) * (east - west) / width, north + (row + 0.5) * (south - north) / height};
  }
};
constexpr Area kBase{-20, 20, 20, -20, 800, 800};   // 3 km
constexpr Area kInset{-2, 2.4, 1, -0.6, 600, 600};  // 300 m

class Combine : public ::testing::Test {
 protected:
  Source raster(const std::string& name, const Area& area, const std::function<double(LonLat)>& height,
                const VerticalDatum& datum = VerticalDatum::areoid(),
                const std::string& crs = source_files::kSphere) {
    Raster r;
    r.width = area.width;
    r.height = area.height;
    r.crs = crs;
    r.type = GDT_Float64;
    r.geotransform = box(area.west, area.north, area.east, area.south, area.width, area.height);
    r.value = [&](int, int column, int row) { return height(area.at(column, row)); };
    const Source source = mars::open_elevation(source_files::write(dir_ / (name + ".tif"), r));
    if (!datum.is_known() || source->infos().front().datum == datum) return source;
    return mars::adjusted(
        source, [](std::span<const glm::dvec3>, std::span<double>) {}, datum, "");
  }
  std::string message(const std::vector<Source>& sources, const CombineOptions& options = {}) {
    try {
      mars::combine_elevation(sources, options);
    } catch (const mars::SourceError& error) {
      return error.what();
    }
    return {};
  }
  static void expect_parts(const std::string& message, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) {
      EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
    }
  }

  static CombineOptions converting() {
    CombineOptions options;
    options.convert = true;
    return options;
  }

  test_support::TempDir dir_;
};

TEST_F(Combine, OtherDatumsAreRefusedWithTheirDifference) {
  const Source base = raster("base", kBase, hills);
  const Source inset = raster(
      "inset", kInset, [](LonLat p) { return hills(p) - 556; }, VerticalDatum::sphere(3396190));
  expect_parts(message({base, inset}),
               {"base.tif", "'areoid'", "inset.tif", "'sphere:3396190'", "556.", "--to-datum"});
  expect_parts(message({base, inset}, converting()), {"inset.tif", "areoid", "--areoid"});
  // Spheres that differ by 190 m are other datums too.
  const Source sphere = raster("s", kBase, hills, VerticalDatum::sphere(3396000));
  expect_parts(message({sphere, inset}), {"'sphere:3396000'", "'sphere:3396190'"});
  // A raster elsewhere on the planet has nothing to compare, and is refused all the same.
  const Source far = raster("far", {100, 20, 110, 10, 50, 50}, hills, VerticalDatum::radius());
  expect_parts(message({base, far}), {"no place in common"});
}

TEST_F(Combine, UnknownDatumsAreReported) {
  const Source base = raster("base", kBase, hills);
  const Source inset = raster("inset", kInset, hills, {});
  const Combined combined = mars::combine_elevation({base, inset}, {});
  ASSERT_EQ(combined.notes.size(), 1U);
  expect_parts(combined.notes[0], {"inset.tif", "'areoid'", "--datum"});
  for (const mars::SourceInfo& info : combined.source->infos()) EXPECT_EQ(info.datum, VerticalDatum::areoid());
  expect_parts(message({base, inset}, converting()), {"inset.tif", "not known", "--datum"});
  EXPECT_FALSE(mars::combine_elevation({inset}, {}).datum.is_known());
}

// A sphere and the areoid differ by kilometres: a raster that states neither cannot join another in silence.
TEST_F(Combine, SilentDatumsThatDifferAreRefused) {
  const auto lower = [](LonLat p) { return hills(p) - 590; };
  const Source base = raster("base", kBase, hills);
  const Source silent_base = raster("silent_base", kBase, hills, {});
  const Source inset = raster("inset", kInset, lower, {});
  const Source known_inset = raster("known_inset", kInset, lower);
  expect_parts(message({base, inset}),
               {"inset.tif does not state its vertical datum", "lies 590.", "base.tif", "median of",
                "robust spread", "--datum inset.tif=areoid or", "sphere:RADIUS_M", "--to-datum"});
  // The one that does not state it is named, whichever is finer.
  expect_parts(message({silent_base, known_inset}),
               {"silent_base.tif does not state", "inset.tif lies 590.", "--datum silent_base.tif=areoid"});
  expect_parts(message({silent_base, inset}),
               {"inset.tif does not state", " m below", "--datum inset.tif=same"});
  // Also below others that agree.
  const Source middle = raster("middle", {-3, 3.4, 2, -1.6, 500, 500}, hills);
  expect_parts(message({base, middle, inset}), {"inset.tif does not state", "middle.tif"});
  // Both ways out: its datum, or that it is that of the others.
  EXPECT_EQ(message({base, known_inset}), "");
  CombineOptions options;
  options.same_datum = {inset->infos().front().name};
  EXPECT_EQ(message({silent_base, inset}, options), "");
  EXPECT_EQ(mars::combine_elevation({silent_base, inset}, options).notes.size(), 1U);  // about the base
}

TEST_F(Combine, SilentDatumsAreRefusedByFigure) {
  const Source base = raster("base", kBase, [](LonLat) { return 100.0; });
  const auto refused = [&](double off_m, double noise_m) {
    test_support::Random random(3);
    const Source inset = raster("i" + std::to_string(off_m) + "_" + std::to_string(noise_m), kInset,
                                [&](LonLat) { return 100 + off_m + random.uniform(-noise_m, noise_m); }, {});
    return !message({base, inset}).empty();
  };
  // Without noise the spread counts as 10 m: 30 m are accepted.
  EXPECT_FALSE(refused(29, 0));
  EXPECT_TRUE(refused(31, 0));
  EXPECT_TRUE(refused(-31, 0));
  // Uniform noise of +-100 m has a robust spread of 74 m: 50 m are accepted.
  EXPECT_FALSE(refused(45, 100));
  EXPECT_TRUE(refused(55, 100));
}

TEST_F(Combine, NamesOfCtxProductsDecideWhenNothingElseDoes) {
  const std::string pair = "B01_009861_1753_XI_04S222W__B06_011984_1754_XN_04S222W";
  const Source sphere = raster(pair + "-DEM", kInset, hills, {});
  const Source areoid = raster(pair + "-DEM-geoid-adj", kInset, hills, {});
  EXPECT_EQ(sphere->infos().front().datum, VerticalDatum::sphere(3396190));
  EXPECT_EQ(areoid->infos().front().datum, VerticalDatum::areoid());
  expect_parts(message({sphere, areoid}), {"'sphere:3396190'", "'areoid'", "--to-datum"});
  const Combined combined = mars::combine_elevation({areoid}, {});
  ASSERT_EQ(combined.notes.size(), 1U);
  expect_parts(combined.notes[0], {"-DEM-geoid-adj.tif: by its name alone", "'areoid'", "--datum"});
  // Names of others say nothing.
  EXPECT_FALSE(raster("my-DEM", kInset, hills, {})->infos().front().datum.is_known());
  EXPECT_FALSE(raster(pair + "-DEM-hs", kInset, hills, {})->infos().front().datum.is_known());
}

TEST_F(Combine, RadiiOfSmallBodiesAreNoHeights) {
  const std::string vesta = "+proj=longlat +R=255000 +no_defs";
  CombineOptions options;
  options.radius_m = 255'000;
  const auto radii = [](LonLat p) { return 255'000 + 20 * hills(p); };
  expect_parts(message({raster("r", kBase, radii, {}, vesta)}, options),
               {"r.tif", "255000", "distances from its centre", "--datum r.tif=radius"});
  EXPECT_EQ(message({raster("s", kBase, radii, VerticalDatum::radius(), vesta)}, options), "");
  expect_parts(message({raster("h", kBase, hills, VerticalDatum::radius(), vesta)}, options),
               {"h.tif", "no distances from its centre", "--datum h.tif="});
  EXPECT_EQ(message({raster("h", kBase, hills, {}, vesta)}, options), "");
}

TEST_F(Combine, ReliefBeyondTheRadiusIsNoted) {
  const std::string small = "+proj=longlat +R=3500 +no_defs";
  CombineOptions options;
  options.radius_m = 3500;
  const auto notes = [&](double step_m) {
    return mars::combine_elevation({raster(
                                       "b", kBase, [&](LonLat p) { return p.lon_deg > 3 ? step_m : 0; },
                                       VerticalDatum::sphere(3500), small)},
                                   options)
        .notes;
  };
  EXPECT_TRUE(notes(3400).empty());
  ASSERT_EQ(notes(65535).size(), 1U);
  expect_parts(notes(65535)[0], {"b.tif", "65535 m", "3500 m", "nodata"});
}

TEST_F(Combine, ConvertsThroughTheAreoid) {
  const auto areoid_radius = [](LonLat p) { return 3396000 + 40 * p.lon_deg + 25 * p.lat_deg; };
  const Source areoid = raster("areoid", kBase, areoid_radius, VerticalDatum::radius());
  const Source base = raster("base", kBase, hills);
  const Source inset = raster(
      "inset", kInset, [&](LonLat p) { return areoid_radius(p) + hills(p) - 3396190; },
      VerticalDatum::sphere(3396190));
  CombineOptions options;
  options.convert = true;
  options.areoid = areoid;
  Combined combined = mars::combine_elevation({inset, base}, options);
  EXPECT_EQ(combined.datum, VerticalDatum::areoid());
  const LonLat middle = kInset.at(300, 300);
  EXPECT_NEAR(height_at(*combined.source, middle), hills(middle), 1e-6);
  // To true radii both are converted.
  options.true_radii = true;
  combined = mars::combine_elevation({inset, base}, options);
  EXPECT_TRUE(combined.true_radii);
  EXPECT_EQ(combined.datum, VerticalDatum::sphere(mars::kMarsRadius_m));
  EXPECT_NEAR(height_at(*combined.source, middle), areoid_radius(middle) + hills(middle) - 3396190, 1e-6);
  const LonLat outside = kBase.at(700, 150);
  EXPECT_NEAR(height_at(*combined.source, outside), areoid_radius(outside) + hills(outside) - 3396190, 1e-6);
  for (const mars::SourceInfo& info : combined.source->infos()) {
    EXPECT_EQ(info.treatment.empty(), info.name.find("inset") != std::string::npos) << info.treatment;
  }
  // The raster of the areoid must state radii or heights above a known surface.
  options.areoid = raster("heights", kBase, hills);
  expect_parts(message({inset, base}, options), {"heights.tif", "areoid", "radii"});
}

TEST_F(Combine, RadiiBecomeHeightsAboveTheSphere) {
  const Source radii = raster(
      "r", kBase, [](LonLat p) { return 3396000 + hills(p); }, VerticalDatum::radius());
  const Combined combined = mars::combine_elevation({radii}, {});
  EXPECT_TRUE(combined.true_radii);
  EXPECT_EQ(combined.datum, VerticalDatum::sphere(mars::kMarsRadius_m));
  EXPECT_NEAR(height_at(*combined.source, kBase.at(70, 600)), hills(kBase.at(70, 600)) - 190, 1e-6);
}

TEST_F(Combine, OtherBodiesAreRefused) {
  const Source moon =
      raster("moon", kBase, hills, VerticalDatum::sphere(1737400), "+proj=longlat +R=1737400 +no_defs");
  EXPECT_EQ(moon->infos().front().body_radius_m, 1737400);
  expect_parts(message({moon}), {"moon.tif", "1737400", "3396190", "--body", "--radius"});
  CombineOptions options;
  options.radius_m = 1737400;
  EXPECT_EQ(message({moon}, options), "");
}

// An offset of 30 m and a tilt of 0.1 % are found within 1 %, and the planet shows neither.
TEST_F(Combine, OffsetAndTiltAreRecovered) {
  const LonLat centre{-0.5, 0.9};
  const mars::LocalFrame frame = mars::local_frame(centre);
  const double azimuth = 35 * mars::kRadiansPerDegree;
  const auto off = [&](LonLat p) {
    const glm::dvec3 d = mars::direction(p);
    const double arc_m = mars::kMarsRadius_m * mars::angle_between_rad(d, frame.up);
    const double bearing = std::atan2(glm::dot(d, frame.east), glm::dot(d, frame.north));
    return 30 + 0.001 * arc_m * std::cos(bearing - azimuth);
  };
  const Source base = raster("base", kBase, hills);
  const Source inset = raster("inset", kInset, [&](LonLat p) { return hills(p) + off(p); });
  CombineOptions options;
  options.alignment = CombineOptions::Alignment::kPlane;
  const Combined combined = mars::combine_elevation({base, inset}, options);
  ASSERT_EQ(combined.findings.size(), 2U);
  EXPECT_FALSE(combined.findings[0].alignment);
  ASSERT_TRUE(combined.findings[1].alignment);
  const mars::VerticalAlignment& alignment = *combined.findings[1].alignment;
  EXPECT_NEAR(alignment.offset_m, off(alignment.centre), 0.01 * 30);
  EXPECT_NEAR(std::hypot(alignment.tilt_east, alignment.tilt_north), 0.001, 1e-5);
  EXPECT_NEAR(std::atan2(alignment.tilt_east, alignment.tilt_north), azimuth, 0.01);
  EXPECT_GT(alignment.rms_before_m, 30);
  EXPECT_LT(alignment.rms_after_m, 3);  // the base's own interpolation of the small hills
  EXPECT_GT(alignment.posts, 10000);
  for (const auto& [column, row] : {std::pair{20, 30}, {580, 20}, {300, 300}, {15, 590}}) {
    const LonLat p = kInset.at(column, row);
    EXPECT_NEAR(height_at(*combined.source, p), hills(p), 2) << column << "," << row;
  }
  expect_parts(combined.source->infos()[0].treatment, {"levelled by", "tilt"});
}

// The inset keeps its heights and there is no step at its boundary: heights along lines across it are as smooth
// as the ground.
TEST_F(Combine, EdgeMatchingChangesTheBase) {
  const auto broad = [](LonLat p) { return 800 * std::sin(0.7 * p.lon_deg) * std::cos(0.9 * p.lat_deg); };
  const auto off = [](LonLat p) { return 25 + 8 * p.lon_deg + 5 * std::sin(3 * p.lat_deg); };
  const Source base = raster("base", kBase, broad);
  const Source inset = raster("inset", kInset, [&](LonLat p) { return broad(p) + off(p); });
  CombineOptions options;
  const double metre_deg = 1 / (mars::kMarsRadius_m * mars::kRadiansPerDegree);
  const auto worst_step = [&](const Source& source) {
    double worst = 0;
    for (const double lat : {-0.3, 0.4, 1.1, 2.2}) {
      for (double lon = -3; lon < -1.5; lon += 300 * metre_deg) {
        const auto above = [&](double x) { return height_at(*source, {x, lat}) - broad({x, lat}); };
        worst = std::max(worst, std::abs(above(lon + 300 * metre_deg) - above(lon)));
      }
    }
    return worst;
  };
  // The fade of 6 km turns a step of about 10 m into a slope of up to 1 m per post.
  const double before = worst_step(mars::combine_elevation({base, inset}, options).source);
  options.alignment = CombineOptions::Alignment::kEdges;
  const Combined combined = mars::combine_elevation({base, inset}, options);
  ASSERT_TRUE(combined.findings[1].edge_matching);
  EXPECT_NEAR(combined.findings[1].edge_matching->rms_m, 22, 5);
  EXPECT_GT(before, 2 * worst_step(combined.source));
  for (const auto& [column, row] : {std::pair{100, 100}, {300, 300}, {500, 420}}) {
    const LonLat p = kInset.at(column, row);
    EXPECT_NEAR(height_at(*combined.source, p), broad(p) + off(p), 1e-6);
  }
  // Far away nothing changes.
  const LonLat far = kBase.at(100, 100);
  EXPECT_EQ(height_at(*combined.source, far), height_at(*base, far));
}

TEST_F(Combine, AlignmentIsRobustAgainstOutliers) {
  const Source base = raster("base", kBase, hills);
  const Source inset =
      raster("inset", kInset, [](LonLat p) { return hills(p) + 12 - (p.lat_deg < -0.3 ? 1000 : 0); });
  CombineOptions options;
  options.alignment = CombineOptions::Alignment::kPlane;
  const Combined combined = mars::combine_elevation({base, inset}, options);
  ASSERT_TRUE(combined.findings[1].alignment);
  EXPECT_NEAR(combined.findings[1].alignment->offset_m, 12, 0.5);
  EXPECT_LT(std::hypot(combined.findings[1].alignment->tilt_east, combined.findings[1].alignment->tilt_north),
            1e-4);
  EXPECT_GT(combined.findings[1].alignment->left_out, 1000);
}

TEST_F(Combine, InsetsWithoutABaseAreNotAligned) {
  const Source base = raster("base", {10, 20, 20, 10, 200, 200}, hills);
  const Source inset = raster("inset", kInset, hills);
  CombineOptions options;
  options.alignment = CombineOptions::Alignment::kPlane;
  const Combined combined = mars::combine_elevation({base, inset}, options);
  EXPECT_FALSE(combined.findings[1].alignment);
  ASSERT_EQ(combined.notes.size(), 1U);
  expect_parts(combined.notes[0], {"inset.tif", "not aligned"});
}

// The inset has a terrace that is a kilometre too low and a spike, as stereo correlation makes them.
TEST_F(Combine, OutliersAreFoundAndRejected) {
  const auto is_terrace = [](LonLat p) {
    return p.lon_deg > 0.2 && p.lon_deg < 0.5 && p.lat_deg > 0 && p.lat_deg < 0.4;
  };
  const LonLat spike = kInset.at(100, 100);
  const Source base = raster("base", kBase, hills);
  const Source inset = raster("inset", kInset, [&](LonLat p) {
    const bool is_spike = std::hypot(p.lon_deg - spike.lon_deg, p.lat_deg - spike.lat_deg) < 1e-6;
    return hills(p) - (is_terrace(p) ? 1000 : 0) + (is_spike ? 2500 : 0);
  });
  CombineOptions options;
  Combined combined = mars::combine_elevation({base, inset}, options);
  ASSERT_TRUE(combined.findings[1].outliers);
  const mars::OutlierReport& report = *combined.findings[1].outliers;
  const double share = static_cast<double>(report.implausible) / static_cast<double>(report.posts);
  EXPECT_NEAR(share, 0.3 * 0.4 / 9.0, 2e-3);
  EXPECT_NEAR(report.worst_m, 2500, 60);
  EXPECT_NEAR(report.worst_at.lon_deg, spike.lon_deg, 1e-9);
  EXPECT_FALSE(combined.findings[1].masked);
  EXPECT_NEAR(height_at(*combined.source, {0.35, 0.2}), hills({0.35, 0.2}) - 1000, 1);

  options.reject_outliers = true;
  options.alignment = CombineOptions::Alignment::kPlane;  // the mask tests aligned heights
  combined = mars::combine_elevation({base, inset}, options);
  EXPECT_TRUE(combined.findings[1].masked);
  double worst = 0;
  for (int i = 0; i < 4000; ++i) {
    const LonLat p{-1.99 + 2.98 * (i % 63) / 62.0, -0.59 + 2.98 * (i / 63) / 63.0};
    worst = std::max(worst, std::abs(height_at(*combined.source, p) - hills(p)));
  }
  EXPECT_LT(worst, 60);  // the base's interpolation of the small hills
  expect_parts(combined.source->infos()[0].treatment, {"dropped"});
  // Good posts keep their heights.
  EXPECT_NEAR(height_at(*combined.source, {-1, 1}), hills({-1, 1}), 1);
}

TEST_F(Combine, SteepGroundIsNoOutlier) {
  // The base shows the cliff as a ramp.
  const auto cliff = [](LonLat p) { return p.lon_deg < 0.013 ? 0.0 : 2000.0; };
  const Source base = raster("base", kBase, cliff);
  const Source inset = raster("inset", kInset, cliff);
  const Combined combined = mars::combine_elevation({base, inset}, {});
  ASSERT_TRUE(combined.findings[1].outliers);
  EXPECT_EQ(combined.findings[1].outliers->implausible, 0);
}

TEST_F(Combine, FeatherInMetres) {
  const Source base = raster("base", kBase, [](LonLat) { return 0.0; });
  const Source inset = raster("inset", kInset, [](LonLat) { return 100.0; });
  CombineOptions options;
  options.stack.feather_m = 20000;
  const Source source = mars::combine_elevation({base, inset}, options).source;
  const double metre_deg = 1 / (mars::kMarsRadius_m * mars::kRadiansPerDegree);
  double last = 0;
  for (double inside_m = 200; inside_m < 40000; inside_m += 100) {
    const double h = height_at(*source, {-2 + inside_m * metre_deg, 0.9});
    EXPECT_GE(h, last - 1e-9) << inside_m;
    EXPECT_LT(h - last, 1.5) << inside_m;
    last = h;
    if (inside_m > 21000) {
      EXPECT_NEAR(h, 100, 1e-6);
    }
    if (inside_m < 18000) {
      EXPECT_LT(h, 99.9);
    }
  }
}

}  // namespace
