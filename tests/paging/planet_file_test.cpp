#include "paging/planet/planet_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <mutex>
#include <set>
#include <thread>

#include "paging/planet/sqlite.h"
#include "paging/planet/verify.h"
#include "tests/paging/forged_planet.h"
#include "tests/paging/planet_fixture.h"

namespace {

using paging::PlanetError;
using paging::PlanetFile;
using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::Random;
using test_support::TempDir;

std::string message(const std::filesystem::path& path) {
  try {
    PlanetFile::open(path.string());
  } catch (const PlanetError& e) {
    return e.what();
  }
  return "no error";
}

void change(const std::filesystem::path& path, const std::string& sql) {
  paging::Database db(path.string(), paging::Database::Mode::kCreate);
  db.execute(sql);
}

// Reads everything; throws PlanetError at the first damage.
void read_all(const PlanetFile& planet) {
  for (const lod::TileInfo& info : planet.tree().tiles()) {
    planet.heights(info.key);
    const int meshes = static_cast<int>(info.variants.size()) - (info.has_children ? 0 : 1);
    for (int v = 0; v < meshes; ++v) planet.mesh(info.key, v);
  }
}

TEST(PlanetFile, MetaSurvives) {
  TempDir dir;
  const auto planet = build_fake(dir / "p.vpe", FakeElevation(bumpy_height), 400000);
  const paging::PlanetMeta& meta = planet->meta();
  EXPECT_TRUE(paging::from_rows(paging::to_rows(meta), "x") == meta);
  EXPECT_EQ(meta.sources.front().name, "fake");
  EXPECT_EQ(meta.tiles, static_cast<std::int64_t>(planet->tree().size()));
}

TEST(PlanetFile, SqliteToolsSeeAPlanetFile) {
  TempDir dir;
  build_fake(dir / "p.vpe", FakeElevation(bumpy_height), 400000);
  paging::Database db((dir / "p.vpe").string(), paging::Database::Mode::kReadOnly);
  EXPECT_EQ(db.integer("PRAGMA application_id"), paging::kApplicationId);
  EXPECT_EQ(db.integer("SELECT count(*) FROM meta WHERE key = 'format'"), 1);
}

TEST(PlanetFile, RefusesWhatIsNotAPlanet) {
  TempDir dir;
  EXPECT_NE(message(dir / "absent.vpe").find("no such planet file"), std::string::npos);
  std::ofstream(dir / "text.vpe") << "not a database, but long enough to have a header of its own, surely; "
                                     "and then some more of it so that it passes a hundred bytes";
  EXPECT_NE(message(dir / "text.vpe").find("not a planet file"), std::string::npos);
  std::ofstream(dir / "empty.vpe").close();
  EXPECT_NE(message(dir / "empty.vpe").find("not a planet file"), std::string::npos);
  change(dir / "other.vpe", "CREATE TABLE t(x)");
  EXPECT_NE(message(dir / "other.vpe").find("not a planet file"), std::string::npos);
  std::filesystem::create_directory(dir / "folder.vpe");
  EXPECT_NE(message(dir / "folder.vpe"), "no error");
}

TEST(PlanetFile, RefusesNewerAndIncompleteFiles) {
  TempDir dir;
  const auto path = dir / "p.vpe";
  build_fake(path, FakeElevation(bumpy_height), 400000);
  const auto variant = [&](const std::string& name, const std::string& sql) {
    std::filesystem::copy_file(path, dir / name);
    change(dir / name, sql);
    return message(dir / name);
  };
  EXPECT_NE(variant("newer.vpe", "UPDATE meta SET value = '2.0' WHERE key = 'format'").find("newer"),
            std::string::npos);
  EXPECT_NE(variant("nometa.vpe", "DELETE FROM meta WHERE key = 'radius_m'").find("checksum"),
            std::string::npos);
  EXPECT_NE(variant("radius.vpe", "UPDATE meta SET value = '-5' WHERE key = 'radius_m'").find("checksum"),
            std::string::npos);
  EXPECT_NE(variant("json.vpe", "UPDATE meta SET value = '{' WHERE key = 'sources'").find("checksum"),
            std::string::npos);
  EXPECT_NE(variant("node.vpe", "UPDATE node SET min_m = min_m + 1 WHERE rowid = (SELECT max(key) FROM node)")
                .find("tile index"),
            std::string::npos);
  EXPECT_NE(variant("gone.vpe", "DELETE FROM node WHERE key = (SELECT max(key) FROM node)")
                .find("tiles are in the index"),
            std::string::npos);
}

// Files of format 1.0 have no summary by level. Files up to 1.1 do not state how far the posts of inner tiles
// are from the reference surface, those up to 1.2 not which source each post has. All can be opened and verified.
TEST(PlanetFile, OlderFilesOpen) {
  TempDir dir;
  const auto path = dir / "p.vpe";
  build_fake(path, FakeElevation(bumpy_height), 100000);
  const auto inner = [](const PlanetFile& planet) {
    const auto tiles = planet.tree().tiles();
    return std::count_if(tiles.begin(), tiles.end(), [](const auto& tile) { return tile.has_children; });
  };
  const auto stated = [](const PlanetFile& planet) {
    const auto tiles = planet.tree().tiles();
    return std::count_if(tiles.begin(), tiles.end(), [](const auto& tile) { return tile.posts_terms.known(); });
  };
  {
    const auto planet = PlanetFile::open(path.string());
    EXPECT_GT(inner(*planet), 0);
    EXPECT_EQ(stated(*planet), inner(*planet));
  }
  test_support::make_older(path.string(), "1.2");
  {
    const auto planet = PlanetFile::open(path.string());
    EXPECT_EQ(stated(*planet), inner(*planet));
    EXPECT_TRUE(paging::verify(*planet, {.threads = 2}).problems.empty());
  }
  test_support::make_older(path.string(), "1.1");
  {
    const auto planet = PlanetFile::open(path.string());
    EXPECT_EQ(stated(*planet), 0);
    EXPECT_FALSE(planet->meta().levels.empty());
    read_all(*planet);
  }
  test_support::make_older(path.string(), "1.0");
  const auto planet = PlanetFile::open(path.string());
  EXPECT_TRUE(planet->meta().levels.empty());
  read_all(*planet);
}

TEST(PlanetFile, ChangedErrorsOfPostsAreFound) {
  TempDir dir;
  const auto path = dir / "p.vpe";
  build_fake(path, FakeElevation(bumpy_height), 100000);
  change(path, "UPDATE posts_error SET total_m = total_m / 2 WHERE key = (SELECT max(key) FROM posts_error)");
  EXPECT_NE(message(path).find("the tile index is wrong"), std::string::npos) << message(path);
}

TEST(PlanetFile, DamagedTilesAreNamed) {
  TempDir dir;
  const auto path = dir / "p.vpe";
  build_fake(path, FakeElevation(bumpy_height), 400000);
  change(path, "UPDATE heights SET data = zeroblob(length(data)) WHERE key = (SELECT max(key) FROM heights)");
  change(path, "DELETE FROM mesh WHERE key = (SELECT max(key) FROM mesh)");
  const auto planet = PlanetFile::open(path.string());
  const lod::TileKey worst =
      std::max_element(planet->tree().tiles().begin(), planet->tree().tiles().end(),
                       [](const auto& a, const auto& b) { return lod::pack(a.key) < lod::pack(b.key); })
          ->key;
  try {
    planet->heights(worst);
    FAIL();
  } catch (const PlanetError& e) {
    EXPECT_NE(std::string(e.what()).find(lod::to_string(worst)), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("checksum"), std::string::npos) << e.what();
  }
  EXPECT_THROW(planet->mesh(worst, 0), PlanetError);
}

// Flipped bits and truncations: an error or the true content, never anything else.
TEST(PlanetFile, AnyChangeOfMetaIsSeen) {
  paging::PlanetMeta meta;
  meta.body = "Mars";
  meta.radius_m = 3396190;
  meta.shape = "sphere";
  meta.quantum_m = 0.25;
  const auto rows = paging::to_rows(meta);
  for (const auto& [key, value] : rows) {
    auto changed = rows;
    changed[key] = value + "1";
    EXPECT_THROW(paging::from_rows(changed, "x"), PlanetError) << key;
    changed = rows;
    changed.erase(key);
    EXPECT_THROW(paging::from_rows(changed, "x"), PlanetError) << key;
  }
  meta.radius_m = -5;
  EXPECT_THROW(paging::from_rows(paging::to_rows(meta), "x"), PlanetError);
  auto more = rows;
  more["remark"] = "slipped in";
  EXPECT_THROW(paging::from_rows(more, "x"), PlanetError);
}

// Numbers that no whole one of the program can hold, under right checksums: found by the fuzzer.
TEST(PlanetFile, CountsThatAreNoneAreRefused) {
  TempDir dir;
  const std::filesystem::path file = dir / "p.vpe";
  build_fake(file, FakeElevation(bumpy_height), 2e6);
  for (const char* key : {"tile_k", "resampling_posts", "leaf_tiles", "tiles", "image_tiles", "finest_level",
                          "finest_image_level"}) {
    for (const char* bad : {"-1e300", "1e300", "2.5", "1e2", "99999999999999999999", "true", "\"7\"", "null"}) {
      const std::filesystem::path copy = dir / "copy.vpe";
      std::filesystem::copy_file(file, copy, std::filesystem::copy_options::overwrite_existing);
      change(copy, std::string("UPDATE meta SET value = '") + bad + "' WHERE key = '" + key + "'");
      test_support::forge_checksums(copy.string());
      EXPECT_NE(message(copy).find(std::string("meta '") + key), std::string::npos)
          << bad << ": " << message(copy);
    }
  }
}

TEST(PlanetFile, FlippedBitsAreNeverBelieved) {
  TempDir dir;
  const auto path = dir / "p.vpe";
  const auto good = build_fake(path, FakeElevation(bumpy_height), 400000);
  std::ifstream in(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  Random random(51);
  int refused = 0;
  for (int round = 0; round < 60; ++round) {
    std::string damaged = bytes;
    if (round % 5 == 4) {
      damaged.resize(static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()))));
    } else {
      for (int flips = 0; flips < 8; ++flips) {
        auto& byte = damaged[static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1))];
        byte = static_cast<char>(byte ^ (1 << random.integer(0, 7)));
      }
    }
    const auto bad = dir / "bad.vpe";
    std::ofstream(bad, std::ios::binary | std::ios::trunc) << damaged;
    try {
      const auto planet = PlanetFile::open(bad.string());
      for (const lod::TileInfo& info : planet->tree().tiles()) {
        ASSERT_EQ(planet->heights(info.key).posts.height_m, good->heights(info.key).posts.height_m);
      }
      read_all(*planet);
    } catch (const PlanetError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 30);
}

