// One frame of a film: what its image depends on, and what became of it.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "vpe/app/picture/fingerprint.h"
#include "vpe/core/frame.h"

namespace vpe::app {

// The figures of a frame that are the same on every run: all of `--stats` but times and what caches hold.
struct FrameFigures {
  core::FrameStats stats;
  core::Certificate certificate;
};
// Of a frame that was not drawn now: times are NaN, bytes_resident and pages are -1.
nlohmann::json to_json(const FrameFigures& figures);
std::optional<FrameFigures> figures_from(const nlohmann::json& json);

struct FilmFrame {
  enum class State : std::uint8_t { kMissing, kKept, kMade, kFailed };

  std::int64_t index = 0;  // of the flight
  double time_s = 0;
  std::string fingerprint;
  State state = State::kMissing;
  FrameFigures figures;  // once kept or made
  std::string checksum;  // of its file or segment, once kept or made
  std::string trouble;   // why it failed

  bool is_there() const { return state == State::kKept || state == State::kMade; }
};

struct FilmCount {
  std::int64_t made = 0;
  std::int64_t kept = 0;
  std::int64_t failed = 0;
  std::int64_t all = 0;

  std::int64_t there() const { return made + kept; }
};
FilmCount count(std::span<const FilmFrame> frames);

}  // namespace vpe::app
