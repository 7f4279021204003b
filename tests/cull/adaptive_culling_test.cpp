// Counted frames: a culler that costs more than it saves is switched off and tried again, more and more rarely;
// one that saves time stays.
#include "cull/adaptive_culling.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/support.h"

namespace {

using cull::AdaptiveCulling;
using cull::AdaptiveCullingLimits;
using cull::CullingFrame;

// Runs frames in which the culler takes spent_ms and culls `culled` tiles of 1 ms. Returns the number of frames
// in which it was used.
int run(AdaptiveCulling& culling, int frames, double spent_ms, int culled) {
  int record_frame = 0;
  for (int n = 0; n < frames; ++n) {
    if (culling.use()) {
      culling.record_frame({spent_ms, 100, culled, 1.0});
      ++record_frame;
    } else {
      culling.skip_frame();
    }
  }
  return record_frame;
}

TEST(AdaptiveCulling, OneThatPaysIsAlwaysUsed) {
  AdaptiveCulling culling;
  EXPECT_EQ(run(culling, 5000, 1.0, 3), 5000);
}

TEST(AdaptiveCulling, OneThatDoesNotIsTriedEverMoreRarely) {
  const AdaptiveCullingLimits limits;
  AdaptiveCulling culling(limits);
  EXPECT_EQ(run(culling, limits.trial_frames, 2.0, 1), limits.trial_frames);
  EXPECT_FALSE(culling.use());
  EXPECT_EQ(run(culling, limits.wait_frames, 2.0, 1), 0);
  EXPECT_TRUE(culling.use());
  EXPECT_EQ(run(culling, limits.trial_frames, 2.0, 1), limits.trial_frames);
  EXPECT_EQ(run(culling, 2 * limits.wait_frames, 2.0, 1), 0);
  EXPECT_TRUE(culling.use());
  // In the long run less than one frame in 200.
  run(culling, 5000, 2.0, 1);
  EXPECT_LT(run(culling, 20000, 2.0, 1), 100);
  EXPECT_GT(run(culling, 2 * limits.longest_wait_frames, 2.0, 1), 0) << "it is never given up";
}

TEST(AdaptiveCulling, FollowsTheScene) {
  const AdaptiveCullingLimits limits;
  AdaptiveCulling culling(limits);
  run(culling, 100, 1.0, 10);  // a canyon
  EXPECT_TRUE(culling.use());
  const int on = run(culling, 100, 1.0, 0);  // over a plain
  EXPECT_GT(on, 1);
  EXPECT_LT(on, 40);
  EXPECT_FALSE(culling.use());
  run(culling, limits.longest_wait_frames + limits.trial_frames, 1.0, 10);  // back
  EXPECT_EQ(run(culling, 100, 1.0, 10), 100);
  // Its waits are short again.
  run(culling, 30, 1.0, 0);
  ASSERT_FALSE(culling.use());
  run(culling, limits.wait_frames, 1.0, 10);
  EXPECT_TRUE(culling.use());
}

// Between both ratios nothing changes, so that it does not switch to and fro.
TEST(AdaptiveCulling, DoesNotFlicker) {
  AdaptiveCulling on;
  run(on, 50, 1.0, 2);
  EXPECT_EQ(run(on, 2000, 1.0, 1), 2000) << "saves as much as it costs: stays on";
  AdaptiveCulling off;
  run(off, 50, 3.0, 1);
  ASSERT_FALSE(off.use());
  EXPECT_LT(run(off, 2000, 1.0, 1), 60) << "saves as much as it costs: stays off";
  // Noise of +-60 % about a culler that pays twice its cost.
  test_support::Random random(5);
  AdaptiveCulling noisy;
  int record_frame = 0;
  for (int n = 0; n < 5000; ++n) {
    if (noisy.use()) {
      noisy.record_frame({random.uniform(0.4, 1.6), 100, random.integer(0, 4), 1.0});
      ++record_frame;
    } else {
      noisy.skip_frame();
    }
  }
  EXPECT_GT(record_frame, 4500);
}

TEST(AdaptiveCulling, OneBadFrameIsForgiven) {
  AdaptiveCulling culling;
  run(culling, 50, 1.0, 5);
  culling.record_frame({10.0, 100, 0, 1.0});
  EXPECT_TRUE(culling.use());
  EXPECT_EQ(run(culling, 100, 1.0, 5), 100);
}

TEST(AdaptiveCulling, WhatSaysNothingChangesNothing) {
  AdaptiveCulling culling;
  for (int n = 0; n < 100; ++n) {
    culling.record_frame({1.0, 0, 0, 1.0});  // nothing was tested
    culling.record_frame({std::numeric_limits<double>::quiet_NaN(), 5, 0, 1.0});
    culling.record_frame({-1.0, 5, 0, 1.0});
  }
  EXPECT_TRUE(culling.use());
  culling.skip_frame();
  EXPECT_TRUE(culling.use());
}

}  // namespace
