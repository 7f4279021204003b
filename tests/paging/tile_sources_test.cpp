// The source of the height at a place, and how far the tile there is from the posts of that source.
#include "paging/planet/tile_sources.h"

#include <gtest/gtest.h>

#include <map>

#include "paging/build/merge.h"
#include "paging/planet/verify.h"
#include "paging/surface/query.h"
#include "tests/paging/forged_planet.h"
#include "tests/paging/planet_fixture.h"

namespace {

using paging::PlanetFile;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::Random;
using test_support::TempDir;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInsetRadius_rad = 0.08;
constexpr double kInset_m = 9000;
constexpr double kBase_m = 60000;
const glm::dvec3 kInset = glm::normalize(glm::dvec3(1, 0.9, 0.3));

bool is_in_inset(const glm::dvec3& d) { return glm::length(d - kInset) < kInsetRadius_rad; }
bool is_in_hole(const glm::dvec3& d) { return glm::length(d - kInset) > kInsetRadius_rad && d.z < -0.9; }

// A source with a name and a spacing of its own. Its heights tell it apart.
class Layer : public FakeElevation {
 public:
  Layer(std::string name, double resolution_m, Height height, Spacing spacing)
      : FakeElevation(std::move(height), std::move(spacing)),
        name_(std::move(name)),
        resolution_m_(resolution_m) {}
  std::vector<mars::SourceInfo> infos() const override {
    std::vector<mars::SourceInfo> infos = FakeElevation::infos();
    infos.front().name = name_;
    infos.front().resolution_m = resolution_m_;
    return infos;
  }

