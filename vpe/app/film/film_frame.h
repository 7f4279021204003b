// One frame of a film: the inputs of its image as a fingerprint, its state, and its figures.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vpe/core/frame.h"

namespace vpe::app {

// The figures of a frame that are the same on every run: all of `--stats` except times and the state of caches.
struct FrameFigures {
  core::FrameStats stats;
  core::Certificate certificate;
};

nlohmann::json to_json(const FrameFigures& figures);
// Returns figures read from JSON, or nullopt when a key is missing or has another type. What the JSON does not
// hold is marked as unknown: times are NaN, bytes_resident and pages are -1.
std::optional<FrameFigures> figures_from(const nlohmann::json& json);

struct FilmFrame {
  enum class State : std::uint8_t {
    kMissing,  // not drawn yet
    kKept,     // left by an earlier run
    kMade,     // drawn by this run
    kFailed,   // could not be drawn
  };

  std::int64_t index = 0;  // in the flight
  double time_s = 0;
  std::string fingerprint;
  std::vector<std::string> ground;  // what changes the planet's ground, scripts::lines_of()
  State state = State::kMissing;
  FrameFigures figures;  // once kept or made
  std::string checksum;  // of its file or segment, once kept or made
  std::string error;     // why it failed

  bool is_done() const { return state == State::kKept || state == State::kMade; }
};

// Numbers of frames by state.
struct FilmCount {
  std::int64_t made = 0;
  std::int64_t kept = 0;
  std::int64_t failed = 0;
  std::int64_t all = 0;

  std::int64_t done() const { return made + kept; }
};
FilmCount count(std::span<const FilmFrame> frames);

}  // namespace vpe::app
