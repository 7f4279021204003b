// Real products: known heights, all drivers, insets that agree with the globe.
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <thread>

#include "mars/geodesy/sphere.h"
#include "mars/sources/adjusted.h"
#include "mars/sources/combine.h"
#include "mars/sources/source.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

using source_files::height_at;

TEST(RealData, Mola4KnownHeights) {
  VPE_NEED_SHARED(path, "mola4/megt90n000cb.lbl");
  const auto source = mars::open_elevation(path.string());
  EXPECT_EQ(source->infos().at(0).datum, mars::VerticalDatum::areoid());
  EXPECT_EQ(source->infos().at(0).quantum_m, 1);
  EXPECT_NEAR(source->infos().at(0).resolution_m, 14818.67, 0.1);
  // 1/4 degree posts: these are pixel centres.
  EXPECT_NEAR(height_at(*source, {226.875, 17.375}), 21134, 1e-6);
  EXPECT_NEAR(height_at(*source, {62.125, -32.875}), -8068, 1e-6);
  // Anywhere else the nearest pixels' values bound it.
  EXPECT_NEAR(height_at(*source, {312.05, 22.27}), -3613, 60);
}

TEST(RealData, Mola8KnownHeights) {
  VPE_NEED_SHARED(path, "mola8/mola8_topo.lbl");
  const auto source = mars::open_elevation(path.string());
  EXPECT_NEAR(height_at(*source, {1815.5 / 8, 90 - 580.5 / 8}), 21128, 1e-6);
  EXPECT_NEAR(height_at(*source, {1815.5 / 8, 90 - 581.5 / 8}), 21156, 1e-6);
  EXPECT_NEAR(height_at(*source, {62.1875, -32.8125}), -8130, 1e-6);
  // The pixels that hold Bradbury Landing and the Viking 1 lander.
  EXPECT_NEAR(height_at(*source, {1099.5 / 8, 90 - 756.5 / 8}), -4476, 1e-6);
  EXPECT_NEAR(height_at(*source, {2496.5 / 8, 90 - 541.5 / 8}), -3635, 1e-6);
}

TEST(RealData, EveryPostOfMola4IsGdalsOwn) {
  VPE_NEED_SHARED(path, "mola4/megt90n000cb.lbl");
  const auto source = mars::open_elevation(path.string());
  GDALDataset* dataset = GDALDataset::FromHandle(GDALOpen(path.c_str(), GA_ReadOnly));
  ASSERT_NE(dataset, nullptr);
  std::vector<std::int16_t> values(1440 * 720);
  ASSERT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 1440, 720, values.data(), 1440, 720, GDT_Int16,
                                                0, 0, nullptr),
            CE_None);
  GDALClose(dataset);
  std::size_t at = 0;
  std::vector<double> sampled;
  double worst_m = 0;
  source->visit_posts(values.size(),
                      [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
                        sampled.resize(directions.size());
                        source->sample(directions, 1, sampled);
                        for (std::size_t i = 0; i < directions.size(); ++i, ++at) {
                          ASSERT_EQ(heights_m[i], values[at]);
                          worst_m = std::max(worst_m, std::abs(sampled[i] - values[at]));
                        }
                      });
  EXPECT_EQ(at, values.size());
  EXPECT_LE(worst_m, 1e-6);  // rounding of longitude and latitude on the steepest post
}

TEST(RealData, ArchiveConventionOfMola4IsTheSamePlanet) {
  VPE_NEED_SHARED(path, "mola4/megt90n000cb.lbl");
  const test_support::TempDir folder;
  std::ifstream in(path);
  std::string label((std::istreambuf_iterator<char>(in)), {});
  for (const auto& [from, to] : {std::pair{"359.5 <", "360.5 <"},
                                 {"719.5 <", "720.5 <"},
                                 {"3396.19", "3396.0"},
                                 {"14.818674380827", "14.818"}}) {
    for (std::size_t at = label.find(from); at != std::string::npos; at = label.find(from, at + 1)) {
      label.replace(at, std::strlen(from), to);
    }
  }
  source_files::write_text(folder / "a.lbl", label);
  std::filesystem::create_symlink(path.parent_path() / "megt90n000cb.img", folder / "megt90n000cb.img");
  const auto written = mars::open_elevation(path.string());
  const auto archive = mars::open_elevation((folder / "a.lbl").string());
  test_support::Random random(1);
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < 20000; ++i) directions.push_back(random.direction());
  std::vector<double> a(directions.size());
  std::vector<double> b(directions.size());
  written->sample(directions, 1, a);
  archive->sample(directions, 1, b);
  EXPECT_EQ(a, b);
}

TEST(RealData, AreoidIsARadius) {
  VPE_NEED_SHARED(path, "mola8/mola8_areoid.lbl");
  const auto source = mars::open_elevation(path.string());
  EXPECT_EQ(source->infos().at(0).datum, mars::VerticalDatum::radius());
  const double pole_m = height_at(*source, {0, 90});
  EXPECT_GT(pole_m, 3376000);
  EXPECT_LT(pole_m, 3380000);
  EXPECT_GT(height_at(*source, {0, 0}), 3395000);
}

