// --memory bounds the memory of the process.
#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "tests/app/support/app_fixture.h"
#include "tests/support/sanitized.h"

namespace app_test {
namespace {

constexpr std::int64_t kMega = 1 << 20;
constexpr std::int64_t kSlack = 64 * kMega;

class Memory : public AppTest {
 protected:
  void SetUp() override {
    write_dem(dir_ / "x.tif");
    // 504 tiles of 10 km between posts.
    ASSERT_EQ(vpe({"build", "x.tif", "-o", "x.vpe", "--base-spacing", "11000", "-q"}).exit_code, 0);
    write_text(dir_ / "far.flight",
               "flight 1\nview size=640x360 fps=10\nat 0 set mode=coloured\n"
               "at 0 pose lon=-170 lat=-13 alt=300000 yaw=90 pitch=-35\n"
               "at 1 pose lon=-60  lat=10  alt=300000 yaw=90 pitch=-35\n"
               "at 2 pose lon=60   lat=-10 alt=300000 yaw=90 pitch=-35\n");
  }
  std::int64_t peak(const Words& arguments) const {
    const Result result = vpe(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.peak_bytes;
  }
};

TEST_F(Memory, Render) {
  const Words pose{"--pose", "-170,-13,200000,90,-30,0", "-o", "x.png", "-q"};
  const auto peak_of = [&](const std::string& file, const std::string& size, const std::string& memory) {
    Words words{"render", file, "--size", size, "--memory", memory};
    words.insert(words.end(), pose.begin(), pose.end());
    return peak(words);
  };
  const std::int64_t base = peak_of(planet().string(), "16x9", "64");
  for (const int memory : {128, 256}) {
    EXPECT_LE(peak_of("x.vpe", "640x360", std::to_string(memory)), base + memory * kMega + kSlack) << memory;
  }
}

TEST_F(Memory, RayImagesThatAreTooLargeAreRefusedBeforeTheyAreDrawn) {
  const auto render = [&](const std::string& size, const std::string& memory) {
    return vpe({"render", planet().string(), "--backend", "ray", "--pose", "-170,-13,200000,90,-30,0", "--size",
                size, "-o", "x.png", "-q", "--memory", memory});
  };
  const Result small = render("1920x1080", "64");
  EXPECT_EQ(small.exit_code, 0) << small.err;
  // Cast in bands: 67 bytes a pixel, 1.1 GB, without.
  const Result banded = render("4096x4000", "64");
  EXPECT_EQ(banded.exit_code, 0) << banded.err;
  if (!test_support::kIsSanitized) {
    EXPECT_LT(banded.peak_bytes, small.peak_bytes + (std::int64_t{600} << 20));
  }
  const Result large = render("8192x8192", "64");
  EXPECT_EQ(large.exit_code, 1);
  EXPECT_TRUE(says(large.err, {"8192x8192", "1024 MB", "--memory", "--size"})) << large.err;
  // The peak of a program counts that of the process which started it.
  EXPECT_LE(large.peak_bytes, small.peak_bytes);
  EXPECT_EQ(leftovers(), Words{});
}

TEST_F(Memory, Fly) {
  const auto peak_of = [&](const std::string& file, const std::string& size, const std::string& memory,
                           const std::string& stats) {
    return peak({"fly", "far.flight", file, "-o", "frames", "-q", "--size", size, "--tolerance", "0.3",
                 "--memory", memory, "--stats", stats});
  };
  const auto most_resident = [&](const std::string& stats) {
    std::int64_t most = 0;
    std::istringstream lines(read_text(dir_ / stats));
    for (std::string line; std::getline(lines, line);) {
      most = std::max(most, parse_json(line)["bytes_resident"].get<std::int64_t>());
    }
    return most;
  };
  const std::int64_t base = peak_of(planet().string(), "16x9", "64", "base.jsonl");
  std::int64_t last = 0;
  for (const int memory : {64, 128, 256}) {
    const std::string stats = std::to_string(memory) + ".jsonl";
    EXPECT_LE(peak_of("x.vpe", "640x360", std::to_string(memory), stats), base + memory * kMega + kSlack)
        << memory;
    EXPECT_LE(most_resident(stats), memory * kMega);
    if (memory > 64) {
      EXPECT_GT(most_resident(stats), last) << "the flight needs more than the bound: nothing was tested";
    }
    last = most_resident(stats);
  }
}

class LongMemory : public AppTest {};

// From orbit the report draws images of up to 256 rays a pixel, and three renderers at once.
TEST_F(LongMemory, ErrorTimeReport) {
  const char* planet_file = std::getenv("VPE_EMBEDDED_PLANET");
  if (planet_file == nullptr) GTEST_SKIP() << "skipped: $VPE_EMBEDDED_PLANET names no planet file";
  const auto peak_of = [&](const std::string& size, const std::string& memory) {
    Command command = command_for({"report", "error-time", planet_file, "--view", "orbit", "--rounds", "1",
                                   "--size", size, "--memory", memory, "-q", "-o", "x"});
    command.limit_s = 3000;
    const Result result = run(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.peak_bytes;
  };
  const std::int64_t base = vpe({"info", planet_file}).peak_bytes;
  const std::int64_t peak = peak_of("640x360", "1024");
  RecordProperty("peak", std::to_string(peak));
  EXPECT_LE(peak, base + 1024 * kMega);
  EXPECT_GT(peak, base + 512 * kMega) << "the report needs far less than the bound: nothing was tested";
}

}  // namespace
}  // namespace app_test
