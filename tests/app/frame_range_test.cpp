// The frames that a run makes: --frames and --part.
#include "vpe/app/film/film_plan.h"

#include <gtest/gtest.h>

#include <map>

#include "vpe/app/cli/program.h"
#include "vpe/app/planet/shard_option.h"

namespace {

using vpe::app::Shard;
using vpe::app::UsageError;

using Variables = std::map<std::string, std::string>;

Shard part(const std::string& text, const Variables& variables = {}) {
  return vpe::app::parse_shard(text, [&](const char* name) -> const char* {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  });
}

void expect_part(const Shard& got, std::int64_t number, std::int64_t of) {
  EXPECT_EQ(got.number, number);
  EXPECT_EQ(got.of, of);
}

TEST(FilmPart, IsKOfN) {
  expect_part(part(""), 1, 1);
  expect_part(part("2/3"), 2, 3);
  for (const char* bad : {"0/3", "4/3", "1", "1/", "/2", "a/b", "1/2/3", "-1/2", "1.5/2", "AUTO"}) {
    EXPECT_THROW(part(bad), UsageError) << bad;
  }
}

TEST(FilmPart, PartsFollowEachOtherAndAreEven) {
  for (const std::int64_t count : {0, 1, 5, 7, 100, 1234567}) {
    for (const std::int64_t of : {1, 2, 3, 7, 64}) {
      std::int64_t at = 0;
      for (std::int64_t k = 1; k <= of; ++k) {
        const Shard p{k, of};
        EXPECT_EQ(p.begin(count), at);
        at = p.end(count);
        EXPECT_LE(std::abs((at - p.begin(count)) - count / of), 1);
      }
      EXPECT_EQ(at, count);
    }
  }
}

TEST(FilmPart, AutoReadsEachEnvironment) {
  expect_part(part("auto", {{"SLURM_ARRAY_TASK_ID", "0"}, {"SLURM_ARRAY_TASK_COUNT", "4"}}), 1, 4);
  expect_part(part("auto", {{"SLURM_ARRAY_TASK_ID", "3"}, {"SLURM_ARRAY_TASK_COUNT", "4"}}), 4, 4);
  const Variables from_one{{"SLURM_ARRAY_TASK_ID", "4"},
                           {"SLURM_ARRAY_TASK_COUNT", "4"},
                           {"SLURM_ARRAY_TASK_MIN", "1"},
                           {"SLURM_ARRAY_TASK_STEP", "1"}};
  expect_part(part("auto", from_one), 4, 4);
  const Variables steps{{"SLURM_ARRAY_TASK_ID", "14"},
                        {"SLURM_ARRAY_TASK_COUNT", "3"},
                        {"SLURM_ARRAY_TASK_MIN", "10"},
                        {"SLURM_ARRAY_TASK_STEP", "4"}};
  expect_part(part("auto", steps), 2, 3);
  expect_part(part("auto", {{"OMPI_COMM_WORLD_RANK", "1"}, {"OMPI_COMM_WORLD_SIZE", "2"}}), 2, 2);
  expect_part(part("auto", {{"PMI_RANK", "0"}, {"PMI_SIZE", "5"}}), 1, 5);
  expect_part(part("auto", {{"SLURM_PROCID", "7"}, {"SLURM_NTASKS", "8"}}), 8, 8);
  // An array's task also has srun's variables.
  Variables both = from_one;
  both["SLURM_PROCID"] = "0";
  both["SLURM_NTASKS"] = "1";
  expect_part(part("auto", both), 4, 4);
}

TEST(FilmPart, AutoOfACountTakesTheNumberOfTheTask) {
  const auto task = [](const char* id, const char* count, const char* least) {
    return Variables{{"SLURM_ARRAY_TASK_ID", id},
                     {"SLURM_ARRAY_TASK_COUNT", count},
                     {"SLURM_ARRAY_TASK_MIN", least},
                     {"SLURM_PROCID", "0"},
                     {"SLURM_NTASKS", "1"}};
  };
  expect_part(part("auto/6", task("3", "6", "1")), 3, 6);
  expect_part(part("auto/6", task("3", "1", "3")), 3, 6);  // sent again alone
  expect_part(part("auto/6", task("5", "2", "3")), 5, 6);  // and with another
  expect_part(part("auto/1", task("1", "1", "1")), 1, 1);
  for (const char* id : {"0", "7"}) EXPECT_THROW(part("auto/6", task(id, "6", "0")), UsageError) << id;
  expect_part(part("auto/5", {{"PMI_RANK", "0"}, {"PMI_SIZE", "5"}}), 1, 5);
  EXPECT_THROW(part("auto/6", {{"PMI_RANK", "0"}, {"PMI_SIZE", "5"}}), UsageError);
  EXPECT_THROW(part("auto/6"), UsageError);
  for (const char* bad : {"auto/", "auto/0", "auto/x", "auto/2/3", "auto/-1", "auto6"})
    EXPECT_THROW(part(bad, task("1", "6", "1")), UsageError) << bad;
}

TEST(FilmPart, AutoOfOneTaskOfAnArrayIsRefused) {
  try {
    part("auto",
         {{"SLURM_ARRAY_TASK_ID", "3"}, {"SLURM_ARRAY_TASK_COUNT", "1"}, {"SLURM_ARRAY_TASK_MIN", "3"}});
    FAIL();
  } catch (const UsageError& e) {
    EXPECT_NE(std::string(e.what()).find("auto/n"), std::string::npos) << e.what();
  }
  expect_part(part("auto", {{"PMI_RANK", "0"}, {"PMI_SIZE", "1"}}), 1, 1);
}

TEST(FilmPart, AutoReportsWhatIsMissingOrDoesNotFit) {
  const auto message = [](const Variables& variables) -> std::string {
    try {
      part("auto", variables);
    } catch (const UsageError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(message({}).find("SLURM_ARRAY_TASK_ID, OMPI_COMM_WORLD_RANK, PMI_RANK, SLURM_PROCID"),
            std::string::npos);
  EXPECT_NE(message({{"PMI_RANK", "1"}}).find("PMI_SIZE is not"), std::string::npos);
  EXPECT_NE(message({{"PMI_RANK", "x"}, {"PMI_SIZE", "2"}}).find("PMI_RANK='x'"), std::string::npos);
  EXPECT_NE(message({{"PMI_RANK", "2"}, {"PMI_SIZE", "2"}}).find("does not fit"), std::string::npos);
  // Counted from 1 without SLURM_ARRAY_TASK_MIN: part 1 would never be made.
  EXPECT_NE(
      message({{"SLURM_ARRAY_TASK_ID", "4"}, {"SLURM_ARRAY_TASK_COUNT", "4"}}).find("SLURM_ARRAY_TASK_MIN"),
      std::string::npos);
  const Variables uneven{
      {"SLURM_ARRAY_TASK_ID", "7"}, {"SLURM_ARRAY_TASK_COUNT", "3"}, {"SLURM_ARRAY_TASK_MIN", "1"}};
  EXPECT_NE(message(uneven).find("does not fit"), std::string::npos);
}

}  // namespace
