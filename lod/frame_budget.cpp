#include "lod/frame_budget.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lod {

namespace {

// All constants are in natural logarithms. They were chosen by simulation over slopes, delays, noise and steps
// (docs/design/level-of-detail.md).
constexpr double kNear = 0.4;    // times up to half as long again, or a third less, are noise
constexpr double kPart = 0.35;   // fraction of the error that corrects the load each frame
constexpr double kFar = 0.3;     // moves of the multiplier that determine the slope at once
constexpr double kTells = 0.15;  // moves that contribute to the slope
constexpr double kNoiseVariance = 0.015;
constexpr double kForgetting = 0.02;  // per frame: slopes change from place to place
constexpr double kSwing = 0.5;        // distance from the budget that counts as far above or below it
constexpr double kManySwings = 3;     // more than a step of the load causes
constexpr double kMostSwings = 6;
constexpr double kSwingFrames = 30;    // after which one is forgotten
constexpr double kLeastChange = 0.08;  // of the expected time; smaller changes do not justify other tiles

void check(const FrameBudgetOptions& o) {
  const bool good = std::isfinite(o.budget_ms) && o.budget_ms > 0.0 && std::isfinite(o.max_multiplier) &&
                    o.max_multiplier >= 1.0 && o.min_slope > 0.0 && o.first_slope >= o.min_slope &&
                    o.max_slope >= o.first_slope && std::isfinite(o.max_slope);
  if (!good) throw std::invalid_argument("frame budget: milliseconds, multiplier or slopes out of range");
}

class Estimate {
 public:
  Estimate(const FrameBudgetOptions& options, FrameBudgetState& state, double u, double y)
      : options_(options), s_(state), u_(u), y_(y) {}

  void correct() {
    s_.slope_variance = std::min(1.0, s_.slope_variance + kForgetting);
    s_.swings = std::max(0.0, s_.swings - 1.0 / kSwingFrames);
    const double off = innovation();
    if (std::abs(off) <= kNear) {
      s_.doubting = false;
      turn_or_lift(off, kPart);
    } else if (is_slope(off)) {
      s_.doubting = false;
      turn_or_lift(off, 1.0);
    } else if (s_.doubting && s_.doubted * off > 0.0 && s_.doubted_at == u_) {
      s_.doubting = false;
      turn_or_lift(std::abs(off) < std::abs(s_.doubted) ? off : s_.doubted, 1.0);
    } else {
      s_.doubting = true;
      s_.doubted = off;
      s_.doubted_at = u_;
      return;
    }
    record_side();
  }

 private:
  double innovation() const { return y_ - (s_.log_load - s_.slope * u_); }
  void record_side() {
    if (std::abs(y_) <= kSwing) return;
    const int side = y_ > 0.0 ? 1 : -1;
    if (side == -s_.side) s_.swings = std::min(kMostSwings, s_.swings + 1.0);
    s_.side = side;
  }

  double moved() const { return u_ - s_.anchor; }

  bool is_slope(double off) const {
    if (std::abs(moved()) < kFar) return false;
    const double slope = s_.slope - off / moved();
    return slope >= options_.min_slope && slope <= options_.max_slope;
  }

  // Corrects the line by the fraction `part` of the error.
  void turn_or_lift(double off, double part) {
    if (std::abs(moved()) < kTells) {
      s_.log_load += part * off;
      s_.anchor = u_;
      return;
    }
    // Turns the line about the anchor, as far as the slope is uncertain (a Kalman filter of one number); then
    // lifts it by the rest.
    const double information = moved() * moved() * s_.slope_variance;
    const double gain = information / (information + kNoiseVariance);
    const double slope = std::clamp(s_.slope - gain * off / moved(), options_.min_slope, options_.max_slope);
    s_.log_load += (slope - s_.slope) * s_.anchor;
    s_.slope = slope;
    s_.slope_variance *= 1.0 - gain;
    const double rest = innovation();
    if (part < 1.0) {
      s_.log_load += part * rest;
    } else if (rest * off > 0.0) {
      s_.log_load += std::copysign(std::min(std::abs(rest), std::abs(off)), rest);
    }
    if (part == 1.0 || std::abs(moved()) > kFar) s_.anchor = u_;
  }

  const FrameBudgetOptions& options_;
  FrameBudgetState& s_;
  double u_;
  double y_;
};

}  // namespace

double next_multiplier(const FrameBudgetOptions& options, const FrameTime& measured, FrameBudgetState& state) {
  check(options);
  const bool usable = std::isfinite(measured.ms) && measured.ms > 0.0 && std::isfinite(measured.multiplier) &&
                      measured.multiplier > 0.0;
  if (usable) {
    const double u = std::log(measured.multiplier);
    const double y = std::log(measured.ms / options.budget_ms);
    if (!state.started) {
      state.started = true;
      state.slope = options.first_slope;
      state.log_load = y + state.slope * u;
      state.anchor = u;
    }
    Estimate(options, state, u, y).correct();
    const double now = std::log(state.multiplier);
    double wanted = std::clamp(state.log_load / state.slope, 0.0, std::log(options.max_multiplier));
    if (state.swings >= kManySwings) wanted = std::max(wanted, now);
    const double change = std::abs(wanted - now);
    if (change * state.slope > kLeastChange || wanted == 0.0) state.multiplier = std::exp(wanted);
  }
  state.multiplier = std::clamp(state.multiplier, 1.0, options.max_multiplier);
  return state.multiplier;
}

}  // namespace lod
