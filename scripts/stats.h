// One row of figures a frame (`--stats F.csv` or `F.jsonl`).
#pragma once

#include <cstdint>
#include <filesystem>

#include "scripts/log.h"
#include "vpe/core/certificate.h"
#include "vpe/core/frame.h"

namespace scripts {

// Columns (CSV, RFC 4180 with a header) or keys (one JSON object a line): frame, t_s, the fields of
// core::FrameStats, then geometric_error_m, screen_space_error_px, shift_bound_px and tiles_substituted of the certificate.
// tiles_by_level is "3;5;0" in CSV and an array in JSON. What is not finite, and a negative bytes_resident or
// number of pages (not known), is an empty field or null.
// Numbers are the same in every locale. Rows are flushed; errors as LineFile.
class StatsWriter {
 public:
  // The format follows the extension; throws std::runtime_error for another one.
  explicit StatsWriter(const std::filesystem::path& path);

  void row(std::int64_t frame, double time_s, const vpe::core::FrameStats& stats,
           const vpe::core::Certificate& certificate);

  void close() { file_.close(); }

 private:
  bool json_;
  LineFile file_;
};

}  // namespace scripts
