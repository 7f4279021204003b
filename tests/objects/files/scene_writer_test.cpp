#include "objects/files/scene_writer.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <random>
#include <stdexcept>

#include "objects/files/scene_limits.h"
#include "tests/objects/files/scene_texts.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace objects {
namespace {

using namespace test;

namespace fs = std::filesystem;

bool same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }
bool same(const mars::LonLat& a, const mars::LonLat& b) {
  return same(a.lon_deg, b.lon_deg) && same(a.lat_deg, b.lat_deg);
}
bool same(const ModelEntry& a, const ModelEntry& b) {
  return a.name == b.name && a.file == b.file && same(a.unit_m, b.unit_m) && a.up == b.up &&
         a.formula == b.formula;
}
bool same(const Placing& a, const Placing& b) {
  return same(a.place, b.place) && a.height_kind == b.height_kind && same(a.height_m, b.height_m) &&
         same(a.heading_deg, b.heading_deg) && same(a.pitch_deg, b.pitch_deg) && same(a.roll_deg, b.roll_deg) &&
         a.follows_slope == b.follows_slope && same(a.scale, b.scale);
}
bool same(const ObjectEntry& a, const ObjectEntry& b);
bool same(const PathPoint& a, const PathPoint& b);
bool same(const PathEntry& a, const PathEntry& b);
bool same(const ScatterEntry& a, const ScatterEntry& b);
template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  return std::ranges::equal(a, b, [](const T& x, const T& y) { return same(x, y); });
}
bool same(const ObjectEntry& a, const ObjectEntry& b) {
  return a.name == b.name && a.model == b.model && same(a.interest_levels, b.interest_levels) &&
         same(a.places, b.places) && a.ground.kind == b.ground.kind &&
         same(a.ground.voxel_m, b.ground.voxel_m) &&
         same(a.ground.solid_above_per_m, b.ground.solid_above_per_m);
}
bool same(const PathPoint& a, const PathPoint& b) {
  return same(a.time_s, b.time_s) && same(a.place, b.place) && a.heading_deg == b.heading_deg &&
         a.height_m == b.height_m;
}
bool same(const PathEntry& a, const PathEntry& b) {
  return a.name == b.name && a.model == b.model && same(a.points, b.points) && same(a.scale, b.scale) &&
         same(a.wheelbase_m, b.wheelbase_m) && same(a.track_m, b.track_m);
}
bool same(const ScatterEntry& a, const ScatterEntry& b) {
  if (a.distribution.index() != b.distribution.index()) return false;
  if (const auto* power = std::get_if<PowerLaw>(&a.distribution)) {
    const PowerLaw& other = std::get<PowerLaw>(b.distribution);
    if (!same(power->density_per_m2, other.density_per_m2) || !same(power->exponent, other.exponent))
      return false;
  } else if (!same(std::get<RockAbundance>(a.distribution).k, std::get<RockAbundance>(b.distribution).k)) {
    return false;
  }
  return a.name == b.name && a.models == b.models && same(a.polygon, b.polygon) && a.seed == b.seed &&
         same(a.least_diameter_m, b.least_diameter_m) && same(a.most_diameter_m, b.most_diameter_m) &&
         same(a.buried, b.buried) && a.follows_slope == b.follows_slope && a.tumbles == b.tumbles &&
         a.most == b.most;
}
bool same(const SceneFile& a, const SceneFile& b) {
  return same(a.models, b.models) && same(a.objects, b.objects) && same(a.scatters, b.scatters) &&
         same(a.paths, b.paths);
}

SceneFile again(const SceneFile& scene, const fs::path& file = "/scenes/a.scene.toml") {
  return parse_scene_toml(to_toml(scene, file), file);
}

// Makes scenes of all kinds of entries, numbers and texts that a file may have.
class AnyScene {
 public:
  explicit AnyScene(unsigned seed) : random_(seed) {}

