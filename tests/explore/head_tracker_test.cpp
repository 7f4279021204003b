#include "vpe/explore/input/head_tracker.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace vpe::explore {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes datagram(double yaw, double pitch, double roll, double x_cm = 1, double y_cm = 2, double z_cm = 3) {
  const std::array<double, 6> numbers{x_cm, y_cm, z_cm, yaw, pitch, roll};
  Bytes bytes;
  for (const double number : numbers) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &number, sizeof bits);
    for (int n = 0; n < 8; ++n) bytes.push_back(static_cast<std::uint8_t>(bits >> (8 * n)));
  }
  return bytes;
}

double apart(double a, double b) { return std::abs(std::remainder(a - b, 360.0)); }

double apart(const mars::HeadAngles& a, const mars::HeadAngles& b) {
  return std::max(
      {apart(a.yaw_deg, b.yaw_deg), std::abs(a.pitch_deg - b.pitch_deg), apart(a.roll_deg, b.roll_deg)});
}

void expect_look(const mars::HeadAngles& look, double yaw, double pitch, double roll, double within = 1e-6) {
  EXPECT_NEAR(look.yaw_deg, yaw, within);
  EXPECT_NEAR(look.pitch_deg, pitch, within);
  EXPECT_NEAR(look.roll_deg, roll, within);
}

// Feeds the same datagram until the time `to`.
void hold(HeadTracker& tracker, const Bytes& bytes, double from, double to) {
  for (int n = 0; n <= 100; ++n) tracker.receive(bytes, from + (to - from) * n / 100);
}

TEST(HeadDatagram, IsReadLeastSignificantByteFirst) {
  // 1.0 is 3ff0 0000 0000 0000, -2.5 is c004 0000 0000 0000.
  Bytes bytes(48, 0);
  bytes[6] = 0xf0;
  bytes[7] = 0x3f;
  bytes[30] = 0x04;
  bytes[31] = 0xc0;
  const auto read = parse_head_datagram(bytes);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->x_cm, 1.0);
  EXPECT_EQ(read->yaw_deg, -2.5);
  EXPECT_EQ(read->roll_deg, 0.0);
}

TEST(HeadDatagram, OtherSizesAndNumbersAreIgnored) {
  const Bytes good = datagram(1, 2, 3);
  ASSERT_TRUE(parse_head_datagram(good).has_value());
  for (const std::size_t size : {0U, 1U, 24U, 47U}) {
    EXPECT_FALSE(parse_head_datagram(std::span(good).first(size)).has_value()) << size;
  }
  Bytes longer = good;
  longer.push_back(0);
  EXPECT_FALSE(parse_head_datagram(longer).has_value());
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 361.0, -1e300}) {
    EXPECT_FALSE(parse_head_datagram(datagram(bad, 0, 0)).has_value()) << bad;
    EXPECT_FALSE(parse_head_datagram(datagram(0, bad, 0)).has_value()) << bad;
    EXPECT_FALSE(parse_head_datagram(datagram(0, 0, bad)).has_value()) << bad;
  }
  Bytes swapped = good;  // as from a sender with the other byte order
  for (int n = 0; n < 6; ++n) std::reverse(swapped.begin() + 8 * n, swapped.begin() + 8 * n + 8);
  HeadTracker tracker;
  tracker.receive(swapped, 1);
  EXPECT_LT(std::abs(tracker.look(2).yaw_deg), 1e-9);
}

TEST(HeadTracker, WithoutDatagramsItLooksStraightAhead) {
  HeadTracker tracker;
  EXPECT_FALSE(tracker.is_live(0));
  EXPECT_FALSE(tracker.is_moving(0));
  expect_look(tracker.look(5), 0, 0, 0, 0);
  EXPECT_FALSE(tracker.receive(Bytes{1, 2, 3}, 5));
  EXPECT_EQ(tracker.ignored(), 1U);
  EXPECT_EQ(tracker.received(), 0U);
  EXPECT_FALSE(tracker.is_live(5));
}

TEST(HeadTracker, FollowsWithTheSignsOfALook) {
  HeadTracker tracker;
  hold(tracker, datagram(30, 20, -10), 0, 1);
  expect_look(tracker.look(1), 30, 20, -10, 1e-3);
  EXPECT_TRUE(tracker.is_live(1));
  EXPECT_FALSE(tracker.is_moving(1));
  EXPECT_EQ(tracker.received(), 101U);
  // 63 % of a step after smoothing_s.
  tracker.receive(datagram(40, 20, -10), 1);
  EXPECT_NEAR(tracker.look(1 + HeadTrackerOptions{}.smoothing_s).yaw_deg, 30 + 10 * (1 - std::exp(-1)), 1e-3);
  EXPECT_TRUE(tracker.is_moving(1.01));
}

