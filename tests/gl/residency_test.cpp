// The counted bytes of tiles are what OpenGL takes for them.
#include <gtest/gtest.h>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include "tests/gl/gl_fixture.h"
#include "tests/support/sanitized.h"
#include "vpe/gl/residency.h"

namespace {

class Residency : public test_support::GlTest {
 protected:
  // Without a GPU all objects are blocks of this process's heap.
  void SetUp() override {
#if defined(__GLIBC__)
    if (test_support::kIsSanitized) GTEST_SKIP() << "skipped: allocations go to the sanitizer";
    if (context_->info().renderer.find("llvmpipe") != std::string::npos) return;
#endif
    GTEST_SKIP() << "skipped: allocations of OpenGL can be measured with llvmpipe and glibc only";
  }

  // Returns the ratio of the bytes that `count` objects take to those that they count. A first batch makes the
  // driver allocate its own tables.
  template <class Make>
  static double taken_to_counted(int count, Make make) {
#if defined(__GLIBC__)
    double ratio = 0;
    for (int round = 0; round < 2; ++round) {
      std::vector<decltype(make())> objects;
      objects.reserve(static_cast<std::size_t>(count));
      const struct mallinfo2 before = mallinfo2();
      std::size_t counted = 0;
      for (int n = 0; n < count; ++n) counted += objects.emplace_back(make()).bytes;
      const struct mallinfo2 after = mallinfo2();
      ratio = static_cast<double>(after.uordblks + after.hblkhd - before.uordblks - before.hblkhd) /
              static_cast<double>(counted);
    }
    return ratio;
#else
    return static_cast<double>(make().bytes) * count;
#endif
  }
};

TEST_F(Residency, MeshesTakeWhatTheyCount) {
  for (const int intervals : {2, 4, 8, 16, 32}) {
    const std::vector<double> heights(static_cast<std::size_t>((intervals + 1) * (intervals + 1)), 100.0);
    for (const bool charts : {true, false}) {
      const auto geometry = vpe::gl::make_geometry({}, lod::mesh_full(intervals), heights, mars::kMarsRadius_m,
                                                   {1, vpe::gl::kTileCentre, charts});
      EXPECT_NEAR(taken_to_counted(300, [&] { return vpe::gl::upload(geometry); }), 1, 0.1)
          << intervals << " charts " << charts;
    }
  }
}

TEST_F(Residency, TexturesTakeWhatTheyCount) {
  for (const int intervals : {32, 128, 256, 512}) {
    const auto texels = static_cast<std::size_t>((intervals + 1) * (intervals + 1));
    for (const int channels : {1, 4}) {
      vpe::gl::ShadedTile tile{intervals, channels, false, 1, {}};
      tile.texels.resize(static_cast<std::size_t>(channels) * texels);
      EXPECT_NEAR(taken_to_counted(30, [&] { return vpe::gl::upload(tile); }), 1, 0.13)
          << intervals << " " << channels;
    }
    vpe::gl::ShadedTile facets{0, 4, false, 1, std::vector<std::uint8_t>(4 * texels)};
    EXPECT_NEAR(taken_to_counted(30, [&] { return vpe::gl::upload(facets); }), 1, 0.1) << intervals;
  }
}

}  // namespace
