// Panoramas of triangles: the same ground as by rays, and no seams.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "panorama/metadata/open_panorama.h"
#include "panorama/panorama_plan.h"
#include "tests/app/support/app_fixture.h"
#include "tests/app/support/tiff_numbers.h"
#include "tests/paging/rough_planet.h"
#include "vpe/core/frame.h"
#include "vpe/core/image/image.h"
#include "vpe/core/metrics.h"

namespace app_test {
namespace {

using vpe::core::ShiftSummary;

struct Place {
  std::string at;
  std::string height_m;
  std::string text() const { return at + " at " + height_m + " m"; }
};

// Reads a range layer with the sky as in frames.
std::vector<float> read_range(const std::filesystem::path& path) {
  std::vector<float> all = read_numbers<float>(path);
  std::replace_if(
      all.begin(), all.end(), [](float r) { return std::isnan(r); }, vpe::core::kSkyRange);
  return all;
}

struct Agreement {
  ShiftSummary rays_in_triangles;  // every hit of the rays, looked for in the triangles' image
  ShiftSummary triangles_in_rays;  // the other way round
};

// Differences between neighbouring columns.
struct Seams {
  double seam = 0;     // mean of all seams
  double inside = 0;   // mean of the columns about them
  double largest = 0;  // of the columns' means at one distance from their seams
};

// Mean difference between a column and the one before, over all rows and channels.
double step_at(const vpe::core::RgbImage& image, int column) {
  const int before = (column + image.width - 1) % image.width;
  double sum = 0;
  for (int y = 0; y < image.height; ++y) {
    const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
    const vpe::base::Rgb a = image.pixels[row + static_cast<std::size_t>(before)];
    const vpe::base::Rgb b = image.pixels[row + static_cast<std::size_t>(column % image.width)];
    sum += std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
  }
  return sum / (3.0 * image.height);
}

constexpr int kReach = 15;

// Of several images of eight facets, the same number of columns about each seam.
Seams seams_of(const std::vector<vpe::core::RgbImage>& images) {
  Seams seams;
  for (int n = -kReach; n <= kReach; ++n) {
    double step = 0;
    for (const vpe::core::RgbImage& image : images) {
      for (int k = 0; k < 8; ++k) step += step_at(image, (image.width / 8 * k + n + image.width) % image.width);
    }
    step /= 8.0 * static_cast<double>(images.size());
    if (n == 0) {
      seams.seam = step;
    } else {
      seams.inside += step / (2 * kReach);
      seams.largest = std::max(seams.largest, step);
    }
  }
  return seams;
}

const Words kTriangles{"--backend", "polygon", "--tolerance", "0.5"};
const Words kFacetsOfRays{"--projection", "facets"};

class PolygonPanorama : public AppTest {
 protected:
  void make(const std::string& planet, const Place& place, const std::string& output, int width,
            const Words& more) const {
    Words words{"panorama",
                planet,
                "--at",
                place.at,
                "--height",
                place.height_m,
                "-o",
                output,
                "-q",
                "--width",
                std::to_string(width),
                "--aux-layers",
                "range",
                "--elevation=-40,25"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    ASSERT_EQ(result.exit_code, 0) << place.text() << ": " << result.err;
  }

  // Eight facets of triangles, and the cylinder of rays four times as fine, so that its nearest pixel to a
  // facet's is at most an eighth of that away. Shifts are in pixels of the facets.
  Agreement agreement(const std::string& planet, const Place& place, int width) const {
    constexpr int kFiner = 4;
    make(planet, place, "f.png", width, kTriangles);
    make(planet, place, "c.png", kFiner * width, {});
    const auto described = panorama::describe(dir_ / "f.png");
    const panorama::PanoramaMap facets = described.map;
    const panorama::PanoramaMap cylinder = panorama::describe(dir_ / "c.png").map;
    EXPECT_EQ(facets.kind, panorama::MapKind::kFacets);
    EXPECT_EQ(facets.facets, 8);
    const auto triangles = read_range(dir_ / "f.range.tif");
    const auto rays = read_range(dir_ / "c.range.tif");
    const panorama::Viewpoint viewpoint =
        panorama::viewpoint_at({described.viewpoint->lon_deg, described.viewpoint->lat_deg},
                               *described.viewpoint->alt_m, mars::kMarsRadius_m);
    std::vector<double> forth;
    std::vector<double> back;
    for (const panorama::Strip& strip : panorama::strips_of(facets)) {
      for (const panorama::Piece& piece : panorama::pieces_of(facets, viewpoint, strip, 0)) {
        std::vector<float> by_triangles;
        std::vector<float> by_rays;
        for (int y = 0; y < piece.height; ++y) {
          for (int x = 0; x < piece.width; ++x) {
            const auto index = static_cast<std::size_t>((piece.y + y) * facets.width_px + piece.x + x);
            by_triangles.push_back(triangles[index]);
            const auto at = cylinder.to_pixel(facets.to_direction(static_cast<double>(piece.x + x) + 0.5,
                                                                  static_cast<double>(piece.y + y) + 0.5));
            // Facets reach the requested elevations in their middles, and less beside them.
            if (!at) throw std::runtime_error("the cylinder does not show what a facet shows");
            const auto column = std::min(static_cast<std::int64_t>(at->x), cylinder.width_px - 1);
            const auto row = std::min(static_cast<std::int64_t>(at->y), cylinder.height_px - 1);
            by_rays.push_back(rays[static_cast<std::size_t>(row * cylinder.width_px + column)]);
          }
        }
        const auto a = vpe::core::backward_shift_px(piece.view, by_triangles, by_rays);
        const auto b = vpe::core::backward_shift_px(piece.view, by_rays, by_triangles);
        forth.insert(forth.end(), a.begin(), a.end());
        back.insert(back.end(), b.begin(), b.end());
      }
    }
    // Pieces stand side by side, so that worst_x and worst_y have no meaning here.
    return {vpe::core::summarize(forth, 1), vpe::core::summarize(back, 1)};
  }

  void expect_agreement(const std::string& planet, const std::vector<Place>& places, int width) const {
    for (const Place& place : places) {
      const Agreement found = agreement(planet, place, width);
      SCOPED_TRACE(place.text());
      EXPECT_GT(found.rays_in_triangles.pixels, width * 100);
      EXPECT_LE(found.rays_in_triangles.share_over_1px, 0.005);
      EXPECT_LE(found.triangles_in_rays.share_over_1px, 0.005);
      EXPECT_GT(found.rays_in_triangles.median_px, 0);  // they are two images
      for (const ShiftSummary& s : {found.rays_in_triangles, found.triangles_in_rays}) {
        std::printf("%-32s median %.3f, 99 %% %.3f, 99.9 %% %.3f, largest %.2f px; over 1 px %.4f %% of %lld\n",
                    place.text().c_str(), s.median_px, s.p99_px, s.p999_px, s.max_px, 100 * s.share_over_1px,
                    static_cast<long long>(s.pixels));
      }
    }
  }

  // Both backends: facets of rays differ from view to view as those of triangles do.
  void expect_no_seams(const std::string& planet, const std::vector<Place>& places, double at_most) const {
    for (const Words& backend : {kTriangles, kFacetsOfRays}) {
      std::vector<vpe::core::RgbImage> images;
      for (const Place& place : places) {
        Words more = backend;
        more.insert(more.end(), {"--set", "sun.elevation=15", "--set", "shading=flat"});
        make(planet, place, "f.png", 1600, more);
        images.push_back(vpe::core::read_image(dir_ / "f.png"));
        ASSERT_EQ(images.back().width, 1600);
      }
      const Seams seams = seams_of(images);
      EXPECT_GT(seams.inside, 0.5);  // there is something to see
      EXPECT_LE(seams.seam, seams.largest) << backend[1];
      EXPECT_LE(seams.seam, at_most * seams.inside) << backend[1];
      std::printf("%s: step at seams %.3f, about them %.3f, largest mean %.3f\n", backend[1].c_str(),
                  seams.seam, seams.inside, seams.largest);
    }
  }
};

TEST_F(PolygonPanorama, EightFacetsAgreeWithTheCylinderOfRays) {
  expect_agreement(planet().string(), {{"10,5", "4000"}}, 800);
}

TEST_F(PolygonPanorama, SeamsAreNotSeen) {
  test_support::build_rough(dir_ / "rough.vpe");
  expect_no_seams("rough.vpe", {{"-70,-11.1", "3000"}}, 1.2);
}

// On one machine: triangles differ between drivers. Under a hard cap of triangles the camera may be within the
// error of the ground, so that no number of pixels bounds it: that is no reason to draw again.
TEST_F(PolygonPanorama, ResumedAfterASignalItIsTheSame) {
  const Words capped{"--height", "1", "--set", "lod.triangles=60"};
  for (const Words& camera : {Words{"--height", "4000", "--aux-layers", "range"}, capped}) {
    // Wide enough for three strips.
    Words words{
        "panorama", planet().string(),       "--at",      "10,5",   "-o", "p.tif", "-q", "--json", "--width",
        "18000",    "--elevation=-3.2,-1.8", "--backend", "polygon"};
    words.insert(words.end(), camera.begin(), camera.end());
    const Result whole = vpe(words);
    ASSERT_EQ(whole.exit_code, 0) << whole.err;
    EXPECT_EQ(parse_json(whole.out)["shift_bound_px"].is_null(), camera == capped);
    const std::string panorama_image = read_text(dir_ / "p.tif");
    const std::string range = camera == capped ? "" : read_text(dir_ / "p.range.tif");
    const std::string error = parse_json(read_text(dir_ / "p.json"))["error"].dump();
    std::filesystem::remove(dir_ / "p.tif");
    std::filesystem::remove(dir_ / "p.range.tif");

    Command command = command_for(words);
    command.signal = SIGINT;
    command.when = [&] { return exists("p.tif.parts/strip_000000"); };
    const Result stopped = run(command);
    ASSERT_TRUE(stopped.signalled);
    EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
    EXPECT_FALSE(exists("p.tif"));

    const Result resumed = vpe(words);
    ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
    const auto report = parse_json(resumed.out);
    EXPECT_GE(report["strips_kept"], 1);
    EXPECT_EQ(report["strips_kept"].get<int>() + report["strips_made"].get<int>(), 3);
    EXPECT_TRUE(read_text(dir_ / "p.tif") == panorama_image);
    if (camera != capped) {
      EXPECT_TRUE(read_text(dir_ / "p.range.tif") == range);
    }
    std::filesystem::remove(dir_ / "p.range.tif");
    EXPECT_EQ(parse_json(read_text(dir_ / "p.json"))["error"].dump(), error);
    EXPECT_FALSE(exists("p.tif.parts"));
  }
}

// Planets that are there already, of real ground.
class LongPolygonPanorama : public PolygonPanorama {
 protected:
  static constexpr int kWidth = 1600;

