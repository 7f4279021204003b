// Shards of a divided build merge into the undivided planet, also when builds and merges are stopped.
#include "paging/build/merge.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "paging/build/estimate.h"
#include "paging/planet/sqlite.h"
#include "tests/paging/planet_fixture.h"

namespace {

using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::FakeImage;
using test_support::fine_around;
using test_support::Random;
using test_support::SpacingElevation;
using test_support::TempDir;

double height_with_nodata(const glm::dvec3& d) {
  return d.y > 0.98 ? std::numeric_limits<double>::quiet_NaN() : bumpy_height(d);
}

class Merge : public testing::Test {
 protected:
  paging::BuildOptions options(const std::string& name) const {
    paging::BuildOptions o;
    o.output = (dir_ / name).string();
    o.base_spacing_m = 250000;
    o.threads = 2;
    o.tile_k = 4;
    o.resampling_posts = 3000;
    o.commit_s = commit_s_;
    return o;
  }

  paging::BuildSummary build(const paging::BuildOptions& o) const {
    return paging::build_planet(o, source_, &image_);
  }

  paging::BuildEstimate estimate(const paging::BuildOptions& o) const {
    return paging::estimate_build(o, paging::plan_tiles(o, source_), source_, &image_);
  }

  paging::BuildOptions shard_options(std::int64_t number, std::int64_t of) const {
    paging::BuildOptions o = options(shard_name(number, of));
    o.shard = {number, of};
    return o;
  }
  static std::string shard_name(std::int64_t number, std::int64_t of) {
    return "p." + std::to_string(number) + "-of-" + std::to_string(of) + ".vpe";
  }

  paging::MergeOptions merge_options(std::int64_t of) const {
    paging::MergeOptions m;
    m.output = (dir_ / "merged.vpe").string();
    m.commit_s = commit_s_;
    m.threads = 2;
    for (std::int64_t n = of; n >= 1; --n) m.shards.push_back((dir_ / shard_name(n, of)).string());
    return m;
  }

  paging::BuildSummary build_and_merge(std::int64_t of) const {
    for (std::int64_t n = 1; n <= of; ++n) build(shard_options(n, of));
    return paging::merge_shards(merge_options(of));
  }

  const paging::PlanetMeta& whole() {
    if (whole_.tiles == 0) whole_ = build(options("whole.vpe")).meta;
    return whole_;
  }

  // Returns everything that the tables hold, in a fixed order.
  static std::vector<std::string> rows_of(const std::string& path) {
    std::vector<std::string> rows;
    paging::Database db(path, paging::Database::Mode::kReadOnly);
    for (
        const char* sql :
        {"SELECT key || '=' || value FROM meta ORDER BY key",
         "SELECT key || ' ' || checksum || ' ' || steps || ' ' || sources || ' ' || inner FROM node ORDER BY "
         "key",
         "SELECT key || ' ' || variant || ' ' || triangles FROM variant ORDER BY key, variant",
         "SELECT key || ' ' || checksum FROM posts_error ORDER BY key",
         "SELECT key || ' ' || hex(data) FROM heights ORDER BY key",
         "SELECT key || ' ' || hex(data) FROM missing ORDER BY key",
         "SELECT key || ' ' || hex(data) FROM origin ORDER BY key",
         "SELECT key || ' ' || source || ' ' || posts || ' ' || max_m || ' ' || checksum FROM resampling ORDER BY "
         "key, source",
         "SELECT key || ' ' || variant || ' ' || hex(data) FROM mesh ORDER BY key, variant",
         "SELECT key || ' ' || hex(data) FROM image ORDER BY key",
         "SELECT name FROM sqlite_schema ORDER BY name"}) {
      paging::Statement all(db, sql);
      while (all.step()) rows.push_back(all.text(0));
    }
    return rows;
  }

  void expect_whole(const std::string& path) {
    EXPECT_TRUE(paging::PlanetFile::open(path)->meta() == whole());
    EXPECT_EQ(rows_of(path), rows_of(options("whole.vpe").output));
    EXPECT_FALSE(std::filesystem::exists(path + ".part"));
    EXPECT_FALSE(std::filesystem::exists(path + ".part-journal"));
  }

