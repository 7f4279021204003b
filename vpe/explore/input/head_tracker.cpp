#include "vpe/explore/input/head_tracker.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vpe::explore {

namespace {

constexpr std::size_t kPitch = 1;
constexpr std::size_t kAngles = 3;  // yaw, pitch, roll; after them the position
constexpr double kStill_deg = 1e-3;
constexpr double kStill_m = 1e-5;
constexpr double kMetresPerCentimetre = 0.01;

double read_double(std::span<const std::uint8_t> bytes) {
  std::uint64_t bits = 0;
  for (std::size_t n = 8; n-- > 0;) bits = bits << 8U | bytes[n];
  return std::bit_cast<double>(bits);
}

double normalized(double angle_deg) { return std::remainder(angle_deg, 360.0); }

// Yaw and roll are periodic; pitch and the position are not.
bool is_periodic(std::size_t part) { return part < kAngles && part != kPitch; }

double difference(std::size_t part, double to, double from) {
  return is_periodic(part) ? normalized(to - from) : to - from;
}

// Falls smoothly from 1 to 0, with zero slope at both ends.
double fading(double share) {
  const double t = std::clamp(share, 0.0, 1.0);
  return 1.0 - t * t * (3.0 - 2.0 * t);
}

double within(double value, double low, double high, double otherwise) {
  return std::isfinite(value) ? std::clamp(value, low, high) : otherwise;
}

double head_m(double cm) {
  return kMetresPerCentimetre * std::clamp(cm, -HeadDatagram::kMaxPosition_cm, HeadDatagram::kMaxPosition_cm);
}

HeadTrackerOptions checked(HeadTrackerOptions options) {
  using O = HeadTrackerOptions;
  options.scale = within(options.scale, O::kMinScale, O::kMaxScale, O{}.scale);
  options.smoothing_s = within(options.smoothing_s, 0, O::kMaxSmoothing_s, O{}.smoothing_s);
  return options;
}

}  // namespace

std::optional<HeadDatagram> parse_head_datagram(std::span<const std::uint8_t> bytes) {
  if (bytes.size() != HeadDatagram::kBytes) return std::nullopt;
  std::array<double, 6> numbers{};
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    numbers[n] = read_double(bytes.subspan(8 * n, 8));
    if (!std::isfinite(numbers[n])) return std::nullopt;
    if (n >= 3 && std::abs(numbers[n]) > HeadDatagram::kMaxAngle_deg) return std::nullopt;
  }
  return HeadDatagram{numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5]};
}

HeadTracker::HeadTracker(const HeadTrackerOptions& options) : options_(checked(options)) {}

double HeadTracker::not_before(double time_s) const { return time_s > now_s_ ? time_s : now_s_; }

// Clamps scaled angles to 180 degrees, where left and right meet, so that the look does not jump when the head
// rotates farther.
HeadTracker::Motion HeadTracker::target() const {
  const std::array<bool, 3> inverted{options_.invert_yaw, options_.invert_pitch, options_.invert_roll};
  Motion all{};
  for (std::size_t n = 0; n < kAngles; ++n) {
    const double limit = n == kPitch ? 90.0 : 180.0;
    const double rotation = normalized(raw_[n] - centre_[n]) * (inverted[n] ? -1.0 : 1.0);
    all[n] = std::clamp(options_.scale * rotation, -limit, limit);
  }
  for (std::size_t n = kAngles; n < all.size(); ++n) all[n] = raw_[n] - centre_[n];
  return all;
}

HeadTracker::Motion HeadTracker::followed(double time_s) const {
  const double lag = options_.smoothing_s > 0 ? std::exp(-(time_s - *last_s_) / options_.smoothing_s) : 0.0;
  Motion all{};
  for (std::size_t n = 0; n < all.size(); ++n) all[n] = to_[n] - difference(n, to_[n], from_[n]) * lag;
  return all;
}

// Adds the fading rest of an earlier easing to the followed look. After the time-out the last look fades.
HeadTracker::Motion HeadTracker::motion(double time_s) const {
  Motion all{};
  if (!last_s_) return all;
  const double end_s = *last_s_ + kTimeout_s;
  if (time_s > end_s) {
    all = motion(end_s);
    for (double& part : all) part *= fading((time_s - end_s) / kEase_s);
    return all;
  }
  all = followed(time_s);
  const double share = fading((time_s - eased_s_) / kEase_s);
  for (std::size_t n = 0; n < all.size(); ++n) {
    all[n] += left_[n] * share;
    if (n == kPitch) all[n] = std::clamp(all[n], -90.0, 90.0);
    if (is_periodic(n)) all[n] = normalized(all[n]);
  }
  return all;
}

void HeadTracker::ease_from(const Motion& shown, double time_s) {
  to_ = from_ = target();
  for (std::size_t n = 0; n < left_.size(); ++n) left_[n] = difference(n, shown[n], to_[n]);
  eased_s_ = time_s;
}

void HeadTracker::set_options(const HeadTrackerOptions& options, double time_s) {
  now_s_ = not_before(time_s);
  const bool live = is_live(now_s_);
  const Motion shown = motion(now_s_);
  options_ = checked(options);
  if (live) ease_from(shown, now_s_);
}

bool HeadTracker::receive(std::span<const std::uint8_t> bytes, double time_s) {
  const std::optional<HeadDatagram> datagram = parse_head_datagram(bytes);
  if (!datagram) {
    ++ignored_;
    return false;
  }
  ++received_;
  now_s_ = not_before(time_s);
  const bool was_live = is_live(now_s_);
  const Motion shown = motion(now_s_);
  if (was_live) from_ = followed(now_s_);
  last_s_ = now_s_;
  raw_ = {datagram->yaw_deg,      datagram->pitch_deg,    datagram->roll_deg,
          head_m(datagram->x_cm), head_m(datagram->y_cm), head_m(datagram->z_cm)};
  if (was_live) {
    to_ = target();
  } else {
    ease_from(shown, now_s_);
  }
  return true;
}

void HeadTracker::recentre(double time_s) {
  now_s_ = not_before(time_s);
  if (!is_live(now_s_)) return;
  const Motion shown = motion(now_s_);
  centre_ = raw_;
  ease_from(shown, now_s_);
}

mars::HeadAngles HeadTracker::look(double time_s) const { return place(time_s).look; }

HeadPlace HeadTracker::place(double time_s) const {
  const Motion all = motion(not_before(time_s));
  return {{all[3], all[4], all[5]}, {all[0], all[1], all[2]}};
}

bool HeadTracker::is_live(double time_s) const {
  return last_s_ && not_before(time_s) <= *last_s_ + kTimeout_s;
}

bool HeadTracker::is_moving(double time_s) const {
  const double now = not_before(time_s);
  if (!last_s_) return false;
  const Motion shown = motion(now);
  const Motion rest = is_live(now) ? target() : Motion{};
  for (std::size_t n = 0; n < shown.size(); ++n) {
    const double still = n < kAngles ? kStill_deg : kStill_m;
    if (std::abs(difference(n, shown[n], rest[n])) > still) return true;
  }
  return false;
}

}  // namespace vpe::explore
