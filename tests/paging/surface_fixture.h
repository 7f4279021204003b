// The surface of a planet by a formula, for tests of what samples it.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "paging/surface/surface.h"
#include "tests/paging/planet_fixture.h"

namespace test_support {

// Makes a planet once for a suite: heights of `height_m` at posts of 60 km, of 8 km within 0.1 radians of the x axis.
template <double (*height_m)(const glm::dvec3&)>
class SurfaceTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = std::make_unique<TempDir>();
    planet_ =
        build_fake(*dir_ / "surface.vpe", FakeElevation(height_m, fine_around({1, 0, 0}, 0.1, 8000)), 60000);
    surface_ = std::make_unique<paging::Surface>(planet_, 64 << 20);
  }
  static void TearDownTestSuite() {
    surface_.reset();
    planet_.reset();
    dir_.reset();
  }

  static inline std::unique_ptr<TempDir> dir_;
  static inline std::shared_ptr<const paging::PlanetFile> planet_;
  static inline std::unique_ptr<paging::Surface> surface_;
};

}  // namespace test_support