// 1 m posts over posts of 7.4 km: 104 m of relief between two of them, which is no other datum. Offsets of the
// spheres and areoids in use are refused all the same.
TEST(RealData, ReliefBetweenPostsIsNoOtherDatum) {
  VPE_NEED_SHARED(mola, "mola8/mola8_topo.lbl");
  VPE_NEED_SHARED(rover, "gale-hirise1/missionDEM.tif");
  VPE_NEED_SHARED(ctx, "gale-ctx20/gale_ctx20_mosaic.tif");
  VPE_NEED_SHARED(region, "gale-mola128/gale_megt128.lbl");
  const auto globe = mars::open_elevation(mola.string());
  const auto fits = [&](const std::filesystem::path& path, double off_m) {
    const auto inset = mars::adjusted(
        mars::open_elevation(path.string()),
        [off_m](std::span<const glm::dvec3>, std::span<double> heights_m) {
          for (double& height : heights_m) height += off_m;
        },
        {}, "");
    try {
      mars::combine_elevation({globe, inset}, {});
      return true;
    } catch (const mars::SourceError& e) {
      EXPECT_NE(std::string(e.what()).find("does not state its vertical datum"), std::string::npos) << e.what();
      return false;
    }
  };
  for (const auto& path : {rover, ctx, region}) EXPECT_TRUE(fits(path, 0)) << path;
  for (const double off_m : {-590.0, -190.0, 590.0}) {
    for (const auto& path : {rover, ctx, region}) EXPECT_FALSE(fits(path, off_m)) << path << ' ' << off_m;
  }
  // The rover's ground is 104 m below the base's facet; 190 m higher it is nearer to it.
  for (const auto& path : {ctx, region}) EXPECT_FALSE(fits(path, 190)) << path;
}

TEST(RealData, GaleInsetsAgreeWithMola) {
  VPE_NEED_SHARED(mola, "mola8/mola8_topo.lbl");
  const auto globe = mars::open_elevation(mola.string());
  struct Inset {
    const char* path;
    mars::LonLat place;
    double low_m, high_m, resolution_m;
  };
  for (const Inset& inset : {Inset{"gale-mola128/gale_megt128.lbl", {137.4417, -4.5895}, -4520, -4480, 463.08},
                             Inset{"gale-ctx20/gale_ctx20_mosaic.tif", {137.4417, -4.5895}, -4540, -4460, 20},
                             Inset{"gale-hirise1/missionDEM.tif", {137.37024, -4.66798364}, -4447.5, -4446, 1},
                             Inset{"pds3-sinu/gale_dtm_sinu.lbl", {137.4417, -4.5895}, -4520, -4480, 463}}) {
    const auto path = test_support::shared_data(inset.path);
    if (path.empty()) continue;
    const auto source = mars::open_elevation(path.string());
    EXPECT_NEAR(source->infos().at(0).resolution_m, inset.resolution_m, 0.01) << inset.path;
    const double height = height_at(*source, inset.place);
    EXPECT_GT(height, inset.low_m) << inset.path;
    EXPECT_LT(height, inset.high_m) << inset.path;
    EXPECT_TRUE(std::isnan(height_at(*source, {-40, 30}))) << inset.path;
    EXPECT_EQ(source->spacing_in({mars::direction(inset.place), 0}), source->infos().at(0).resolution_m);
    EXPECT_TRUE(std::isinf(source->spacing_in({mars::direction({-40, 30}), 0.01})));
    // No shift against the globe: the mean difference over the posts is small against the relief of kilometres.
    double sum = 0;
    double count = 0;
    source->visit_posts(2000, [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
      std::vector<double> below(directions.size());
      globe->sample(directions, 1, below);
      for (std::size_t i = 0; i < below.size(); ++i, ++count) sum += heights_m[i] - below[i];
    });
    EXPECT_GT(count, 500);
    EXPECT_LT(std::abs(sum / count), 150) << inset.path;
  }
}

TEST(RealData, SinusoidalAgreesWithItsCylindricalOriginal) {
  VPE_NEED_SHARED(sinusoidal_path, "pds3-sinu/gale_dtm_sinu.lbl");
  VPE_NEED_SHARED(cylindrical_path, "gale-mola128/gale_megt128.lbl");
  const auto sinusoidal = mars::open_elevation(sinusoidal_path.string());
  const auto cylindrical = mars::open_elevation(cylindrical_path.string());
  test_support::Random random(4);
  double sum = 0;
  double squares = 0;
  const int count = 5000;
  for (int i = 0; i < count; ++i) {
    const mars::LonLat p{random.uniform(135, 141), random.uniform(-8.5, -2.5)};
    const double off = height_at(*sinusoidal, p) - height_at(*cylindrical, p);
    sum += off;
    squares += off * off;
  }
  EXPECT_LT(std::abs(sum / count), 1);
  EXPECT_LT(std::sqrt(squares / count), 15);  // two interpolations; one pixel of shift would give over 60
}

