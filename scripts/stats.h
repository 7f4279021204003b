// Statistics of a film: one row for each frame (`--stats F.csv` or `F.jsonl`).
//
// Typical usage:
//   StatsWriter stats("frames.csv");
//   stats.row(frame, time_s, result.stats, result.certificate);
//   stats.close();
#pragma once

#include <cstdint>
#include <filesystem>

#include "scripts/log.h"
#include "vpe/core/certificate.h"
#include "vpe/core/frame.h"

namespace scripts {

// Writes columns (CSV, RFC 4180 with a header) or keys (one JSON object a line): frame, t_s, the fields of
// core::FrameStats, then of the certificate "tile_error_m" (Certificate::geometric_error_m), "tile_error_px"
// (screen_space_error_px), shift_bound_px and tiles_substituted. tiles_by_level is "3;5;0" in CSV and an array
// in JSON. A value that is not finite, and a negative bytes_resident or number of pages (unknown), is an empty
// field or null. Numbers are the same in every locale. The file appears under its name with
// close(). Members throw what LineFile throws.
class StatsWriter {
 public:
  // Selects the format by the extension. Throws std::runtime_error for any other extension.
  explicit StatsWriter(const std::filesystem::path& path);

  void row(std::int64_t frame, double time_s, const vpe::core::FrameStats& stats,
           const vpe::core::Certificate& certificate);

  void close() { file_.close(); }

 private:
  bool json_;
  LineFile file_;
};

}  // namespace scripts
