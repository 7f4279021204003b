// vpe panorama for two eyes, as a user runs it.
#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <random>

#include "panorama/metadata/open_panorama.h"
#include "tests/app/support/app_fixture.h"
#include "tests/paging/planet_fixture.h"
#include "tests/panorama/stereo_fixture.h"
#include "vpe/core/image/image.h"
#include "vpe/core/stereo.h"

namespace app_test {
namespace {

namespace fs = std::filesystem;
using panorama::Eye;
using vpe::core::RgbImage;

class StereoPanorama : public AppTest {
 protected:
  // Words of `more` replace the default ones.
  Words words(const std::string& output, const Words& more = {}) const {
    Words all{"panorama", planet().string(), "--at", "10,5", "--height", "4000", "-o", output, "-q"};
    for (const auto& [name, value] : {std::pair("--width", "500"), std::pair("--elevation", "-30,20")}) {
      if (std::none_of(more.begin(), more.end(),
                       [option = name](const std::string& w) { return w.starts_with(option); }))
        all.push_back(std::string(name) + "=" + value);
    }
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Result make(const std::string& output, const Words& more = {}) const {
    const Result result = vpe(words(output, more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result;
  }
};

RgbImage part_of(const RgbImage& image, int x, int y, int width, int height) {
  RgbImage part{width, height, {}};
  for (int row = 0; row < height; ++row) {
    const auto begin = image.pixels.begin() + (y + row) * image.width + x;
    part.pixels.insert(part.pixels.end(), begin, begin + width);
  }
  return part;
}

// Returns all numbers of a layer; tiles beyond the edges repeat them.
std::vector<float> read_layer(const fs::path& path) {
  const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFOpen(path.c_str(), "r"), TIFFClose);
  if (tiff == nullptr) throw std::runtime_error("cannot open " + path.string());
  std::vector<float> numbers;
  for (std::uint32_t n = 0; n < TIFFNumberOfTiles(tiff.get()); ++n) {
    std::vector<float> tile(static_cast<std::size_t>(TIFFTileSize(tiff.get())) / sizeof(float));
    if (TIFFReadEncodedTile(tiff.get(), n, tile.data(), -1) < 0) throw std::runtime_error("cannot read a tile");
    numbers.insert(numbers.end(), tile.begin(), tile.end());
  }
  return numbers;
}

TEST_F(StereoPanorama, EveryLayoutHasTheSameEyes) {
  make("s.png", {"--stereo", "sbs"});
  make("t.tif", {"--stereo", "ou"});
  make("j.jpg", {"--stereo", "anaglyph"});
  make("a.png", {"--stereo", "anaglyph"});
  const RgbImage beside = vpe::core::read_image(dir_ / "s.png");
  ASSERT_EQ(beside.width, 1000);
  const int height = beside.height;
  const RgbImage left = part_of(beside, 0, 0, 500, height);
  const RgbImage right = part_of(beside, 500, 0, 500, height);
  EXPECT_FALSE(left.pixels == right.pixels);
  make("o.png", {"--stereo", "ou"});
  const RgbImage above = vpe::core::read_image(dir_ / "o.png");
  ASSERT_EQ(above.height, 2 * height);
  EXPECT_TRUE(part_of(above, 0, 0, 500, height).pixels == left.pixels);
  EXPECT_TRUE(part_of(above, 0, height, 500, height).pixels == right.pixels);
  const RgbImage mixed = vpe::core::read_image(dir_ / "a.png");
  EXPECT_EQ(mixed.pixels, vpe::core::combine_stereo(left, right, vpe::core::StereoLayout::kAnaglyph).pixels);

  // GPano describes single images, the sidecar the layout of a pair.
  const auto pair = panorama::describe(dir_ / "s.png");
  EXPECT_EQ(pair.pair, panorama::PairLayout::kSideBySide);
  EXPECT_EQ(pair.map.width_px, 500);
  EXPECT_EQ(pair.sources.size(), 1U);
  EXPECT_EQ(panorama::describe(dir_ / "t.tif").pair, panorama::PairLayout::kOverUnder);
  EXPECT_EQ(panorama::describe(dir_ / "t.tif").sources.size(), 1U);
  EXPECT_EQ(panorama::describe(dir_ / "j.jpg").pair, panorama::PairLayout::kNone);
  EXPECT_EQ(panorama::describe(dir_ / "j.jpg").sources.size(), 2U);

  const auto view = [&](const std::string& name, const std::string& output) {
    const Result result = vpe({"overlook", name, "--view", "80,-5", "--fov", "40", "--size", "300x200",
                               "--stereo", "sbs", "-o", output, "-q"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return vpe::core::read_image(dir_ / output).pixels;
  };
  EXPECT_TRUE(view("s.png", "v.png") == view("t.tif", "w.png"));
  EXPECT_EQ(leftovers(), Words{});
}

// Returns the mean difference of two images of equal size, steps of colour.
double difference(const RgbImage& a, const RgbImage& b) {
  double sum = 0;
  for (std::size_t n = 0; n < a.pixels.size(); ++n)
    sum += std::abs(a.pixels[n].r - b.pixels[n].r) + std::abs(a.pixels[n].g - b.pixels[n].g) +
           std::abs(a.pixels[n].b - b.pixels[n].b);
  return sum / (3.0 * static_cast<double>(a.pixels.size()));
}

TEST_F(StereoPanorama, TheRightEyeMayBeCarried) {
  // Wide enough for several strips.
  for (const Words& shape : {Words{"--width", "9000", "--elevation=-3.2,-0.8", "--eye-base", "300"},
                             Words{"--width", "700", "--projection", "equirectangular", "--elevation=-90,90"},
                             Words{"--width", "600", "--from", "40", "--to", "130"}}) {
    const auto with = [&](Words more) {
      more.insert(more.end(), shape.begin(), shape.end());
      more.insert(more.end(), {"--set", "samples=1", "--set", "gamma=1.4", "--json"});
      return more;
    };
    const auto full = parse_json(make("full.png", with({"--stereo", "ou"})).out);
    const auto carried =
        parse_json(make("carried.png", with({"--stereo", "ou", "--stereo-method", "reproject"})).out);
    const RgbImage a = vpe::core::read_image(dir_ / "full.png");
    const RgbImage b = vpe::core::read_image(dir_ / "carried.png");
    ASSERT_EQ(a.height, b.height);
    const int height = a.height / 2;
    EXPECT_TRUE(part_of(a, 0, 0, a.width, height).pixels == part_of(b, 0, 0, a.width, height).pixels);
    const RgbImage right = part_of(a, 0, height, a.width, height);
    const RgbImage carried_right = part_of(b, 0, height, a.width, height);
    const double off = difference(carried_right, right);
    EXPECT_GT(off, 0);
    EXPECT_LT(off, 0.3);
    // Smooth ground far away is nearly the same for both eyes.
    EXPECT_LT(off, std::max(0.2 * difference(part_of(a, 0, 0, a.width, height), right), 0.001));
    EXPECT_GE(carried["shift_bound_px"], full["shift_bound_px"]);
    EXPECT_LE(carried["shift_bound_px"], full["shift_bound_px"].get<double>() + 1.1);

    make("mixed.png", with({"--stereo", "anaglyph", "--stereo-method", "reproject"}));
    const RgbImage mixed = vpe::core::combine_stereo(part_of(b, 0, 0, a.width, height), carried_right,
                                                     vpe::core::StereoLayout::kAnaglyph);
    EXPECT_LT(difference(vpe::core::read_image(dir_ / "mixed.png"), mixed), 0.02);

    // Side by side, the right image is carried from columns that were kept.
    const auto side_by_side =
        parse_json(make("beside.png", with({"--stereo", "sbs", "--stereo-method", "reproject"})).out);
    const RgbImage beside = vpe::core::read_image(dir_ / "beside.png");
    ASSERT_EQ(beside.width, 2 * a.width);
    EXPECT_TRUE(part_of(beside, 0, 0, a.width, height).pixels == part_of(b, 0, 0, a.width, height).pixels);
    EXPECT_LT(difference(part_of(beside, a.width, 0, a.width, height), carried_right), 0.02);
    EXPECT_NEAR(side_by_side["shift_bound_px"].get<double>(), carried["shift_bound_px"].get<double>(), 0.1);
    const Result from_recipe =
        vpe({"panorama", "--from-sidecar", "beside.json", "-o", "again.png", "-q", "--threads", "3"});
    ASSERT_EQ(from_recipe.exit_code, 0) << from_recipe.err;
    EXPECT_TRUE(read_text(dir_ / "again.png") == read_text(dir_ / "beside.png"));

    const Result again =
        vpe({"panorama", "--from-sidecar", "carried.json", "-o", "again.png", "-q", "--threads", "3"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_TRUE(read_text(dir_ / "again.png") == read_text(dir_ / "carried.png"));
    make("none.png", with({"--stereo", "ou", "--stereo-method", "reproject", "--stereo-gap", "0"}));
    EXPECT_TRUE(vpe::core::read_image(dir_ / "none.png").pixels == a.pixels);
  }
  const auto fails = [&](const Words& more, const Words& reasons) {
    const Result result = vpe(words("x.png", more));
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(says(result.err, reasons)) << result.err;
  };
  fails({"--stereo", "ou", "--stereo-method", "reproject", "--set", "samples=4"}, {"samples", "full"});
  fails({"--stereo", "ou", "--stereo-method", "reproject", "--set", "rays.mode=discrete"},
        {"rays.vertical", "full"});
  fails({"--stereo-method", "reproject"}, {"--stereo-method", "--stereo"});
}

TEST_F(StereoPanorama, TheBaseIsAThirtiethOfTheNearestAndKept) {
  const auto report = parse_json(make("s.png", {"--stereo", "sbs", "--json"}).out);
  const auto sidecar = parse_json(read_text(dir_ / "s.json"));
  const auto stereo = sidecar["vpe"]["recipe"]["stereo"];
  const double base_m = report["eye_base_m"];
  EXPECT_EQ(sidecar["eye_base_m"], base_m);
  EXPECT_EQ(stereo["eye_base_m"], base_m);
  EXPECT_NEAR(stereo["nearest_m"].get<double>(), 30 * base_m, 1e-9 * base_m);
  EXPECT_EQ(report["width"], 1000);
  // Ground as seen in a panorama for one eye.
  make("one.png", {"--aux-layers", "range"});
  float nearest_m = HUGE_VALF;
  for (const float r : read_layer(dir_ / "one.range.tif")) nearest_m = std::fmin(nearest_m, r);
  EXPECT_NEAR(30 * base_m, nearest_m, 0.02 * nearest_m);
}

TEST_F(StereoPanorama, FromItsSidecarAndResumedItIsTheSame) {
  const Words wide{"--width", "9000", "--elevation=-3.2,-0.8", "--eye-base", "300"};
  const std::vector<std::pair<std::string, Words>> pairs{
      {"sbs", {}},
      {"ou", {}},
      {"anaglyph", {}},
      {"carried", {"--stereo", "sbs", "--stereo-method", "reproject", "--set", "samples=1"}}};
  for (const auto& [layout, method] : pairs) {
    Words more = wide;
    if (method.empty()) more.insert(more.end(), {"--stereo", layout});
    more.insert(more.end(), method.begin(), method.end());
    make("p.tif", more);
    const std::string bytes = read_text(dir_ / "p.tif");
    const Result again =
        vpe({"panorama", "--from-sidecar", "p.json", "-o", "q.tif", "-q", "--memory", "300", "--threads", "3"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_TRUE(read_text(dir_ / "q.tif") == bytes) << layout;
    EXPECT_EQ(parse_json(read_text(dir_ / "p.json"))["vpe"]["recipe"],
              parse_json(read_text(dir_ / "q.json"))["vpe"]["recipe"]);

    for (const char* file : {"p.tif", "p.json"}) fs::remove(dir_ / file);
    Command command = command_for(words("p.tif", more));
    command.signal = SIGTERM;
    command.when = [&] { return exists("p.tif.parts/strip_000000"); };
    const Result stopped = run(command);
    ASSERT_TRUE(stopped.signalled);
    EXPECT_EQ(stopped.exit_code, 143) << stopped.err;
    // Strips of eyes farther apart are not taken.
    fs::create_directory(dir_ / layout);
    fs::copy(dir_ / "p.tif.parts", dir_ / layout / "p.tif.parts");
    Words other = more;
    *std::find(other.begin(), other.end(), "300") = "310";
    other.push_back("--json");
    EXPECT_EQ(parse_json(make(layout + "/p.tif", other).out)["strips_kept"], 0);
    more.push_back("--json");
    EXPECT_GE(parse_json(make("p.tif", more).out)["strips_kept"], 1);
    EXPECT_TRUE(read_text(dir_ / "p.tif") == bytes) << layout;
  }
}

TEST_F(StereoPanorama, BadInputIsReported) {
  const auto refuse = [&](int code, const Words& more, const Words& parts,
                          const std::string& output = "x.png") {
    expect_failure(words(output, more), code, parts);
    EXPECT_FALSE(exists(output));
    EXPECT_FALSE(exists("x.json"));
    EXPECT_TRUE(leftovers().empty());
  };
  refuse(2, {"--stereo", "cross"}, {"--stereo", "cross"});
  refuse(2, {"--eye-base", "3"}, {"--eye-base", "--stereo"});
  for (const char* bad : {"0", "-1", "nan", "1e9"})
    refuse(2, {"--stereo", "sbs", "--eye-base", bad}, {"--eye-base", bad});
  refuse(2, {"--stereo", "sbs", "--backend", "polygon", "--projection", "facets"}, {"--stereo", "--backend"});
  refuse(2, {"--stereo", "sbs", "--projection", "facets"}, {"facet", "--projection cylinder"});
  refuse(2, {"--stereo", "sbs", "--aux-layers", "range"}, {"--aux-layers", "one eye", "without --stereo"});
  // Ground nearer than the eyes are to each other, or nearly.
  refuse(1, {"--stereo", "sbs", "--eye-base", "9000"}, {"--eye-base", "eyes 9000 m apart", "comfortable"});
  refuse(1, {"--stereo", "sbs", "--eye-base", "2500"}, {"--eye-base", "at most"});
  refuse(1, {"--stereo", "sbs", "--elevation=40,60"}, {"sky alone", "--eye-base"});
  refuse(1, {"--stereo", "sbs", "--width", "40000", "--elevation=-2,2"}, {"80000x", "65500"}, "x.jpg");
  // An eye inside a slope that the image does not show.
  const Result low =
      vpe({"panorama", planet().string(), "--at", "100,0", "--height", "0.02", "-o", "x.png", "--width", "500",
           "--elevation=40,60", "--stereo", "sbs", "--eye-base", "2000", "-q"});
  EXPECT_EQ(low.exit_code, 1);
  EXPECT_TRUE(says(low.err, {"--stereo", "above the ground", "smaller --eye-base"}));
  // Of sky alone, with a base, there is an image.
  make("sky.png", {"--stereo", "sbs", "--elevation=40,60", "--eye-base", "10"});

  make("p.png", {"--stereo", "sbs"});
  auto json = parse_json(read_text(dir_ / "p.json"));
  expect_failure({"panorama", "--from-sidecar", "p.json", "-o", "x.png", "--stereo", "ou"}, 2,
                 {"--stereo and --from-sidecar"});
  json["vpe"]["recipe"]["stereo"]["eye_base_m"] = -3;
  write_text(dir_ / "b.json", json.dump());
  expect_failure({"panorama", "--from-sidecar", "b.json", "-o", "x.png"}, 1, {"b.json", "stereo", "-3"});
  json["vpe"]["recipe"]["stereo"]["layout"] = "cross";
  write_text(dir_ / "b.json", json.dump());
  expect_failure({"panorama", "--from-sidecar", "b.json", "-o", "x.png"}, 1, {"b.json", "layout"});
}

// Terrain with hills of some metres around a camera 30 m above it.
class StereoTerrain : public AppTest {
 protected:
  static constexpr double kLon_deg = 20;
  static constexpr double kLat_deg = 30;

  std::shared_ptr<const paging::PlanetFile> hills() const {
    const glm::dvec3 below = mars::direction({kLon_deg, kLat_deg});
    const auto height = [](const glm::dvec3& d) {
      const glm::dvec3 p = d * mars::kMarsRadius_m;
      return 4 * std::sin(p.x / 31) * std::sin(p.y / 23) + 1.5 * std::sin(p.z / 9 + 1);
    };
    const test_support::FakeElevation source(height, test_support::fine_around(below, 2e-4, 4));
    return test_support::build_fake(dir_ / "hills.vpe", source, 1e6);
  }
};

TEST_F(StereoTerrain, DisparitiesAreThoseOfExactCasts) {
  const auto planet = hills();
  const paging::Surface surface(planet, std::size_t{64} << 20);
  for (const std::string projection : {"cylinder", "equirectangular"}) {
    const std::string low = projection == "cylinder" ? "-50" : "-90";
    const Result result = vpe({"panorama",
                               "hills.vpe",
                               "--at",
                               "20,30",
                               "--height",
                               "30",
                               "-o",
                               "p.png",
                               "--width",
                               "1500",
                               "--elevation=" + low + ",5",
                               "--projection",
                               projection,
                               "--stereo",
                               "sbs",
                               "-q",
                               "--set",
                               "mode=coloured",
                               "--set",
                               "colour=slope",
                               "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto report = parse_json(result.out);
    const double base_m = report["eye_base_m"];
    const auto description = panorama::describe(dir_ / "p.png");
    const panorama::PanoramaMap& map = description.map;
    const mars::Pose middle{kLon_deg, kLat_deg, *description.viewpoint->alt_m, 0, 0, 0};
    const test_support::TwoEyes eyes(middle, mars::kMarsRadius_m, base_m);
    const RgbImage image = vpe::core::read_image(dir_ / "p.png");

    // Returns the light of the left eye's half between two pixels of a row.
    const auto light = [&](double x, double y) {
      const auto row = static_cast<std::int64_t>(y);
      const double left = std::floor(x - 0.5);
      const double share = x - 0.5 - left;
      const auto at = [&](double column) {
        const auto c = static_cast<std::int64_t>(std::fmod(column + 1500.0, 1500.0));
        const vpe::base::Rgb& p = image.pixels[static_cast<std::size_t>(row * image.width + c)];
        return 0.3 * p.r + 0.6 * p.g + 0.1 * p.b;
      };
      return (1 - share) * at(left) + share * at(left + 1);
    };
    constexpr int kShifts = 61;
    constexpr double kStep_px = 0.05;
    std::vector<double> difference(kShifts);
    std::mt19937 random(3);
    int hits = 0;
    double most_px = 0;
    double worst_formula_px = 0;
    for (int n = 0; n < 20000; ++n) {
      const auto x = static_cast<std::int64_t>(random() % 1500);
      const auto y = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(map.height_px));
      const auto d = map.to_direction(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
      const auto ray = eyes.ray(Eye::kRight, d);
      const double range_m = surface.cast(ray.camera_m, ray.direction);
      if (!std::isfinite(range_m)) continue;
      const glm::dvec3 hit_m = ray.camera_m + range_m * ray.direction;
      const auto from = eyes.ray(Eye::kLeft, eyes.seen(Eye::kLeft, hit_m));
      if (surface.cast(from.camera_m, from.direction) < glm::length(hit_m - from.camera_m) * (1 - 1e-5))
        continue;  // hidden
      const glm::dvec2 left = map.place(eyes.seen(Eye::kLeft, hit_m));
      // Rows of the left image near that of the right one; slopes of light down the image add little.
      if (std::abs(left.y - (static_cast<double>(y) + 0.5)) > 0.3) continue;
      const double apart_px = std::remainder(left.x - (static_cast<double>(x) + 0.5), map.turn_px);
      const double e = d.elevation_deg * mars::kRadiansPerDegree;
      const double formula_px = map.turn_px / (2 * mars::kPi) *
                                panorama::faded_base_m(base_m, d.elevation_deg) / (range_m * std::cos(e));
      worst_formula_px = std::max(worst_formula_px, std::abs(apart_px - formula_px));
      most_px = std::max(most_px, apart_px);
      ++hits;
      const vpe::base::Rgb& p = image.pixels[static_cast<std::size_t>(y * image.width + 1500 + x)];
      const double wanted = 0.3 * p.r + 0.6 * p.g + 0.1 * p.b;
      for (int k = 0; k < kShifts; ++k) {
        const double off = light(left.x + (k - kShifts / 2) * kStep_px, left.y) - wanted;
        difference[static_cast<std::size_t>(k)] += off * off;
      }
    }
    ASSERT_GT(hits, 3000) << projection;
    EXPECT_GT(most_px, 5) << projection;
    EXPECT_LT(worst_formula_px, 0.3) << projection;
    const auto best = std::min_element(difference.begin(), difference.end()) - difference.begin();
    const double best_px = static_cast<double>(best - kShifts / 2) * kStep_px;
    RecordProperty("best_px_" + projection, std::to_string(best_px));
    EXPECT_LE(std::abs(best_px), 0.3) << projection;
    // An error of one pixel would be noticed.
    EXPECT_GT(difference.front(), 2 * difference[static_cast<std::size_t>(best)]) << projection;
    EXPECT_GT(difference.back(), 2 * difference[static_cast<std::size_t>(best)]) << projection;
  }
}

TEST_F(StereoTerrain, TheSeamOfTheFullCircleIsClosed) {
  hills();
  const Result result = vpe({"panorama", "hills.vpe", "--at", "20,30", "--height", "30", "-o", "p.png",
                             "--width", "1500", "--elevation=-45,5", "--stereo", "ou", "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const RgbImage image = vpe::core::read_image(dir_ / "p.png");
  const auto step = [&](int a, int b) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y) {
      const vpe::base::Rgb& p = image.pixels[static_cast<std::size_t>(y * image.width + a)];
      const vpe::base::Rgb& q = image.pixels[static_cast<std::size_t>(y * image.width + b)];
      sum += std::abs(p.r - q.r) + std::abs(p.g - q.g) + std::abs(p.b - q.b);
    }
    return sum;
  };
  std::vector<double> steps;
  for (int x = 0; x + 1 < image.width; ++x) steps.push_back(step(x, x + 1));
  double about = 0;
  for (int k = 0; k < 8; ++k)
    about += (steps[static_cast<std::size_t>(k)] + steps[steps.size() - 1 - static_cast<std::size_t>(k)]) / 16;
  EXPECT_LT(step(image.width - 1, 0), 1.5 * about);
  EXPECT_LE(step(image.width - 1, 0), *std::max_element(steps.begin(), steps.end()));
}

}  // namespace
}  // namespace app_test