 private:
  std::string name_;
  double resolution_m_;
};

// An inset over a base with a hole at the south pole.
std::shared_ptr<const mars::ElevationSource> two_sources() {
  const auto inset = std::make_shared<Layer>(
      "inset", kInset_m, [](const glm::dvec3& d) { return is_in_inset(d) ? 500 + bumpy_height(d) : kNaN; },
      [](const mars::Cap& cap) {
        return glm::length(cap.centre - kInset) < cap.radius_rad + kInsetRadius_rad
                   ? kInset_m
                   : std::numeric_limits<double>::infinity();
      });
  const auto base = std::make_shared<Layer>(
      "base", kBase_m, [](const glm::dvec3& d) { return is_in_hole(d) ? kNaN : bumpy_height(d); },
      [](const mars::Cap&) { return kBase_m; });
  return mars::stack_elevation({inset, base});
}

paging::BuildOptions options(const std::filesystem::path& path) {
  paging::BuildOptions o;
  o.output = path.string();
  o.base_spacing_m = 1e6;
  o.threads = 2;
  o.tile_k = 4;
  o.resampling_posts = 10000;
  return o;
}

std::shared_ptr<const PlanetFile> build(const std::filesystem::path& path) {
  paging::build_planet(options(path), *two_sources(), nullptr);
  return PlanetFile::open(path.string());
}

std::int64_t rows(const PlanetFile& planet, const std::string& table) {
  return planet.connect().integer("SELECT count(*) FROM " + table);
}

TEST(TileSources, QueryNamesTheSourceOfThePlaceAndItsSpacing) {
  TempDir dir;
  const auto planet = build(dir / "p.vpe");
  EXPECT_GT(rows(*planet, "origin"), 4);
  EXPECT_LT(rows(*planet, "origin"), planet->meta().leaf_tiles / 2);  // only tiles at the rim
  const paging::Surface surface(planet, 1 << 24);
  Random random(5);
  int inset = 0;
  int base_of_mixed = 0;
  int nodata = 0;
  for (int n = 0; n < 8000; ++n) {
    const glm::dvec3 d = n % 4 == 0 ? random.direction() : glm::normalize(kInset + 0.2 * random.direction());
    const paging::PlaceAnswer a = paging::query(surface, mars::lon_lat(d));
    const double rim_m = std::abs(glm::length(d - kInset) - kInsetRadius_rad) * mars::kMarsRadius_m;
    if (a.nodata) {
      ++nodata;
      EXPECT_FALSE(a.source.has_value());
      EXPECT_EQ(a.resampling.posts, 0);
      continue;
    }
    ASSERT_TRUE(a.source.has_value());
    if (rim_m < a.spacing_m) continue;
    const std::string& name = planet->meta().sources.at(static_cast<std::size_t>(*a.source)).name;
    EXPECT_EQ(name, is_in_inset(d) ? "inset" : "base") << n;
    inset += name == "inset" ? 1 : 0;
    base_of_mixed += name == "base" && a.tile_sources.size() == 2 ? 1 : 0;
  }
  EXPECT_GT(inset, 300);
  EXPECT_GT(base_of_mixed, 100);
  EXPECT_GT(nodata, 10);
}

// The errors are found again from the source's own posts and the surface.
TEST(TileSources, ResamplingIsThatOfTheTileAndTheSource) {
  TempDir dir;
  const auto planet = build(dir / "p.vpe");
  const paging::Surface surface(planet, 1 << 24);
  std::map<std::pair<std::int64_t, int>, paging::ResamplingSum> sums;
  std::map<std::pair<int, int>, paging::ResamplingSum> levels;
  const auto source = two_sources();
  std::vector<glm::dvec3> visited;
  source->visit_posts(10000, [&](std::span<const glm::dvec3> directions, std::span<const double> heights) {
    for (std::size_t n = 0; n < directions.size(); ++n) {
      if (!std::isfinite(heights[n])) continue;
      const paging::SurfacePoint point = surface.at(directions[n]);
      const double deviation_m = std::abs(point.height_m - heights[n]);
      const int index = is_in_inset(directions[n]) ? 0 : 1;
      sums[{lod::pack(point.tile), index}].add(deviation_m);
      levels[{point.tile.level, index}].add(deviation_m);
      visited.push_back(directions[n]);
    }
  });
  ASSERT_GT(visited.size(), 3000U);
  int of_tile = 0;
  int of_level = 0;
  const auto check = [&](const glm::dvec3& d) {
    const paging::PlaceAnswer a = paging::query(surface, mars::lon_lat(d));
    if (!a.source) return;
    const lod::TileKey tile = surface.at(mars::direction(a.place)).tile;
    const auto own = sums.find({lod::pack(tile), *a.source});
    const auto level = levels.find({tile.level, *a.source});
    EXPECT_EQ(a.resampling_of_level, own == sums.end() && level != levels.end());
    const paging::ResamplingSum expected = own != sums.end()       ? own->second
                                           : level != levels.end() ? level->second
                                                                   : paging::ResamplingSum();
    EXPECT_EQ(a.resampling.posts, expected.posts);
    EXPECT_NEAR(a.resampling.max_m, expected.error().max_m, 1e-6);
    EXPECT_NEAR(a.resampling.rms_m, expected.error().rms_m, 1e-5);
    EXPECT_EQ(a.planet_resampling.max_m, planet->meta().resampling.max_m);
    ++(own != sums.end() ? of_tile : of_level);
  };
  for (std::size_t n = 0; n < visited.size(); n += 3) check(visited[n]);
  Random random(6);
  for (int n = 0; n < 500; ++n) check(glm::normalize(kInset + 0.1 * random.direction()));
  EXPECT_GT(of_tile, 1000);
  EXPECT_GT(of_level, 10);
  EXPECT_EQ(static_cast<std::size_t>(rows(*planet, "resampling")), sums.size());
}

TEST(TileSources, MergedShardsHaveThemToo) {
  TempDir dir;
  const auto whole = build(dir / "whole.vpe");
  paging::MergeOptions m;
  m.output = (dir / "merged.vpe").string();
  for (std::int64_t n = 1; n <= 3; ++n) {
    paging::BuildOptions o = options(dir / ("p" + std::to_string(n) + ".vpe"));
    o.shard = {n, 3};
    paging::build_planet(o, *two_sources(), nullptr);
    m.shards.push_back(o.output);
  }
  paging::merge_shards(m);
  const auto merged = PlanetFile::open(m.output);
  EXPECT_TRUE(merged->meta() == whole->meta());
  const auto content = [](const PlanetFile& planet, const std::string& sql) {
    std::vector<std::string> out;
    const paging::Database db = planet.connect();
    paging::Statement all(db, sql);
    while (all.step()) out.push_back(all.text(0));
    return out;
  };
  for (const char* sql :
       {"SELECT key || ' ' || hex(data) FROM origin ORDER BY key",
        "SELECT key || ' ' || source || ' ' || posts || ' ' || max_m || ' ' || rms_m || ' ' || "
        "checksum FROM resampling ORDER BY key, source"}) {
    EXPECT_FALSE(content(*merged, sql).empty());
    EXPECT_EQ(content(*merged, sql), content(*whole, sql));
  }
}

TEST(TileSources, APlanetOfOneSourceStoresNone) {
  TempDir dir;
  const auto planet = test_support::build_fake(dir / "p.vpe", FakeElevation(bumpy_height), 100000);
  EXPECT_EQ(rows(*planet, "origin"), 0);
  EXPECT_GT(rows(*planet, "resampling"), 0);
  const paging::Surface surface(planet, 1 << 24);
  EXPECT_EQ(paging::query(surface, {10, 20}).source, 0);
}

TEST(TileSources, FilesBefore1_3DoNotTell) {
  TempDir dir;
  const auto path = dir / "p.vpe";
  build(path);
  const mars::LonLat rim = mars::lon_lat(glm::normalize(kInset + glm::dvec3(0, 0, kInsetRadius_rad)));
  {
    const auto planet = PlanetFile::open(path.string());
    EXPECT_TRUE(paging::query(paging::Surface(planet, 1 << 22), rim).source.has_value());
  }
  test_support::make_older(path.string(), "1.2");
  const auto planet = PlanetFile::open(path.string());
  const paging::Surface surface(planet, 1 << 22);
  const paging::PlaceAnswer a = paging::query(surface, rim);
  EXPECT_FALSE(a.nodata);
  EXPECT_FALSE(a.source.has_value());
  EXPECT_EQ(a.tile_sources, (std::vector<int>{0, 1}));
  EXPECT_EQ(a.resampling.posts, 0);
  EXPECT_GT(a.planet_resampling.max_m, 0);
  const paging::PlaceAnswer far = paging::query(surface, {-100, 40});
  ASSERT_TRUE(far.source.has_value());  // a tile of one source
  EXPECT_EQ(planet->meta().sources.at(static_cast<std::size_t>(*far.source)).name, "base");
}

TEST(TileSources, VerifyFindsWhatCannotBeTrue) {
  TempDir dir;
  const auto path = dir / "p.vpe";
  build(path);
  const auto problems = [&] {
    return paging::verify(*PlanetFile::open(path.string()), {.threads = 2}).problems;
  };
  EXPECT_TRUE(problems().empty());
  const auto copy = dir / "copy.vpe";
  std::filesystem::copy_file(path, copy);
  std::string of_one_source;  // though the index says two
  for (const std::uint8_t byte : paging::encode_numbers(std::vector<std::uint16_t>(17 * 17, 1))) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", byte);
    of_one_source += digits;
  }
  for (const std::string& sql :
       {std::string("DELETE FROM resampling WHERE key = (SELECT max(key) FROM resampling)"),
        std::string("UPDATE resampling SET posts = posts + 1"),
        "UPDATE origin SET data = x'" + of_one_source + "'",
        std::string("UPDATE origin SET data = zeroblob(20)")}) {
    SCOPED_TRACE(sql);
    test_support::forge(path.string(), sql);
    EXPECT_FALSE(problems().empty());
    std::filesystem::copy_file(copy, path, std::filesystem::copy_options::overwrite_existing);
  }
}

TEST(TileSources, NumbersSurviveTheirCodec) {
  std::vector<int> of_tile;
  for (int n = 0; n < 300; ++n) of_tile.push_back(3 * n + 1);
  std::vector<int> posts;
  Random random(9);
  for (int n = 0; n < 1089; ++n) {
    const int at = random.integer(-1, 299);
    posts.push_back(at < 0 ? -1 : of_tile[static_cast<std::size_t>(at)]);
  }
  paging::TileSources sources;
  sources.of_tile = of_tile;
  sources.of_post = paging::decode_numbers(paging::encode_origin(posts, of_tile), posts.size(), of_tile.size());
  for (std::size_t n = 0; n < posts.size(); ++n) EXPECT_EQ(sources.at(n).value_or(-1), posts[n]);
  EXPECT_TRUE(paging::encode_origin(posts, {1}).empty());
  EXPECT_THROW(paging::decode_numbers(paging::encode_origin(posts, of_tile), posts.size(), 299),
               paging::CodecError);
}

}  // namespace