  std::string refusal(const paging::MergeOptions& m) const {
    try {
      paging::merge_shards(m);
    } catch (const paging::PlanetError& e) {
      EXPECT_FALSE(std::filesystem::exists(m.output));
      EXPECT_FALSE(std::filesystem::exists(m.output + ".part"));
      return e.what();
    }
    return "no error";
  }

  TempDir dir_;
  double commit_s_ = 60;  // in the end only
  const SpacingElevation source_{height_with_nodata,
                                 fine_around(glm::normalize(glm::dvec3(1, 1, 0.3)), 0.05, 40000)};
  const FakeImage image_{};

 private:
  paging::PlanetMeta whole_;
};

TEST_F(Merge, ShardsMergeIntoTheUndividedPlanet) {
  for (const std::int64_t of : {2, 7}) {
    SCOPED_TRACE(of);
    const auto summary = build_and_merge(of);
    EXPECT_EQ(summary.meta.identity, whole().identity);
    expect_whole((dir_ / "merged.vpe").string());
    std::filesystem::remove(dir_ / "merged.vpe");
  }
}

TEST_F(Merge, TheSummaryCountsEverything) {
  build_and_merge(5);
  const auto planet = paging::PlanetFile::open((dir_ / "merged.vpe").string());
  const paging::PlanetMeta& meta = planet->meta();
  std::int64_t tiles = 0;
  std::int64_t leaves = 0;
  std::int64_t images = 0;
  std::int64_t bytes = 0;
  std::int64_t nodata_posts = 0;
  std::int64_t posts = 0;
  double worst = 0;
  for (const paging::LevelSummary& level : meta.levels) {
    tiles += level.tiles;
    leaves += level.leaf_tiles;
    images += level.image_tiles;
    bytes += level.bytes;
    nodata_posts += level.nodata_posts;
    posts += level.resampling.posts;
    worst = std::max(worst, level.resampling.max_m);
  }
  EXPECT_EQ(tiles, meta.tiles);
  EXPECT_EQ(leaves, meta.leaf_tiles);
  EXPECT_EQ(images, meta.image_tiles);
  EXPECT_EQ(posts, meta.resampling.posts);
  EXPECT_EQ(worst, meta.resampling.max_m);
  EXPECT_GT(bytes, 0);
  EXPECT_LT(bytes, static_cast<std::int64_t>(std::filesystem::file_size(planet->path())));
  std::int64_t nodata = 0;
  for (const lod::TileInfo& tile : planet->tree().tiles()) {
    if (tile.has_children) continue;
    const paging::TileHeights heights = planet->heights(tile.key);
    nodata += std::count(heights.nodata.begin(), heights.nodata.end(), true);
  }
  EXPECT_EQ(nodata_posts, nodata);
  EXPECT_GT(nodata_posts, 0);
}

TEST_F(Merge, TheEstimateCountsWhatIsBuilt) {
  const auto all = estimate(options("x.vpe"));
  EXPECT_EQ(all.leaf_tiles, whole().leaf_tiles);
  EXPECT_EQ(all.leaf_tiles + all.inner_tiles, whole().tiles);
  EXPECT_EQ(all.image_tiles, whole().image_tiles);
  std::int64_t leaves = 0;
  for (std::int64_t n = 1; n <= 5; ++n) {
    const auto shard = estimate(shard_options(n, 5));
    leaves += shard.leaf_tiles;
    EXPECT_EQ(shard.leaf_tiles + shard.inner_tiles, build(shard_options(n, 5)).meta.tiles);
    EXPECT_LT(shard.bytes, all.bytes);
    EXPECT_LT(shard.processor_s, all.processor_s);
  }
  EXPECT_EQ(leaves, all.leaf_tiles);
}

// Sums do not depend on order and division.
TEST(ResamplingSum, IsExact) {
  Random random(3);
  std::vector<double> errors;
  for (int n = 0; n < 2000; ++n) errors.push_back(std::exp2(random.uniform(-24, 21)));
  paging::ResamplingSum all;
  for (const double e : errors) all.add(e);
  paging::ResamplingSum parts;
  for (std::size_t part = 0; part < 7; ++part) {
    paging::ResamplingSum one;
    for (std::size_t n = errors.size(); n-- > 0;) {
      if (n % 7 == part) one.add(errors[n]);
    }
    parts.include(one);
  }
  EXPECT_TRUE(parts == all);
  long double squares = 0;
  for (const double e : errors) squares += static_cast<long double>(e) * e;
  const auto rms = static_cast<double>(std::sqrt(squares / static_cast<long double>(errors.size())));
  EXPECT_NEAR(all.error().rms_m, rms, 1e-9 * rms);
  EXPECT_EQ(all.error().max_m, *std::max_element(errors.begin(), errors.end()));
  EXPECT_EQ(paging::ResamplingSum().error(), paging::ResamplingError());
  // A sum that passes 64 bits.
  paging::ResamplingSum large;
  for (int n = 0; n < 1000; ++n) large.add(1e6);
  EXPECT_NEAR(large.error().rms_m, 1e6, 1e-3);
}

TEST_F(Merge, AShardIsRefusedAsAPlanet) {
  build(shard_options(2, 3));
  try {
    paging::PlanetFile::open((dir_ / shard_name(2, 3)).string());
    FAIL();
  } catch (const paging::PlanetError& e) {
    EXPECT_NE(std::string(e.what()).find("part 2 of 3 of a planet; join all 3 with 'vpe merge"),
              std::string::npos)
        << e.what();
  }
}

TEST_F(Merge, RefusesWhatDoesNotMatch) {
  for (std::int64_t n = 1; n <= 3; ++n) build(shard_options(n, 3));
  const paging::MergeOptions good = merge_options(3);
  const auto expect = [&](const paging::MergeOptions& m, const std::vector<std::string>& words) {
    const std::string message = refusal(m);
    for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << message;
  };
  paging::MergeOptions m = good;
  m.shards.erase(m.shards.begin() + 1);
  expect(m, {"of 3 parts 1 are missing: 2"});
  m = good;
  m.shards.push_back(m.shards.front());
  expect(m, {"part 3 of 3", "give each part once"});
  m = good;
  m.shards[0] = (dir_ / "absent.vpe").string();
  expect(m, {"absent.vpe: no such file"});
  whole();
  m.shards[0] = options("whole.vpe").output;
  expect(m, {"whole.vpe: a whole planet"});
  std::ofstream(dir_ / "text.vpe") << std::string(3000, 'x');
  m.shards[0] = (dir_ / "text.vpe").string();
  expect(m, {"text.vpe", "not a part of a planet"});
  m.shards.clear();
  expect(m, {"no parts to merge"});
  // Other options.
  paging::BuildOptions other = shard_options(3, 3);
  other.output = (dir_ / "other.vpe").string();
  other.mesh_ratio = 128;
  build(other);
  m = good;
  m.shards[0] = other.output;
  expect(m, {"made of other sources, with other options"});
  // Another division.
  build(shard_options(2, 2));
  m = good;
  m.shards[1] = (dir_ / shard_name(2, 2)).string();
  expect(m, {"part 2 of 2", "is part 3 of 3"});
}

TEST_F(Merge, ASourceThatChangedUnderItsNameIsNoticed) {
  build(shard_options(1, 2));
  const SpacingElevation changed([](const glm::dvec3& d) { return height_with_nodata(d) + 100 * d.x; },
                                 fine_around(glm::normalize(glm::dvec3(1, 1, 0.3)), 0.05, 40000));
  // The fill is a mean of heights, so most changes alter the fingerprint; this one does not.
  try {
    paging::build_planet(shard_options(2, 2), changed, &image_);
    const std::string message = refusal(merge_options(2));
    EXPECT_TRUE(message.find("a source has changed under its name") != std::string::npos ||
                message.find("made of other sources") != std::string::npos)
        << message;
  } catch (const std::exception& e) {
    FAIL() << e.what();
  }
}

TEST_F(Merge, DamagedShardsAreNamed) {
  for (std::int64_t n = 1; n <= 2; ++n) build(shard_options(n, 2));
  const std::string path = merge_options(2).shards.front();
  for (const char* sql :
       {"UPDATE heights SET data = zeroblob(length(data)) WHERE key = (SELECT max(key) FROM heights)",
        "UPDATE mesh SET data = zeroblob(length(data)) WHERE id = 3",
        "UPDATE image SET checksum = checksum + 1 WHERE key = (SELECT max(key) FROM image)",
        "DELETE FROM node WHERE key = (SELECT min(key) FROM node WHERE NOT inner)", "DELETE FROM note",
        "UPDATE note SET data = zeroblob(40)", "UPDATE meta SET value = '3' WHERE key = 'tiles'",
        "DELETE FROM recipe"}) {
    SCOPED_TRACE(sql);
    const std::filesystem::path copy = dir_ / "copy";
    std::filesystem::copy_file(path, copy, std::filesystem::copy_options::overwrite_existing);
    paging::Database(path, paging::Database::Mode::kCreate).execute(sql);
    try {
      paging::merge_shards(merge_options(2));
      ADD_FAILURE();
    } catch (const paging::PlanetError& e) {
      EXPECT_NE(std::string(e.what()).find(shard_name(2, 2)), std::string::npos) << e.what();
    }
    EXPECT_FALSE(std::filesystem::exists(merge_options(2).output));
    std::filesystem::remove(merge_options(2).output + ".part");
    std::filesystem::copy_file(copy, path, std::filesystem::copy_options::overwrite_existing);
  }
  paging::merge_shards(merge_options(2));
  expect_whole(merge_options(2).output);
}

TEST_F(Merge, StoppedAtAnyStep) {
  for (std::int64_t n = 1; n <= 3; ++n) build(shard_options(n, 3));
  std::int64_t stops = 0;
  for (bool done = false; !done;) {
    std::int64_t calls = 0;
    try {
      paging::merge_shards(merge_options(3), [&](const paging::BuildProgress&) {
        if (++calls > 15 + 12 * stops) throw std::runtime_error("stop");
      });
      done = true;
    } catch (const std::runtime_error& e) {
      ASSERT_STREQ(e.what(), "stop");
      EXPECT_FALSE(std::filesystem::exists(merge_options(3).output));
      ASSERT_LT(++stops, 100);
    }
  }
  EXPECT_GT(stops, 3);
  expect_whole(merge_options(3).output);
}

class LongMerge : public Merge {};

TEST_F(LongMerge, AsManyShardsAsTiles) {
  const std::int64_t leaves = whole().leaf_tiles;
  ASSERT_LT(leaves, 200);
  build_and_merge(leaves);
  expect_whole((dir_ / "merged.vpe").string());
  try {
    build(shard_options(1, leaves + 1));
    FAIL();
  } catch (const paging::PlanetError& e) {
    EXPECT_NE(std::string(e.what()).find("ask for fewer parts"), std::string::npos) << e.what();
  }
}

// Kills builds of shards and the merge.
class Killed : public Merge {
 protected:
  Killed() { commit_s_ = 0; }  // after each tile