// Two planets of equal tiles and different heights.
class ReplacedPlanet : public testing::Test {
 protected:
  void SetUp() override {
    build_fake(path_, FakeElevation(bumpy_height), 400000);
    build_fake(other_, FakeElevation([](const glm::dvec3& d) { return bumpy_height(d) + 5000; }), 400000);
  }

  // Reads all heights. Returns what is thrown, or an empty text. Expects that heights are those of `first`.
  static std::string read_as(const PlanetFile& planet, const std::vector<std::vector<double>>& first) {
    try {
      for (std::size_t n = 0; n < first.size(); ++n) {
        const auto heights = planet.heights(planet.tree().tiles()[n].key);
        EXPECT_EQ(heights.posts.height_m, first[n]) << "of the other planet";
        if (heights.posts.height_m != first[n]) break;
      }
    } catch (const PlanetError& e) {
      return e.what();
    }
    return {};
  }
  static std::vector<std::vector<double>> heights_of(const PlanetFile& planet) {
    std::vector<std::vector<double>> all;
    for (const lod::TileInfo& tile : planet.tree().tiles())
      all.push_back(planet.heights(tile.key).posts.height_m);
    return all;
  }

  TempDir dir_;
  std::filesystem::path path_ = dir_ / "p.vpe";
  std::filesystem::path other_ = dir_ / "other.vpe";
};

