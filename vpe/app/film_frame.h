// One frame of a film: what its picture depends on, and what became of it.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "vpe/core/frame.h"

namespace vpe::app {

// What a frame's picture depends on beside its DrawRequest. The number of threads is not among it.
struct FilmBasis {
  std::string program;  // version
  std::string planet;   // PlanetMeta::identity
  std::string backend;
  int memory_mb = 0;  // bounds triangles and textures
};

// Digest of everything the picture depends on, so that equal fingerprints mean equal pictures; of files that
// the settings name, what they hold. Neither the name of the flight nor the number of the frame counts, and its
// time only where the picture shows it. Throws core::FileError.
std::string fingerprint_of(const FilmBasis& basis, const core::DrawRequest& request,
                           const core::Settings& settings, double time_s = 0);

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