TEST(RealData, Isis3CubeAndPdsImagesOpen) {
  VPE_NEED_SHARED(cube, "isis3-sinu-moc/E0201461.tiny.cub");
  const auto source = mars::open_elevation(cube.string());
  const double value = height_at(*source, {141.5712, 34.2683});
  EXPECT_GT(value, 0.08);
  EXPECT_LT(value, 0.23);
  for (const char* name :
       {"pds3-sinu/gale_image_sinu.img", "pds3-sinu/tharsis_mdim_sinu.img", "gale-hrsc/gale_texture.vrt",
        "isis3-sinu-moc/E0201461.tiny.cub", "gale-hirise1/gale_hirise_ortho_050cm.tif",
        "pds3-sinu/real/h6541_0000_ir4_cropped.img", "mdim21/mdim21_2880.vrt"}) {
    const auto path = test_support::shared_data(name);
    if (path.empty()) continue;
    const auto image = mars::open_image(path.string());
    EXPECT_GT(image->infos().at(0).resolution_m, 0.1) << name;
    EXPECT_LT(image->infos().at(0).resolution_m, 8000) << name;
  }
}

TEST(RealData, MdimIsRedAndItsCapsAreBright) {
  VPE_NEED_SHARED(path, "mdim21/mdim21_2880.vrt");
  const auto image = mars::open_image(path.string());
  const auto look = [&](mars::LonLat p) {
    const glm::dvec3 d = mars::direction(p);
    vpe::base::Rgb colour;
    std::uint8_t alpha = 0;
    image->sample({&d, 1}, 60000, {&colour, 1}, {&alpha, 1});
    EXPECT_EQ(alpha, 255);
    return colour;
  };
  const vpe::base::Rgb arabia = look({20, 20});
  EXPECT_GT(arabia.r, arabia.b + 40);
  EXPECT_GT(look({0, 88}).b, arabia.b);
  EXPECT_GT(arabia.r, look({68, 9}).r + 20);  // Syrtis Major is dark
}

TEST(RealData, EightThreadsOneResult) {
  VPE_NEED_SHARED(path, "mola8/mola8_topo.lbl");
  test_support::Random random(14);
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < 30000; ++i) directions.push_back(random.direction());
  std::vector<double> expected(directions.size());
  mars::open_elevation(path.string())->sample(directions, 1, expected);
  const auto source = mars::open_elevation(path.string());
  std::vector<std::vector<double>> results(8, std::vector<double>(directions.size()));
  std::vector<std::thread> threads;
  for (auto& result : results) {
    threads.emplace_back([&] { source->sample(directions, 1, result); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& result : results) EXPECT_EQ(result, expected);
}

TEST(RealData, InsetsFadeIntoTheGlobe) {
  VPE_NEED_SHARED(mola, "mola8/mola8_topo.lbl");
  VPE_NEED_SHARED(ctx, "gale-ctx20/gale_ctx20_mosaic.tif");
  const auto globe = mars::open_elevation(mola.string());
  const auto inset = mars::open_elevation(ctx.string());
  const auto stack = mars::stack_elevation({globe, inset});
  const double post_deg = 20 / (mars::kMarsRadius_m * mars::kRadiansPerDegree);
  int inside = 0;
  for (double lat = -5.05; lat < -4.33; lat += 0.08) {
    double before = height_at(*stack, {137.25, lat});
    for (double lon = 137.25; lon < 137.56; lon += post_deg / 10) {
      const double height = height_at(*stack, {lon, lat});
      // A tenth of a post of 20 m: cliffs of 60 degrees and the rim's ramp both stay below this.
      EXPECT_LT(std::abs(height - before), 40) << lon << " " << lat;
      before = height;
      if (!std::isnan(height_at(*inset, {lon, lat}))) ++inside;
    }
  }
  EXPECT_GT(inside, 10000);
}

// The CTX DTM above the sphere lies 594 m below MOLA's heights at Gale; the same above the areoid agrees.
TEST(RealData, ASilentDtmAboveTheSphereIsRefusedOverMola) {
  const std::string pair = "gale-ctx20/B01_009861_1753_XI_04S222W__B06_011984_1754_XN_04S222W-DEM";
  VPE_NEED_SHARED(mola, "mola8/mola8_topo.lbl");
  VPE_NEED_SHARED(sphere, pair + ".tif");
  VPE_NEED_SHARED(areoid, pair + "-geoid-adj.tif");
  const test_support::TempDir folder;
  const auto message = [&](const std::filesystem::path& file, const std::string& name) -> std::string {
    std::filesystem::copy_file(file, folder / name);
    try {
      mars::combine_elevation(
          {mars::open_elevation(mola.string()), mars::open_elevation((folder / name).string())}, {});
    } catch (const mars::SourceError& error) {
      return error.what();
    }
    return "";
  };
  const std::string refused = message(sphere, "s.tif");
  EXPECT_NE(refused.find("s.tif does not state its vertical datum"), std::string::npos) << refused;
  EXPECT_NE(refused.find("lies 594."), std::string::npos) << refused;
  EXPECT_EQ(message(areoid, "a.tif"), "");
  EXPECT_NE(message(sphere, sphere.filename().string()).find("'sphere:3396190'"), std::string::npos);
}

}  // namespace