TEST_F(ReplacedPlanet, ByRenamingIsNeverMixed) {
  const auto planet = PlanetFile::open(path_.string());
  const auto first = heights_of(*planet);
  std::filesystem::rename(other_, path_);
  // Threads that find no idle connection open the path again. On a busy machine they may all find one for a while.
  std::mutex mutex;
  std::set<std::string> said;
  const auto read_often = [&] {
    for (int round = 0; round < 20; ++round) {
      const std::string text = read_as(*planet, first);
      const std::lock_guard lock(mutex);
      if (!text.empty()) said.insert(text);
    }
  };
  for (int pass = 0; pass < 200 && said.empty(); ++pass) {
    std::vector<std::thread> threads;
    for (int n = 0; n < 16; ++n) threads.emplace_back(read_often);
    for (std::thread& thread : threads) thread.join();
  }
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said.begin()->find("another planet file was written there"), std::string::npos) << *said.begin();
  EXPECT_NE(said.begin()->find(path_.string()), std::string::npos) << *said.begin();
  EXPECT_THROW(planet->connect(), PlanetError);
}

TEST_F(ReplacedPlanet, ByWritingInPlaceIsNeverRead) {
  const auto planet = PlanetFile::open(path_.string());
  const auto first = heights_of(*planet);
  std::filesystem::copy_file(other_, path_, std::filesystem::copy_options::overwrite_existing);
  EXPECT_NE(read_as(*planet, first).find("another planet file"), std::string::npos);
}

