// Planet files whose checksums are right and whose content is not: refused by name, or reported by verify().
#include "tests/paging/forged_planet.h"

#include <gtest/gtest.h>

#include "paging/build/shard_file.h"
#include "paging/planet/verify.h"
#include "tests/paging/planet_fixture.h"
#include "vpe/core/image/image.h"

namespace {

using paging::PlanetError;
using paging::PlanetFile;
using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::forge;

class ForgedPlanet : public testing::Test {
 protected:
  void SetUp() override { build_fake(path_, FakeElevation(bumpy_height), 400000); }

  // Returns what open() says, or an empty text.
  std::string refusal() const {
    try {
      PlanetFile::open(path_);
    } catch (const PlanetError& e) {
      return e.what();
    }
    return {};
  }
  void expect_refused(const std::string& word) const {
    const std::string text = refusal();
    EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' is not in: " << text;
    EXPECT_NE(text.find(path_), std::string::npos) << text;
  }
  // Returns what opening or verify() finds.
  std::string findings() const {
    std::string all = refusal();
    if (!all.empty()) return all;
    for (const paging::Problem& p : paging::verify(*PlanetFile::open(path_), {.threads = 1}).problems)
      all += p.where + ": " + p.what + "\n";
    return all;
  }
  void run_sql(const std::string& sql) const {
    paging::Database(path_, paging::Database::Mode::kCreate).execute(sql);
  }
  std::string number_in_meta(const std::string& key, double change) const {
    paging::Database db(path_, paging::Database::Mode::kReadOnly);
    paging::Statement value(db, "SELECT value FROM meta WHERE key = '" + key + "'");
    value.step();
    return "UPDATE meta SET value = '" + std::to_string(std::stod(value.text(0)) + change) + "' WHERE key = '" +
           key + "'";
  }