  SceneFile make() {
    SceneFile scene;
    scene.path = "/scenes/a.scene.toml";
    const auto files = static_cast<std::size_t>(below(4) + 1);
    const auto models = files + static_cast<std::size_t>(below(3));
    for (std::size_t n = 0; n < files; ++n) {
      scene.models.push_back({name() + std::to_string(n), fs::path(folder()) / (name() + ".glb"),
                              number(kUnitRange_m), static_cast<UpAxis>(below(3))});
    }
    // Volumes are read after the models.
    for (std::size_t n = files; n < models; ++n) {
      ModelEntry volume;
      volume.name = name() + std::to_string(n);
      VolumeFormula formula;
      do {
        formula = {static_cast<VolumeKind>(below(3)), number({1, 100}), number({1, 40}), number({0.1, 50})};
        if (formula.kind != VolumeKind::kCloud) formula.lean_m = number({0, 40});
      } while (!check(formula).empty());
      formula.colour = {static_cast<std::uint8_t>(below(256)), static_cast<std::uint8_t>(below(256)),
                        static_cast<std::uint8_t>(below(256)), 255};
      formula.seed = static_cast<std::uint64_t>(below(1'000'000));
      formula.voxels = 16 + below(241);
      volume.formula = formula;
      scene.models.push_back(volume);
    }
    const auto any_model = [&] { return static_cast<std::size_t>(below(static_cast<int>(models))); };
    for (int n = below(5); n > 0; --n) {
      const Placing like = placing();
      ObjectEntry object{maybe_name(), any_model(), {}, number(kInterestRange)};
      for (int k = below(3); k >= 0; --k) {
        object.places.push_back(like);
        object.places.back().place = place();
        object.places.back().heading_deg = number(kAngleRange_deg);
      }
      object.ground.kind = static_cast<GroundRole::Kind>(below(3));
      if (object.ground.kind != GroundRole::Kind::kNone && below(2) == 0) {
        object.ground.voxel_m = number(kGroundVoxelRange_m);
        if (object.model >= files) object.ground.solid_above_per_m = number(kExtinctionRange_per_m);
      }
      scene.objects.push_back(object);
    }
    for (int n = below(3); n > 0; --n) {
      PathEntry path{maybe_name(), any_model(), {}, number(kScaleRange)};
      if (below(2) == 0) {
        path.wheelbase_m = number(kWheelRange_m);
        path.track_m = number(kWheelRange_m);
      }
      double time_s = number({-1e6, 1e6});
      for (int k = below(3); k >= 0; --k) {
        path.points.push_back({time_s, place(), std::nullopt});
        if (below(2) == 0) path.points.back().heading_deg = number(kAngleRange_deg);
        if (below(2) == 0) path.points.back().height_m = number({-10, 1000});
        time_s += number({0.5, 1e6});
      }
      scene.paths.push_back(path);
    }
    for (int n = below(3); n > 0; --n) {
      ScatterEntry scatter;
      scatter.name = maybe_name();
      for (int k = below(3); k >= 0; --k) scatter.models.push_back(any_model());
      for (int k = below(4); k >= -2; --k) scatter.polygon.push_back(place());
      scatter.seed = random_() >> 1U;
      if (below(2) == 0)
        scatter.distribution = PowerLaw{number(kDensityRange_per_m2), number(kExponentRange)};
      else
        scatter.distribution = RockAbundance{number(kAbundanceRange)};
      scatter.least_diameter_m = number({0.001, 10});
      scatter.most_diameter_m = number({20, 1e5});
      scatter.buried = number(kShareRange);
      scatter.follows_slope = below(2) == 0;
      scatter.tumbles = below(2) == 0;
      scatter.most = static_cast<std::size_t>(below(1000));
      scene.scatters.push_back(scatter);
    }
    return scene;
  }

 private:
  int below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(random_); }

  double number(const NumberRange& range) {
    switch (below(4)) {
      case 0:  // whole
        return std::clamp(std::floor(std::uniform_real_distribution<double>(-100, 100)(random_)),
                          range.is_open ? 1.0 : range.least, range.most);
      case 1:  // small
        return std::clamp(std::ldexp(std::uniform_real_distribution<double>(1, 2)(random_), -30 - below(40)),
                          range.least, range.most);
      case 2:
        if (!range.is_open && range.least <= 0) return below(2) == 0 ? -0.0 : 0.0;
        [[fallthrough]];
      default:
        return std::uniform_real_distribution<double>(std::nextafter(range.least, range.most),
                                                      range.most)(random_);
    }
  }

  mars::LonLat place() { return {mars::normalize_lon_deg(number({-180, 180})), number(kLatRange_deg)}; }

  Placing placing() {
    Placing placing;
    placing.height_kind = static_cast<HeightKind>(below(2));
    placing.height_m = number(kHeightRange_m);
    placing.pitch_deg = number(kAngleRange_deg);
    placing.roll_deg = number(kAngleRange_deg);
    placing.follows_slope = below(2) == 0;
    placing.scale = number(kScaleRange);
    return placing;
  }

  std::string name() {
    static const std::vector<std::string> kParts{"a",   "\"",     "'", "\\",   "#", "=", "[", "]",     " ",
                                                 "'''", "\"\"\"", "ä", "火星", "{", ",", ".", "u0041", "\\n"};
    std::string text = "n";
    for (int n = below(8); n > 0; --n)
      text += kParts[static_cast<std::size_t>(below(static_cast<int>(kParts.size())))];
    return text;
  }
  std::string maybe_name() { return below(3) == 0 ? "" : name(); }
  std::string folder() {
    static const std::vector<std::string> kFolders{"/scenes", "/scenes/models", "/", "/other/place"};
    return kFolders[static_cast<std::size_t>(below(static_cast<int>(kFolders.size())))];
  }

  std::mt19937_64 random_;
};