TEST_F(ReplacedPlanet, ByTheSameContentIsReadOn) {
  const auto planet = PlanetFile::open(path_.string());
  const auto first = heights_of(*planet);
  std::filesystem::copy_file(path_, dir_ / "copy.vpe");
  std::filesystem::rename(dir_ / "copy.vpe", path_);
  EXPECT_NO_THROW(planet->connect());
  std::filesystem::last_write_time(path_, std::filesystem::file_time_type::clock::now());
  EXPECT_EQ(read_as(*planet, first), "");
}

// Bytes that this process has passed to read or write calls.
std::int64_t process_bytes(const std::string& key) {
  std::ifstream file("/proc/self/io");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(key + ": ")) return std::stoll(line.substr(key.size() + 2));
  }
  return -1;
}

class FineImage : public test_support::FakeImage {
 public:
  double spacing_in(const mars::Cap&) const override { return 5000; }
};

TEST(PlanetFile, OpeningReadsNoImages) {
  TempDir dir;
  paging::BuildOptions options;
  options.output = (dir / "p.vpe").string();
  options.base_spacing_m = 400000;
  options.tile_k = 5;
  options.resampling_posts = 100;
  const FineImage image;
  paging::build_planet(options, FakeElevation(bumpy_height), &image);
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(options.output));
  const std::int64_t before = process_bytes("rchar");
  if (before < 0) GTEST_SKIP() << "no /proc/self/io";
  const auto planet = PlanetFile::open(options.output);
  EXPECT_GT(planet->image_keys().size(), 100U);
  const std::int64_t read = process_bytes("rchar") - before;
  EXPECT_LT(read, 2000 * static_cast<std::int64_t>(planet->image_keys().size()));
  EXPECT_LT(10 * read, size);
}

// SQLite sorts in temporary files: payloads must not be sorted, because they may be larger than the folder of such
// files.
TEST(PlanetFile, SummingLevelsWritesNothing) {
  TempDir dir;
  paging::Database db((dir / "p.vpe").string(), paging::Database::Mode::kCreate);
  db.execute(paging::kSchema);
  db.execute("BEGIN");
  for (const char* table : {"heights", "image"}) {
    db.execute("WITH RECURSIVE c(x) AS (SELECT 0 UNION ALL SELECT x + 1 FROM c WHERE x < 999) INSERT INTO " +
               std::string(table) + " SELECT x << 30, 0, randomblob(20000) FROM c");
  }
  db.execute("COMMIT");
  const std::int64_t before = process_bytes("wchar");
  if (before < 0) GTEST_SKIP() << "no /proc/self/io";
  const std::vector<paging::LevelSummary> levels = paging::summarize_levels(db, 1);
  ASSERT_EQ(levels.size(), 1U);
  EXPECT_EQ(levels[0].bytes, 2 * 1000 * 20000);
  EXPECT_EQ(levels[0].image_tiles, 1000);
  EXPECT_LT(process_bytes("wchar") - before, 100000);
}

}  // namespace