  test_support::TempDir dir_;
  std::string path_ = (dir_ / "p.vpe").string();
};

TEST_F(ForgedPlanet, NothingIsFoundWhereNothingWasChanged) {
  test_support::forge_checksums(path_);
  EXPECT_EQ(findings(), "");
}

TEST_F(ForgedPlanet, SourcesThatAreNoNumbers) {
  for (const char* sources : {"x", "0,,x", "0x", "99999999999999999999", "-1", "7"}) {
    SCOPED_TRACE(sources);
    forge(path_,
          std::string("UPDATE node SET sources = '") + sources + "' WHERE key = (SELECT max(key) FROM node)");
    expect_refused("the tile index is wrong at row");
  }
}

TEST_F(ForgedPlanet, MeshesOfAnotherGrid) {
  const auto planet = PlanetFile::open(path_);
  const lod::TileKey key = planet->tree()[0].key;
  for (const int intervals : {1, 7, 16, 64}) {
    SCOPED_TRACE(intervals);
    const lod::TileMesh full = lod::mesh_full(intervals);
    const paging::PackedMesh mesh{full, std::vector<std::int32_t>(full.vertices.size())};
    {
      paging::Database db(path_, paging::Database::Mode::kCreate);
      const paging::Bytes data = paging::encode_mesh(mesh);
      paging::Statement(db, "UPDATE mesh SET data = ? WHERE key = ? AND variant = 0")
          .bind(1, std::span(data))
          .bind(2, lod::pack(key))
          .step();
      db.execute("UPDATE variant SET triangles = " + std::to_string(full.triangle_count()) +
                 " WHERE key = " + std::to_string(lod::pack(key)) + " AND variant = 0");
    }
    test_support::forge_checksums(path_);
    EXPECT_NE(findings().find("intervals instead of"), std::string::npos) << findings();
  }
}

TEST_F(ForgedPlanet, BoundsAndCountsThatAreNotOfTheTiles) {
  const auto original = dir_ / "original.vpe";
  std::filesystem::copy_file(path_, original);
  const auto finds = [&](const std::string& sql, const std::string& word) {
    SCOPED_TRACE(sql);
    forge(path_, sql);
    EXPECT_NE(findings().find(word), std::string::npos) << findings();
    std::filesystem::copy_file(original, path_, std::filesystem::copy_options::overwrite_existing);
  };
  finds(number_in_meta("lowest_radius_m", 1), "lowest_radius_m");
  finds(number_in_meta("lowest_radius_m", -1), "lowest_radius_m");
  finds(number_in_meta("highest_radius_m", 1), "highest_radius_m");
  finds(number_in_meta("highest_radius_m", -1), "highest_radius_m");
  finds("UPDATE meta SET value = '-5' WHERE key = 'leaf_tiles'", "leaf_tiles");
  finds("UPDATE meta SET value = '77' WHERE key = 'finest_level'", "finest_level");
  finds("UPDATE meta SET value = '3' WHERE key = 'finest_image_level'", "finest_image_level");
  finds("UPDATE meta SET value = '12345' WHERE key = 'resampling_max_m'", "resampling");
  finds("UPDATE meta SET value = '0.00001' WHERE key = 'resampling_rms_m'", "resampling");
  finds("UPDATE meta SET value = '-1' WHERE key = 'resampling_posts'", "resampling");
  finds("UPDATE meta SET value = replace(value, '\"level\":0', '\"level\":78') WHERE key = 'levels'", "levels");
  finds("UPDATE meta SET value = replace(value, '\"bytes\":', '\"bytes\":1') WHERE key = 'levels'", "levels");
  finds("UPDATE meta SET value = replace(value, '\"holes\":', '\"holes\":1') WHERE key = 'levels'", "levels");
  finds("UPDATE meta SET value = 'no datum' WHERE key = 'datum'", "datum");
}

// A view may never end: the schema is looked at before a row is read.
TEST_F(ForgedPlanet, ViewsInPlaceOfTables) {
  const auto original = dir_ / "original.vpe";
  std::filesystem::copy_file(path_, original);
  for (const std::string table :
       {"meta", "node", "variant", "posts_error", "heights", "missing", "mesh", "image"}) {
    SCOPED_TRACE(table);
    run_sql(
        "ALTER TABLE " + table + " RENAME TO kept; CREATE VIEW " + table +
        " AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) SELECT x AS key, 'v' AS value, "
        "x AS checksum, x AS data, x AS variant FROM c");
    expect_refused("'" + table + "' is a view");
    EXPECT_THROW(paging::ShardFile{path_}, PlanetError);
    std::filesystem::copy_file(original, path_, std::filesystem::copy_options::overwrite_existing);
  }
  run_sql(
      "ALTER TABLE heights RENAME TO kept; CREATE TABLE heights(key INTEGER PRIMARY KEY, checksum INTEGER, data "
      "AS (zeroblob(1 << 30)))");
  expect_refused("computed");
  std::filesystem::copy_file(original, path_, std::filesystem::copy_options::overwrite_existing);
  run_sql("CREATE TRIGGER t AFTER DELETE ON meta BEGIN DELETE FROM node; END");
  expect_refused("trigger");
}

TEST_F(ForgedPlanet, MetaOfMillionsOfRows) {
  run_sql(
      "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c WHERE x < 20000) "
      "INSERT INTO meta SELECT 'k' || x, 'v' FROM c");
  expect_refused("too many rows");
}

class ForgedImage : public testing::Test {};

// Reading must not unpack an image that is larger than a tile's.
TEST_F(ForgedImage, LargerThanATile) {
  test_support::TempDir dir;
  const std::string path = (dir / "p.vpe").string();
  paging::BuildOptions options;
  options.output = path;
  options.base_spacing_m = 400000;
  options.tile_k = 5;
  options.threads = 1;
  options.resampling_posts = 100;
  const test_support::FakeImage image;
  paging::build_planet(options, FakeElevation(bumpy_height), &image);
  const lod::TileKey key = PlanetFile::open(path)->image_keys().front();
  constexpr int kSide = 300;
  const std::vector<vpe::base::Rgb> pixels(std::size_t{kSide} * kSide);
  {
    const paging::Bytes data = vpe::core::encode_jpeg(pixels, kSide, kSide, 50);
    paging::Database db(path, paging::Database::Mode::kCreate);
    paging::Statement(db, "UPDATE image SET data = ? WHERE key = ?")
        .bind(1, std::span(data))
        .bind(2, lod::pack(key))
        .step();
  }
  test_support::forge_checksums(path);
  try {
    PlanetFile::open(path)->image(key);
    FAIL();
  } catch (const PlanetError& e) {
    // The limit is that of the header, before pixels are unpacked.
    EXPECT_NE(std::string(e.what()).find("66049"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find(lod::to_string(key)), std::string::npos) << e.what();
  }
}

}  // namespace
