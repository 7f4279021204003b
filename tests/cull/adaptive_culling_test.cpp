// Counted frames: a culler that costs more than it saves goes off, is tried again, ever more rarely, and one
// that pays stays.
#include "cull/adaptive_culling.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/support.h"

namespace {

using cull::CullerFrame;
using cull::CullerWorth;
using cull::WorthLimits;

// Runs frames in which the culler takes spent_ms and culls `culled` tiles of 1 ms; how many it was used in.
int run(CullerWorth& worth, int frames, double spent_ms, int culled) {
  int used = 0;
  for (int n = 0; n < frames; ++n) {
    if (worth.use()) {
      worth.used({spent_ms, 100, culled, 1.0});
      ++used;
    } else {
      worth.not_used();
    }
  }
  return used;
}

TEST(CullerWorth, OneThatPaysIsAlwaysUsed) {
  CullerWorth worth;
  EXPECT_EQ(run(worth, 5000, 1.0, 3), 5000);
}

TEST(CullerWorth, OneThatDoesNotIsTriedEverMoreRarely) {
  const WorthLimits limits;
  CullerWorth worth(limits);
  EXPECT_EQ(run(worth, limits.trial_frames, 2.0, 1), limits.trial_frames);
  EXPECT_FALSE(worth.use());
  EXPECT_EQ(run(worth, limits.wait_frames, 2.0, 1), 0);
  EXPECT_TRUE(worth.use());
  EXPECT_EQ(run(worth, limits.trial_frames, 2.0, 1), limits.trial_frames);
  EXPECT_EQ(run(worth, 2 * limits.wait_frames, 2.0, 1), 0);
  EXPECT_TRUE(worth.use());
  // In the long run less than one frame in 200.
  run(worth, 5000, 2.0, 1);
  EXPECT_LT(run(worth, 20000, 2.0, 1), 100);
  EXPECT_GT(run(worth, 2 * limits.longest_wait_frames, 2.0, 1), 0) << "it is never given up";
}

TEST(CullerWorth, FollowsTheScene) {
  const WorthLimits limits;
  CullerWorth worth(limits);
  run(worth, 100, 1.0, 10);  // a canyon
  EXPECT_TRUE(worth.use());
  const int on = run(worth, 100, 1.0, 0);  // over a plain
  EXPECT_GT(on, 1);
  EXPECT_LT(on, 40);
  EXPECT_FALSE(worth.use());
  run(worth, limits.longest_wait_frames + limits.trial_frames, 1.0, 10);  // back
  EXPECT_EQ(run(worth, 100, 1.0, 10), 100);
  // Its waits are short again.
  run(worth, 30, 1.0, 0);
  ASSERT_FALSE(worth.use());
  run(worth, limits.wait_frames, 1.0, 10);
  EXPECT_TRUE(worth.use());
}

// Between both ratios whatever is, stays: no switching to and fro at the edge.
TEST(CullerWorth, DoesNotFlicker) {
  CullerWorth on;
  run(on, 50, 1.0, 2);
  EXPECT_EQ(run(on, 2000, 1.0, 1), 2000) << "saves as much as it costs: stays on";
  CullerWorth off;
  run(off, 50, 3.0, 1);
  ASSERT_FALSE(off.use());
  EXPECT_LT(run(off, 2000, 1.0, 1), 60) << "saves as much as it costs: stays off";
  // Noise of +-60 % about a culler that pays twice its cost.
  test_support::Random random(5);
  CullerWorth noisy;
  int used = 0;
  for (int n = 0; n < 5000; ++n) {
    if (noisy.use()) {
      noisy.used({random.uniform(0.4, 1.6), 100, random.integer(0, 4), 1.0});
      ++used;
    } else {
      noisy.not_used();
    }
  }
  EXPECT_GT(used, 4500);
}

TEST(CullerWorth, OneBadFrameIsForgiven) {
  CullerWorth worth;
  run(worth, 50, 1.0, 5);
  worth.used({10.0, 100, 0, 1.0});
  EXPECT_TRUE(worth.use());
  EXPECT_EQ(run(worth, 100, 1.0, 5), 100);
}

TEST(CullerWorth, WhatSaysNothingChangesNothing) {
  CullerWorth worth;
  for (int n = 0; n < 100; ++n) {
    worth.used({1.0, 0, 0, 1.0});  // nothing was tested
    worth.used({std::numeric_limits<double>::quiet_NaN(), 5, 0, 1.0});
    worth.used({-1.0, 5, 0, 1.0});
  }
  EXPECT_TRUE(worth.use());
  worth.not_used();
  EXPECT_TRUE(worth.use());
}

}  // namespace