TEST(HeadTracker, InvertsAndScales) {
  HeadTracker tracker({.invert_yaw = true, .invert_roll = true, .scale = 2});
  hold(tracker, datagram(30, 20, -10), 0, 1);
  expect_look(tracker.look(1), -60, 40, 20, 1e-3);
  tracker.set_options({.invert_pitch = true, .scale = 5}, 1);
  expect_look(tracker.look(1), -60, 40, 20, 1e-3);
  hold(tracker, datagram(30, 20, -10), 1, 2);
  expect_look(tracker.look(2), 150, -90, -50, 1e-3);  // pitch ends straight down
}

TEST(HeadTracker, GoesToZeroAfterTheTimeOutAndNotBefore) {
  HeadTracker tracker;
  hold(tracker, datagram(80, -30, 10), 0, 1);
  expect_look(tracker.look(1 + HeadTracker::kTimeout_s), 80, -30, 10, 1e-3);
  EXPECT_TRUE(tracker.is_live(1.5));
  EXPECT_FALSE(tracker.is_live(1.51));
  EXPECT_TRUE(tracker.is_moving(1.51));
  const mars::HeadAngles half = tracker.look(1 + HeadTracker::kTimeout_s + HeadTracker::kEase_s / 2);
  expect_look(half, 40, -15, 5, 1e-3);
  expect_look(tracker.look(1 + HeadTracker::kTimeout_s + HeadTracker::kEase_s), 0, 0, 0, 1e-9);
  expect_look(tracker.look(100), 0, 0, 0, 0);
  EXPECT_FALSE(tracker.is_moving(100));
}

TEST(HeadTracker, ComesBackWithoutAJump) {
  HeadTracker tracker;
  hold(tracker, datagram(80, -30, 10), 0, 1);
  for (const double back_s : {1.6, 1.75, 30.0}) {
    HeadTracker other = tracker;
    const mars::HeadAngles before = other.look(back_s);
    other.receive(datagram(-70, 60, 90), back_s);
    EXPECT_LT(apart(other.look(back_s), before), 1e-9);
    EXPECT_TRUE(other.is_moving(back_s));
    hold(other, datagram(-70, 60, 90), back_s, back_s + HeadTracker::kEase_s);
    expect_look(other.look(back_s + HeadTracker::kEase_s), -70, 60, 90, 1e-3);
  }
}

TEST(HeadTracker, TakesTheShorterDirection) {
  HeadTracker tracker;
  hold(tracker, datagram(175, 0, 0), 0, 1);
  tracker.receive(datagram(-175, 0, 0), 1);
  for (double t = 1; t < 1.3; t += 0.001) EXPECT_GE(std::abs(tracker.look(t).yaw_deg), 174.99) << t;
  EXPECT_NEAR(tracker.look(1.4).yaw_deg, -175, 1e-3);
}

TEST(HeadTracker, RecentresWhereTheHeadIs) {
  HeadTracker tracker;
  tracker.recentre(0);  // nothing has come: nothing happens
  hold(tracker, datagram(30, 20, -10), 0, 1);
  expect_look(tracker.look(1), 30, 20, -10, 1e-3);
  tracker.recentre(1);
  expect_look(tracker.look(1), 30, 20, -10, 1e-3);
  hold(tracker, datagram(30, 20, -10), 1, 2);
  expect_look(tracker.look(2), 0, 0, 0, 1e-3);
  hold(tracker, datagram(35, 20, -20), 2, 3);
  expect_look(tracker.look(3), 5, 0, -10, 1e-3);
}

void expect_position(const HeadPlace& place, double x_m, double y_m, double z_m, double within = 1e-6) {
  EXPECT_NEAR(place.position_m.x, x_m, within);
  EXPECT_NEAR(place.position_m.y, y_m, within);
  EXPECT_NEAR(place.position_m.z, z_m, within);
}

TEST(HeadTracker, FollowsThePositionInMetres) {
  HeadTracker tracker({.invert_yaw = true, .scale = 3});  // of angles alone
  expect_position(tracker.place(0), 0, 0, 0, 0);
  hold(tracker, datagram(0, 0, 0, 10, -20, 60), 0, 1);
  expect_position(tracker.place(1), 0.1, -0.2, 0.6);
  EXPECT_FALSE(tracker.is_moving(1));
  // 63 % of a step after smoothing_s.
  tracker.receive(datagram(0, 0, 0, 20, -20, 60), 1);
  EXPECT_TRUE(tracker.is_moving(1.01));
  EXPECT_NEAR(tracker.place(1 + HeadTrackerOptions{}.smoothing_s).position_m.x, 0.1 + 0.1 * (1 - std::exp(-1)),
              1e-6);
  expect_look(tracker.look(1.02), 0, 0, 0, 0);
}

