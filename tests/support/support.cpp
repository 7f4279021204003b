#include "tests/support/support.h"

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>

namespace test_support {

namespace fs = std::filesystem;

fs::path shared_data(const std::string& relative) {
  const char* root = std::getenv("VPE_SHARED_DATA");
  const fs::path path =
      (root != nullptr ? fs::path(root) : fs::path(VPE_SOURCE_DIR) / ".." / "shared" / "data") / relative;
  std::error_code error;
  return fs::exists(path, error) ? fs::weakly_canonical(path) : fs::path();
}

TempDir::TempDir() {
  std::string pattern = (fs::temp_directory_path() / "vpe-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder " + pattern);
  path_ = pattern;
}

TempDir::~TempDir() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

Random::Random(std::uint64_t seed) {
  if (const char* text = std::getenv("VPE_SEED")) seed = std::strtoull(text, nullptr, 10);
  ::testing::Test::RecordProperty("seed", std::to_string(seed));
  engine_.seed(seed);
}

double Random::uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(engine_);
}

double Random::log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }

int Random::integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }

glm::dvec3 Random::direction() {
  std::normal_distribution<double> normal;
  for (;;) {
    const glm::dvec3 v{normal(engine_), normal(engine_), normal(engine_)};
    const double length = glm::length(v);
    if (length > 1e-3) return v / length;
  }
}

}  // namespace test_support