  // Runs `work` in processes that are killed after a random time, until one ends; returns how many were killed. Each
  // gets a little more time, as a slow machine may get nothing done in the first.
  static int kill_until_done(const std::function<void()>& work, double longest_s, Random& random) {
    for (int killed = 0;; ++killed, longest_s *= 1.1) {
      const pid_t child = ::fork();
      if (child == 0) {
        try {
          work();
        } catch (const std::exception& e) {
          std::fprintf(stderr, "%s\n", e.what());
          ::_exit(2);
        }
        ::_exit(0);
      }
      ::usleep(static_cast<useconds_t>(1e6 * random.uniform(0, longest_s)));
      ::kill(child, SIGKILL);
      int status = 0;
      ::waitpid(child, &status, 0);
      if (WIFSIGNALED(status)) continue;
      EXPECT_EQ(WEXITSTATUS(status), 0);
      return killed;
    }
  }

  int round(std::int64_t of, Random& random, double longest_s = 0.12) {
    int killed = 0;
    for (std::int64_t n = 1; n <= of; ++n)
      killed += kill_until_done([&] { build(shard_options(n, of)); }, longest_s, random);
    killed += kill_until_done([&] { paging::merge_shards(merge_options(of)); }, longest_s, random);
    expect_whole(merge_options(of).output);
    for (std::int64_t n = 1; n <= of; ++n) std::filesystem::remove(dir_ / shard_name(n, of));
    std::filesystem::remove(merge_options(of).output);
    return killed;
  }
};

TEST_F(Killed, AtRandomMoments) {
  Random random(81);
  // A fast machine ends before it is killed: then kill sooner.
  int killed = 0;
  double longest_s = 0.12;
  for (int n = 0; n < 10 && killed < 4 && !HasFailure(); ++n, longest_s /= 2)
    killed += round(3, random, longest_s);
  EXPECT_GE(killed, 4);
}

class LongKilled : public Killed {};

TEST_F(LongKilled, TwoHundredTimes) {
  Random random(82);
  int killed = 0;
  while (killed < 200 && !HasFailure()) killed += round(random.integer(2, 9), random);
  RecordProperty("kills", killed);
}

// Damages finished shards and partial merges, as damage_and_continue() does for builds.
class LongDamaged : public Merge {
 protected:
  static void flip(const std::filesystem::path& path, Random& random) {
    const auto size = static_cast<int>(std::filesystem::file_size(path));
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    const int at = random.integer(0, size - 1);
    file.seekg(at);
    const int byte = file.get() ^ 1 << random.integer(0, 7);
    file.seekp(at);
    file.put(static_cast<char>(byte));
  }
};

// A flipped bit in a finished shard or a stopped merge never gives other content.
TEST_F(LongDamaged, TwoHundredFlips) {
  for (std::int64_t n = 1; n <= 3; ++n) build(shard_options(n, 3));
  const paging::MergeOptions m = merge_options(3);
  const auto stop_late = [](const paging::BuildProgress& p) {
    if (p.fraction > 0.7) throw std::runtime_error("stop");
  };
  EXPECT_THROW(paging::merge_shards(m, stop_late), std::runtime_error);
  const std::filesystem::path begun = m.output + ".part";
  const std::filesystem::path saved = dir_ / "saved";
  std::filesystem::copy_file(begun, saved);
  Random random(83);
  int refused = 0;
  for (int n = 0; n < 200; ++n) {
    SCOPED_TRACE(n);
    std::filesystem::remove(m.output);
    std::filesystem::copy_file(saved, begun, std::filesystem::copy_options::overwrite_existing);
    const bool of_shard = n % 2 == 0;
    if (of_shard) std::filesystem::remove(begun);  // so that all of the shard is read
    const std::filesystem::path victim =
        of_shard ? m.shards[static_cast<std::size_t>(n / 2 % 3)] : begun.string();
    const std::filesystem::path copy = dir_ / "copy";
    std::filesystem::copy_file(victim, copy, std::filesystem::copy_options::overwrite_existing);
    flip(victim, random);
    try {
      paging::merge_shards(m);
    } catch (const std::runtime_error& e) {
      ++refused;
      EXPECT_NE(std::string(e.what()).find(victim.filename().string()), std::string::npos) << e.what();
      EXPECT_FALSE(std::filesystem::exists(m.output));
      if (of_shard) std::filesystem::copy_file(copy, victim, std::filesystem::copy_options::overwrite_existing);
      if (!of_shard) std::filesystem::remove(begun);
      paging::merge_shards(m);
    }
    expect_whole(m.output);
    if (of_shard) std::filesystem::copy_file(copy, victim, std::filesystem::copy_options::overwrite_existing);
  }
  EXPECT_GT(refused, 20);
  RecordProperty("refused", refused);
}

}  // namespace