  // Canyons, a volcano's flank and scarp, a basin, plains, poles, the seam of longitudes.
  static std::vector<Place> over_mars() {
    return {{"-70,-11.1", "2"},  {"-70,-11.1", "500"},   {"-61.5,-13", "10000"}, {"-134.3,18.2", "2"},
            {"-131,18", "3000"}, {"137.37,-4.67", "50"}, {"70,-42", "10"},       {"180,30", "100"},
            {"0,90", "200"},     {"45,-90", "1000"},     {"-40,-5", "2000"},     {"20,10", "10000"}};
  }
  // About the place of the rover's mosaic of sol 1051.
  static std::vector<Place> over_gale() {
    return {{"137.37024,-4.66798364", "1.97"},
            {"137.37024,-4.66798364", "10"},
            {"137.4417,-4.5895", "2"},
            {"137.4417,-4.5895", "100"},
            {"137.38,-4.72", "20"},
            {"137.6,-4.9", "300"},
            {"137.8,-5.1", "2000"},
            {"137.2,-5.4", "10000"}};
  }
};

// $VPE_EMBEDDED_PLANET names a planet file of the embedded Mars.
TEST_F(LongPolygonPanorama, FacetsOfTheEmbeddedMarsAreTheRays) {
  const char* ready = std::getenv("VPE_EMBEDDED_PLANET");
  if (ready == nullptr) GTEST_SKIP() << "skipped: $VPE_EMBEDDED_PLANET names no planet file";
  expect_agreement(ready, over_mars(), kWidth);
}
TEST_F(LongPolygonPanorama, SeamsOfTheEmbeddedMarsAreNotSeen) {
  const char* ready = std::getenv("VPE_EMBEDDED_PLANET");
  if (ready == nullptr) GTEST_SKIP() << "skipped: $VPE_EMBEDDED_PLANET names no planet file";
  expect_no_seams(ready, over_mars(), 1.1);
}

// $VPE_GALE_PLANET names a planet file with fine ground and imagery at Gale (docs/data.md has the command).
TEST_F(LongPolygonPanorama, FacetsOverGaleAreTheRays) {
  const char* ready = std::getenv("VPE_GALE_PLANET");
  if (ready == nullptr) GTEST_SKIP() << "skipped: $VPE_GALE_PLANET names no planet file";
  expect_agreement(ready, over_gale(), kWidth);
}
TEST_F(LongPolygonPanorama, SeamsOverGaleAreNotSeen) {
  const char* ready = std::getenv("VPE_GALE_PLANET");
  if (ready == nullptr) GTEST_SKIP() << "skipped: $VPE_GALE_PLANET names no planet file";
  expect_no_seams(ready, over_gale(), 1.1);
}

}  // namespace
}  // namespace app_test