TEST(HeadTracker, ThePositionRestsAfterTheTimeOutAndIsRecentred) {
  HeadTracker tracker;
  hold(tracker, datagram(0, 0, 0, 10, -20, 60), 0, 1);
  expect_position(tracker.place(1 + HeadTracker::kTimeout_s), 0.1, -0.2, 0.6);
  expect_position(tracker.place(1 + HeadTracker::kTimeout_s + HeadTracker::kEase_s / 2), 0.05, -0.1, 0.3);
  expect_position(tracker.place(3), 0, 0, 0, 0);
  tracker.receive(datagram(0, 0, 0, 10, -20, 60), 3);
  expect_position(tracker.place(3), 0, 0, 0, 1e-12);
  hold(tracker, datagram(0, 0, 0, 10, -20, 60), 3, 4);
  tracker.recentre(4);
  expect_position(tracker.place(4), 0.1, -0.2, 0.6);
  hold(tracker, datagram(0, 0, 0, 10, 0, 60), 4, 5);
  expect_position(tracker.place(5), 0, 0.2, 0);
}

TEST(HeadTracker, PositionsStayInARoom) {
  HeadTracker tracker;
  hold(tracker, datagram(10, 0, 0, 1e300, -1e6, 5), 0, 1);
  expect_position(tracker.place(1), 20, -20, 0.05);
  EXPECT_NEAR(tracker.look(1).yaw_deg, 10, 1e-3);
}

TEST(HeadTracker, TimesThatRunBackwardsAreTheLastOne) {
  HeadTracker tracker;
  hold(tracker, datagram(30, 0, 0), 10, 11);
  tracker.receive(datagram(50, 0, 0), 3);
  EXPECT_NEAR(tracker.look(4).yaw_deg, 30, 1e-3);
  EXPECT_NEAR(tracker.look(11.4).yaw_deg, 50, 1e-3);
  EXPECT_TRUE(std::isfinite(tracker.look(std::numeric_limits<double>::quiet_NaN()).yaw_deg));
}

RC_GTEST_PROP(HeadTrackerProperty, AnyBytesAreHarmless, (const std::vector<Bytes>& packets)) {
  HeadTracker tracker;
  double time_s = 0;
  for (Bytes packet : packets) {
    if (packet.size() > 20) packet.resize(HeadDatagram::kBytes);
    tracker.receive(packet, time_s += 0.01);
    const mars::HeadAngles look = tracker.look(time_s + 0.003);
    RC_ASSERT(std::abs(look.yaw_deg) <= 180 && std::abs(look.pitch_deg) <= 90 &&
              std::abs(look.roll_deg) <= 180);
  }
  RC_ASSERT(tracker.received() + tracker.ignored() == packets.size());
}

// Checks, for any history of poses, gaps and options, that the look is no faster than smoothing and easing
// allow.
RC_GTEST_PROP(HeadTrackerProperty, TheLookIsContinuous, ()) {
  const HeadTrackerOptions options{.invert_yaw = *rc::gen::arbitrary<bool>(),
                                   .scale = 0.1 * *rc::gen::inRange(5, 30),
                                   .smoothing_s = 0.02 * *rc::gen::inRange(1, 10)};
  HeadTracker tracker(options);
  constexpr double kStep_s = 1e-3;
  // A difference of half a turn followed, and another one eased at its steepest (1.5 / kEase_s).
  const double most_deg = 180 * kStep_s * 2 * (1 / options.smoothing_s + 1.5 / HeadTracker::kEase_s) + 1e-9;
  std::int64_t tick = 0;
  mars::HeadAngles before = tracker.look(0);
  const int count = *rc::gen::inRange(1, 30);
  for (int n = 0; n < count; ++n) {
    const auto angle = [] { return static_cast<double>(*rc::gen::inRange(-180, 181)); };
    const double now_s = kStep_s * static_cast<double>(tick);
    const int what = *rc::gen::inRange(0, 8);
    if (what == 0) {
      tracker.recentre(now_s);
    } else {
      tracker.receive(datagram(angle(), angle() / 2, angle()), now_s);
    }
    const int gap = *rc::gen::element(1, 4, 16, 100, 480, 505, 700, 1200);
    for (int k = 0; k < gap; ++k, ++tick) {
      const mars::HeadAngles now = tracker.look(kStep_s * static_cast<double>(tick));
      RC_ASSERT(apart(now, before) <= most_deg);
      RC_ASSERT(std::abs(now.pitch_deg) <= 90);
      before = now;
    }
  }
}

}  // namespace
}  // namespace vpe::explore