RC_GTEST_PROP(SceneWriterProperty, WhatIsWrittenIsReadBack, (unsigned seed)) {
  const SceneFile scene = AnyScene(seed).make();
  const std::string text = to_toml(scene, scene.path);
  const SceneFile read = parse_scene_toml(text, scene.path);
  RC_ASSERT(same(scene, read));
  RC_ASSERT(to_toml(read, scene.path) == text);
}

TEST(SceneWriter, WritesAWholeScene) {
  const SceneFile scene = toml(kWhole);
  EXPECT_TRUE(same(scene, again(scene)));
}

TEST(SceneWriter, LeavesDefaultsOut) {
  SceneFile scene;
  scene.path = "/scenes/a.scene.toml";
  scene.models = {{"rover", "/scenes/models/rover.glb"}};
  scene.objects = {{"", 0, {Placing{{137.5, -4}}}}};
  EXPECT_EQ(to_toml(scene, scene.path),
            "version = 1\n\n[[model]]\nname = \"rover\"\nfile = \"models/rover.glb\"\n\n[[object]]\n"
            "model = \"rover\"\nlon = 137.5\nlat = -4\n");
}

TEST(SceneWriter, NamesModelsRelativeToTheNewFolder) {
  SceneFile scene;
  scene.models = {{"a", "/scenes/models/a.glb"}, {"b", "/b.glb"}};
  for (const char* file : {"/scenes/a.scene.toml", "/scenes/models/deep/a.scene.toml", "/a.scene.toml"})
    EXPECT_TRUE(same(scene, again(scene, file))) << file;
  EXPECT_NE(to_toml(scene, "/other/a.scene.toml").find("file = \"../scenes/models/a.glb\""), std::string::npos);
  scene.models = {{"a", "models/a.glb"}, {"b", "../b.glb"}};
  EXPECT_TRUE(same(scene, again(scene, "x.scene.toml")));
  EXPECT_TRUE(same(scene, again(scene, "x/y.scene.toml")));
  // No relative path leads there without the name of this folder.
  EXPECT_EQ(again(scene, "../x/y.scene.toml").models[0].file, fs::current_path() / "models/a.glb");
  EXPECT_EQ(again(scene, "/x/y.scene.toml").models[0].file, fs::current_path() / "models/a.glb");
}

TEST(SceneWriter, DividesPlacesThatDiffer) {
  SceneFile scene;
  scene.models = {{"m", "/scenes/m.glb"}};
  Placing high;
  high.height_m = 5;
  scene.objects = {{"n", 0, {Placing{{1, 2}}, Placing{{3, 4}}, high}}, {"none", 0, {}}};
  const SceneFile read = again(scene);
  ASSERT_EQ(read.objects.size(), 2U);
  EXPECT_EQ(read.objects[0].places.size(), 2U);
  EXPECT_EQ(read.objects[1].name, "n");
  EXPECT_EQ(read.objects[1].places[0].height_m, 5);
}

TEST(SceneWriter, RefusesWhatNoFileCanHold) {
  const auto written = [](const std::string& name, std::size_t model = 0) {
    SceneFile scene;
    scene.models = {{"m", "/m.glb"}};
    scene.objects = {{name, model, {Placing{}}}};
    return to_toml(scene, "/a.scene.toml");
  };
  EXPECT_NO_THROW(written("a"));
  EXPECT_THROW(written("a\nb"), std::invalid_argument);
  EXPECT_THROW(written("a\x7f"), std::invalid_argument);
  EXPECT_THROW(written("a\xff"), std::invalid_argument);
  EXPECT_THROW(written(std::string(kMostNameBytes + 1, 'a')), std::invalid_argument);
  EXPECT_THROW(written("a", 1), std::invalid_argument);
}

TEST(SceneWriter, ReplacesAFileAtOnce) {
  const test_support::TempDir folder;
  const fs::path file = folder / "a.scene.toml";
  SceneFile scene = toml(kWhole);
  write_scene_file(scene, file);
  EXPECT_TRUE(same(scene, read_scene_file(file)));
  scene.objects[0].name = "a\nb";
  EXPECT_THROW(write_scene_file(scene, file), std::invalid_argument);
  EXPECT_EQ(read_scene_file(file).objects[0].name, "Rover 1");
  EXPECT_THROW(write_scene_file(toml(kWhole), folder / "none/a.scene.toml"), vpe::base::FileError);
}

}  // namespace
}  // namespace objects
