// Small planets for tests of measuring: bumps with a fine patch, a smooth sphere, a ridge.
#pragma once

#include <memory>

#include "tests/paging/planet_fixture.h"

namespace test_support {

inline const glm::dvec3 kPatch = mars::direction({-35.0, 20.0});

// One planet for all tests of a suite.
template <class Maker>
class GroundTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TempDir>();
    surface_ = std::make_unique<paging::Surface>(Maker::make(*folder_ / "p.vpe"), 64 << 20);
  }
  static void TearDownTestSuite() {
    surface_.reset();
    folder_.reset();
  }
  static const paging::Surface& surface() { return *surface_; }

 private:
  static inline std::unique_ptr<TempDir> folder_;
  static inline std::unique_ptr<paging::Surface> surface_;
};

struct BumpyGround {
  static auto make(const std::filesystem::path& path) {
    return build_fake(path, FakeElevation(bumpy_height, fine_around(kPatch, 0.02, 2000)), 100000);
  }
};

struct SmoothGround {
  static auto make(const std::filesystem::path& path) {
    return build_fake(
        path, FakeElevation([](const glm::dvec3&) { return 0.0; }, fine_around(kPatch, 0.02, 1000)), 100000);
  }
};

// A plane through the middle of the patch, tilted by 20 degrees to the sphere there, within some 100 km;
// elsewhere it ends at +-30 km.
struct PlaneGround {
  static glm::dvec3 normal() { return mars::direction({-15, 20}); }
  static double offset_m() { return mars::kMarsRadius_m * glm::dot(normal(), kPatch); }
  static double height_m(const glm::dvec3& d) {
    const double facing = glm::dot(normal(), d);
    return facing > 0.1 ? std::clamp(offset_m() / facing - mars::kMarsRadius_m, -30e3, 30e3) : -30e3;
  }
  static auto make(const std::filesystem::path& path) {
    return build_fake(path, FakeElevation(height_m, fine_around(kPatch, 0.02, 1000)), 100000);
  }
};

// 800 m high, 4 km wide to both sides, along the meridian through kPatch.
struct RidgeGround {
  static double height_m(const glm::dvec3& d) {
    const mars::LonLat p = mars::lon_lat(d);
    const double x = (p.lon_deg + 35.0) * mars::kRadiansPerDegree * std::cos(20 * mars::kRadiansPerDegree) *
                     mars::kMarsRadius_m / 4000;
    return std::abs(x) < 1 ? 800 * (1 - std::abs(x)) : 0.0;
  }
  static auto make(const std::filesystem::path& path) {
    return build_fake(path, FakeElevation(height_m, fine_around(kPatch, 0.008, 500)), 100000);
  }
};

}  // namespace test_support
