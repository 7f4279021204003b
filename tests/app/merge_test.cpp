// vpe build --part and vpe merge.
#include <chrono>
#include <csignal>
#include <fstream>

#include "tests/app/support/app_fixture.h"
#include "vpe/app/planet/planet_build.h"

namespace app_test {
namespace {

class Merge : public AppTest {
 protected:
  void SetUp() override { write_dem(dir_ / "x.tif"); }

  static Words build_words(const std::string& output, const Words& more = {}) {
    Words words{"build", "x.tif", "--image", "x.tif", "-o", output, "--base-spacing", "60000", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  nlohmann::json json_of(const Words& words) const {
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out);
  }
};

TEST_F(Merge, PartsEqualTheWhole) {
  nlohmann::json whole = json_of(build_words("whole.vpe"));
  for (const char* part : {"1/3", "2/3", "3/3"}) {
    const auto built = json_of(build_words("x.vpe", {"--part", part}));
    EXPECT_EQ(built["part"]["of"], 3);
  }
  EXPECT_FALSE(exists("x.vpe"));
  nlohmann::json merged =
      json_of({"merge", "x.2-of-3.vpe", "x.1-of-3.vpe", "x.3-of-3.vpe", "-o", "x.vpe", "--json"});
  for (nlohmann::json* json : {&whole, &merged}) {
    for (const char* own : {"path", "bytes", "tiles_kept", "findings", "notes"}) json->erase(own);
  }
  EXPECT_EQ(merged, whole);
  EXPECT_EQ(vpe({"verify", "x.vpe", "--deep", "-q"}).exit_code, 0);
  EXPECT_EQ(leftovers(), Words{});
}

TEST_F(Merge, PrintsASummary) {
  Result part = vpe({"build", "x.tif", "-o", "x.vpe", "--base-spacing", "60000", "--part", "2/2"});
  EXPECT_EQ(part.exit_code, 0);
  EXPECT_TRUE(says(part.out, {"x.2-of-2.vpe: ", "Part 2 of 2", "vpe merge"}));
  vpe({"build", "x.tif", "-o", "x.vpe", "--base-spacing", "60000", "--part", "1/2"});
  const Result merged = vpe({"merge", "x.1-of-2.vpe", "x.2-of-2.vpe", "-o", "x.vpe"});
  EXPECT_TRUE(says(merged.out, {"x.vpe: ", "resampling error", "nodata posts: 0", "maximum, m"}));
}

// As on clusters that copy the sources to each node.
TEST_F(Merge, PartsOfCopiesOfTheSourcesMerge) {
  Dem fine;
  fine.west_deg = 20;
  fine.north_deg = 30;
  fine.width = fine.height = 60;
  fine.cell_deg = 0.25;
  fine.height_m = [](int column, int row) { return 300.0 + 5 * column + row; };
  for (const char* folder : {"a", "b"}) {
    std::filesystem::create_directory(dir_ / folder);
    write_dem(dir_ / folder / "x.tif");
    write_dem(dir_ / folder / "fine.tif", fine);
    std::filesystem::last_write_time(dir_ / folder / "x.tif", std::filesystem::file_time_type::clock::now() -
                                                                  std::chrono::hours(*folder == 'a' ? 1 : 100));
  }
  const auto build = [&](const std::string& folder, const Words& more) {
    Words words{"build",   folder + "/x.tif", folder + "/fine.tif",
                "--align", "edges",           "--base-spacing",
                "60000",   "--datum",         "areoid",
                "-o",      "x.vpe",           "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return vpe(words);
  };
  ASSERT_EQ(build("a", {"--part", "1/2"}).exit_code, 0);
  ASSERT_EQ(build("b", {"--part", "2/2"}).exit_code, 0);
  const Result merged = vpe({"merge", "x.1-of-2.vpe", "x.2-of-2.vpe", "-o", "merged.vpe", "--json"});
  ASSERT_EQ(merged.exit_code, 0) << merged.err;
  const auto whole = parse_json(build("b", {}).out);
  EXPECT_EQ(parse_json(merged.out)["identity"], whole["identity"]);
  // Other heights in a file of the same size.
  fine.height_m = [](int column, int row) { return 301.0 + 5 * column + row; };
  write_dem(dir_ / "b/fine.tif", fine);
  ASSERT_EQ(build("b", {"--part", "2/2", "--force"}).exit_code, 0);
  expect_failure({"merge", "x.1-of-2.vpe", "x.2-of-2.vpe", "-o", "other.vpe"}, 1,
                 {"x.2-of-2.vpe: made of other sources", "x.1-of-2.vpe", "b/fine.tif: content is"});
  // Other options are named too.
  Words words = build_words("y.vpe", {"--part", "1/2"});
  ASSERT_EQ(vpe(words).exit_code, 0);
  words = build_words("y.vpe", {"--part", "2/2", "--spacing", "70000"});
  ASSERT_EQ(vpe(words).exit_code, 0);
  expect_failure({"merge", "y.1-of-2.vpe", "y.2-of-2.vpe", "-o", "z.vpe"}, 1,
                 {"finest spacing is 70000, not 0"});
}

TEST_F(Merge, AFinishedPartIsKept) {
  const Words words = build_words("x.vpe", {"--part", "1/2"});
  const auto first = parse_json(vpe(words).out);
  const auto part = dir_ / "x.1-of-2.vpe";
  const auto written = std::filesystem::last_write_time(part);
  const Result second = vpe(words);
  EXPECT_EQ(second.exit_code, 0);
  EXPECT_TRUE(says(second.err, {"x.1-of-2.vpe is finished", "kept", "--force"})) << second.err;
  EXPECT_EQ(std::filesystem::last_write_time(part), written);
  auto json = parse_json(second.out);
  EXPECT_EQ(json["tiles_kept"], json["tiles"].get<int>() + json["image_tiles"].get<int>());
  json["tiles_kept"] = first["tiles_kept"];
  EXPECT_EQ(json, first);
  // A damaged part is built again, as is any part with --force.
  {
    std::fstream file(part, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(part) / 2));
    file.write("damage damage damage", 20);
  }
  const Result repaired = vpe(words);
  EXPECT_EQ(repaired.exit_code, 0) << repaired.err;
  // Pages of the file follow the order in which threads finish tiles, so a page more or less may be used.
  auto again = parse_json(repaired.out);
  again["bytes"] = first["bytes"];
  EXPECT_EQ(again, first);
  EXPECT_EQ(parse_json(vpe(build_words("x.vpe", {"--part", "1/2", "--force"})).out)["tiles_kept"], 0);
}

TEST_F(Merge, AnEstimateBuildsNothing) {
  Words words = build_words("x.vpe", {"--estimate"});
  const auto estimate = json_of(words);
  EXPECT_FALSE(exists("x.vpe"));
  const Result built = vpe(build_words("x.vpe"));
  EXPECT_TRUE(says(built.err, {"To build: ", "image tiles", "million posts", "about"}));
  const auto json = parse_json(built.out);
  for (const char* equal : {"tiles", "finest_tiles", "image_tiles", "posts"})
    EXPECT_EQ(estimate[equal], json[equal]) << equal;
  const double ratio = estimate["bytes"].get<double>() / json["bytes"].get<double>();
  EXPECT_GT(ratio, 0.2);
  EXPECT_LT(ratio, 5);
  EXPECT_EQ(vpe(build_words("y.vpe", {"-q"})).err, "");
}

TEST_F(Merge, TheSchedulerSelectsThePart) {
  Command command = command_for(build_words("x.vpe", {"--part", "auto"}));
  command.environment = {
      {"SLURM_ARRAY_TASK_ID", "3"}, {"SLURM_ARRAY_TASK_COUNT", "4"}, {"SLURM_ARRAY_TASK_MIN", "1"}};
  const Result result = run(command);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(exists("x.3-of-4.vpe"));
}

TEST_F(Merge, ATaskThatIsSentAgainKeepsItsPart) {
  const auto task = [&](const char* option, const char* id, const char* count, const char* least) {
    Command command = command_for(build_words("x.vpe", {"--part", option}));
    command.environment = {
        {"SLURM_ARRAY_TASK_ID", id}, {"SLURM_ARRAY_TASK_COUNT", count}, {"SLURM_ARRAY_TASK_MIN", least}};
    return run(command);
  };
  const Result alone = task("auto", "3", "1", "3");
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_TRUE(says(alone.err, {"--part auto", "auto/n", "SLURM_ARRAY_TASK_COUNT=1"})) << alone.err;
  EXPECT_EQ(task("auto/4", "3", "1", "3").exit_code, 0);
  EXPECT_TRUE(exists("x.3-of-4.vpe"));
  const Result two = task("auto", "3", "2", "3");  // 3 and 4 of the same array
  EXPECT_EQ(two.exit_code, 2);
  EXPECT_TRUE(says(two.err, {"1 of 2", "x.3-of-4.vpe", "auto/4"})) << two.err;
  EXPECT_FALSE(exists("x.vpe"));
  EXPECT_FALSE(exists("x.1-of-2.vpe"));
}

TEST(MergeNames, SortLikeParts) {
  EXPECT_EQ(vpe::app::shard_file_name("a/mars.vpe", {7, 12}), "a/mars.07-of-12.vpe");
  EXPECT_EQ(vpe::app::shard_file_name("a.b/mars", {2, 2}), "a.b/mars.2-of-2");
  EXPECT_EQ(vpe::app::shard_file_name("mars.vpe", {1, 1}), "mars.vpe");
}

TEST_F(Merge, PartsAreDescribedAndVerified) {
  const auto built = json_of(build_words("x.vpe", {"--part", "1/2"}));
  const auto info = json_of({"info", "x.1-of-2.vpe", "--json"});
  EXPECT_EQ(info["part"], (nlohmann::json{{"number", 1}, {"of", 2}}));
  for (const char* equal : {"tiles", "identity", "sources", "path"})
    EXPECT_EQ(info[equal], built[equal]) << equal;
  EXPECT_TRUE(says(vpe({"info", "x.1-of-2.vpe"}).out, {"part               1 of 2", "vpe merge"}));
  const auto sound = json_of({"verify", "x.1-of-2.vpe", "--json"});
  EXPECT_EQ(sound["sound"], true);
  EXPECT_EQ(sound["tiles"], built["tiles"]);
  EXPECT_EQ(sound["image_tiles"], built["image_tiles"]);
  EXPECT_TRUE(says(vpe({"verify", "x.1-of-2.vpe"}).out, {"x.1-of-2.vpe: sound as a part: "}));
  expect_failure({"verify", "x.1-of-2.vpe", "--deep"}, 2, {"--deep", "vpe merge"});
  for (const char* table : {"heights", "mesh", "image"}) {
    std::filesystem::copy_file(dir_ / "x.1-of-2.vpe", dir_ / "damaged.vpe",
                               std::filesystem::copy_options::overwrite_existing);
    damage_payloads(dir_ / "damaged.vpe", table);
    expect_failure({"verify", "damaged.vpe"}, 1,
                   {"damaged.vpe: ", "problems", "wrong checksum", "build the part again"});
  }
}

TEST_F(Merge, MessagesSayWhatToDo) {
  vpe(build_words("x.vpe", {"--part", "1/2"}));
  expect_failure({"query", "x.1-of-2.vpe", "1,2"}, 1, {"x.1-of-2.vpe: part 1 of 2 of a planet", "vpe merge"});
  expect_failure({"merge", "x.1-of-2.vpe", "-o", "y.vpe"}, 1, {"of 2 parts 1 are missing: 2", "--part"});
  expect_failure({"merge", "x.1-of-2.vpe", "-o", "x.1-of-2.vpe"}, 2, {"x.1-of-2.vpe", "also an input"});
  expect_failure({"merge", "absent.vpe", "-o", "y.vpe"}, 1, {"absent.vpe", "no such file"});
  expect_failure(build_words("x.vpe", {"--part", "3/2"}), 2, {"--part '3/2'", "k/n"});
  expect_failure(build_words("x.vpe", {"--part", "1/999999"}), 1, {"ask for fewer parts"});
  expect_failure(build_words("x.vpe", {"--part", "auto"}), 2, {"--part auto", "SLURM_ARRAY_TASK_ID"});
}

class LongMerge : public Merge {
 protected:
  // Sends SIGKILL after a random time until the command ends by itself; returns how often.
  int kill_until_done(const Words& words, test_support::Random& random, Result& last) const {
    for (int kills = 0;; ++kills) {
      Command command = command_for(words);
      const auto end =
          std::chrono::steady_clock::now() + std::chrono::duration<double>(random.uniform(0.02, 0.8));
      command.signal = SIGKILL;
      command.when = [end] { return std::chrono::steady_clock::now() > end; };
      last = run(command);
      if (last.exit_code >= 0) return kills;
    }
  }
};

TEST_F(LongMerge, KilledOneHundredTimes) {
  const auto identity = json_of(build_words("whole.vpe"))["identity"];
  test_support::Random random(9);
  int kills = 0;
  while (kills < 100 && !HasFailure()) {
    Words merge{"merge"};
    Result last;
    for (int n = 1; n <= 3; ++n) {
      const std::string number = std::to_string(n);
      kills += kill_until_done(build_words("x.vpe", {"--part", number + "/3"}), random, last);
      EXPECT_EQ(last.exit_code, 0) << last.err;
      merge.push_back("x." + number + "-of-3.vpe");
    }
    merge.insert(merge.end(), {"-o", "x.vpe", "--json"});
    kills += kill_until_done(merge, random, last);
    ASSERT_EQ(last.exit_code, 0) << last.err;
    EXPECT_EQ(parse_json(last.out)["identity"], identity);
    EXPECT_EQ(vpe({"verify", "x.vpe", "-q"}).exit_code, 0);
    for (const std::string name : {"x.vpe", "x.1-of-3.vpe", "x.2-of-3.vpe", "x.3-of-3.vpe"})
      std::filesystem::remove(dir_ / name);
  }
  RecordProperty("kills", kills);
}

}  // namespace
}  // namespace app_test
