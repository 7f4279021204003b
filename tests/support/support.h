// Helpers of every test program: data that may be absent, temporary folders, seeded random numbers.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <glm/vec3.hpp>
#include <random>
#include <string>

namespace test_support {

// Returns the path of real planetary data beside the checkout (or under $VPE_SHARED_DATA), or an empty path
// when it does not exist.
std::filesystem::path shared_data(const std::string& relative);

// Makes a temporary folder, and removes it at the end.
class TempDir {
 public:
  TempDir();
  ~TempDir();
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Gives random numbers from a fixed seed, which the test's output records; $VPE_SEED replaces it.
class Random {
 public:
  explicit Random(std::uint64_t seed);
  double uniform(double low, double high);
  double log_uniform(double low, double high);
  int integer(int low, int high);  // both included
  glm::dvec3 direction();          // uniform on the sphere
  std::mt19937_64& engine() { return engine_; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace test_support

// Skips the current test, with the reason, when the data file is absent.
#define VPE_NEED_SHARED(variable, relative)                                   \
  const std::filesystem::path variable = test_support::shared_data(relative); \
  if (variable.empty()) GTEST_SKIP() << "skipped: no data " << (relative)
