#include "scripts/stats.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "vpe/base/number.h"

namespace scripts {

namespace {

using vpe::core::Certificate;
using vpe::core::FrameStats;

// Calls field(name, value) for every column, in order.
template <class Field>
void visit_columns(std::int64_t frame, double time_s, const FrameStats& stats, const Certificate& certificate,
                   const Field& field) {
  field("frame", frame);
  field("t_s", time_s);
  field("tiles_visited", stats.tiles_visited);
  field("tiles_culled_frustum", stats.tiles_culled_frustum);
  field("tiles_culled_horizon", stats.tiles_culled_horizon);
  field("tiles_culled_occlusion", stats.tiles_culled_occlusion);
  field("tiles_drawn", stats.tiles_drawn);
  field("tiles_missing", stats.tiles_missing);
  field("triangles", stats.triangles);
  field("skirt_triangles", stats.skirt_triangles);
  // A count that depends on earlier frames is unknown for a frame that was not drawn now.
  const auto count = [&](std::string_view name, std::int64_t value) {
    if (value < 0) {
      field(name, std::numeric_limits<double>::quiet_NaN());
    } else {
      field(name, value);
    }
  };
  count("bytes_resident", stats.bytes_resident);
  field("tiles_by_level", stats.tiles_by_level);
  count("pages_wanted", stats.pages_wanted);
  count("pages_loading", stats.pages_loading);
  count("pages_uploaded", stats.pages_uploaded);
  count("pages_evicted", stats.pages_evicted);
  field("select_ms", stats.select_ms);
  field("occlude_ms", stats.occlude_ms);
  field("load_ms", stats.load_ms);
  field("draw_ms", stats.draw_ms);
  field("read_ms", stats.read_ms);
  field("tile_error_m", certificate.geometric_error_m);
  field("tile_error_px", certificate.screen_space_error_px);
  field("shift_bound_px", certificate.shift_bound_px);
  field("tiles_substituted", certificate.tiles_substituted);
}

// Formats values: integers, numbers (with the word for one that is not finite), lists.
struct Format {
  std::string_view not_finite;
  std::string_view open, between, close;

  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(int value) const { return std::to_string(value); }
  std::string operator()(double value) const {
    return std::isfinite(value) ? vpe::base::format_number(value) : std::string(not_finite);
  }
  std::string operator()(const std::vector<int>& values) const {
    std::string text(open);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (i > 0) text += between;
      text += std::to_string(values[i]);
    }
    return text.append(close);
  }
};

constexpr Format kCsv{"", "", ";", ""};
constexpr Format kJson{"null", "[", ",", "]"};

std::string csv_header() {
  std::string line;
  visit_columns(0, 0, {}, {},
                [&](std::string_view name, const auto&) { line.append(line.empty() ? "" : ",").append(name); });
  return line + "\n";
}

bool is_json(const std::filesystem::path& path) {
  if (path.extension() == ".jsonl") return true;
  if (path.extension() == ".csv") return false;
  throw std::runtime_error(path.string() +
                           ": cannot tell the format of the statistics: name it .csv or .jsonl");
}

}  // namespace

StatsWriter::StatsWriter(const std::filesystem::path& path)
    : json_(is_json(path)), file_(path, LineFile::Mode::kWhole) {
  if (!json_) file_.write(csv_header());
}

void StatsWriter::row(std::int64_t frame, double time_s, const FrameStats& stats,
                      const Certificate& certificate) {
  std::string line;
  visit_columns(frame, time_s, stats, certificate, [&](std::string_view name, const auto& value) {
    if (!line.empty()) line += ',';
    if (json_) {
      line.append("\"").append(name).append("\":").append(kJson(value));
    } else {
      line += kCsv(value);
    }
  });
  file_.write(json_ ? "{" + line + "}\n" : line + "\n");
}

}  // namespace scripts
