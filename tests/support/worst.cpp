#include "tests/support/worst.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace test_support {

namespace {

std::string text_of(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", number);
  return text;
}

// "stability/jitter_test Jitter.PostsMoveSmoothly".
std::string running_test() {
  const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
  if (test == nullptr) return "none";
  std::string file = test->file();
  if (const auto folder = file.rfind("tests/"); folder != std::string::npos) file.erase(0, folder + 6);
  if (const auto dot = file.rfind('.'); dot != std::string::npos) file.erase(dot);
  return file + " " + test->test_suite_name() + "." + test->name();
}

// One write of a short line to a file opened for appending stays whole, whoever else writes.
void append(const char* path, const std::string& line) {
  const int file = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  const bool written = file >= 0 && write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  if (file >= 0) close(file);
  if (!written) ADD_FAILURE() << "cannot write to $VPE_NUMERICS_OUT, " << path;
}

}  // namespace

void record_worst(const std::string& claim, double value, double bound, const std::string& unit) {
  EXPECT_LE(value, bound) << claim;
  const std::string measured = text_of(value);
  const std::string allowed = text_of(bound);
  std::printf("worst: %s: %s of %s %s\n", claim.c_str(), measured.c_str(), allowed.c_str(), unit.c_str());
  ::testing::Test::RecordProperty("worst " + claim, measured + " of " + allowed + " " + unit);
  if (const char* path = std::getenv("VPE_NUMERICS_OUT"))
    append(path, claim + "\t" + measured + "\t" + allowed + "\t" + unit + "\t" + running_test() + "\n");
}

}  // namespace test_support
