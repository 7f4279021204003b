#include "vpe/core/appearance/gazetteer.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "mars/geodesy/sphere.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"

namespace vpe::core {

namespace {

constexpr std::uintmax_t kMaxBytes = std::uintmax_t{1} << 28;
constexpr double kMaxDiameter_km = 1e5;

std::string shown_text(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string shown = "\"";
  for (const char c : text.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    shown += byte >= 0x20 && byte < 0x7f ? c : '?';
  }
  return shown + (text.size() > kLongest ? "...\"" : "\"");
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& file) : text_(text), file_(file) {
    if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
  }

  // Reads the next record that is not empty. Returns false at the end.
  bool next(std::vector<std::string>& fields) {
    while (at_ < text_.size()) {
      record_line_ = line_;
      fields.clear();
      while (field(fields)) {
      }
      if (fields.size() > 1 || !fields[0].empty()) return true;
    }
    return false;
  }

  [[noreturn]] void fail(const std::string& expected) const {
    throw std::runtime_error(file_ + ":" + std::to_string(record_line_) + ": expected " + expected);
  }

 private:
  // Reads one field and its separator. Returns true if that was a comma.
  bool field(std::vector<std::string>& fields) {
    std::string& value = fields.emplace_back();
    if (peek() == '"') {
      ++at_;
      for (;; ++at_) {
        if (at_ >= text_.size()) fail("a closing quote, found the end of the file");
        if (text_[at_] == '\n') ++line_;
        if (text_[at_] == '"') {
          ++at_;
          if (peek() != '"') break;
        }
        value += text_[at_];
      }
      if (peek() != ',' && peek() != '\n' && peek() != '\r' && at_ < text_.size()) {
        fail("a comma or the end of the line after a closing quote, found " + shown_text(text_.substr(at_, 8)));
      }
    } else {
      while (at_ < text_.size() && text_[at_] != ',' && text_[at_] != '\n') value += text_[at_++];
      if (peek() != ',' && value.ends_with('\r')) value.pop_back();
    }
    if (peek() == '\r') ++at_;
    const bool more = peek() == ',';
    if (peek() == '\n') ++line_;
    if (at_ < text_.size()) ++at_;
    return more;
  }

  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1;
  int record_line_ = 1;
};

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

std::string lower(std::string_view text) {
  std::string out(trimmed(text));
  for (char& c : out) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return out;
}

using Column = std::optional<std::size_t>;

Column find_column(const std::vector<std::string>& head, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    const auto found = std::find_if(head.begin(), head.end(), [&](const auto& h) { return lower(h) == name; });
    if (found != head.end()) return static_cast<std::size_t>(found - head.begin());
  }
  return std::nullopt;
}

struct Columns {
  std::size_t name, lon, lat;
  Column diameter, system;
};

Columns find_columns(const Reader& reader, const std::vector<std::string>& head) {
  const auto need = [&](const char* what, std::initializer_list<std::string_view> names) {
    const Column column = find_column(head, names);
    if (column) return *column;
    std::string found;
    for (const std::string& h : head) found += (found.empty() ? "" : ",") + h;
    reader.fail(std::string("a first line that names the columns name, lon and lat (or Feature_Name, "
                            "Center_Longitude, Center_Latitude); there is no column for ") +
                what + " in " + shown_text(found));
  };
  Columns columns{};
  columns.name = need("the name", {"name", "feature_name", "clean_feature_name"});
  columns.lon = need("the longitude", {"lon", "longitude", "center_longitude"});
  columns.lat = need("the latitude", {"lat", "latitude", "center_latitude"});
  columns.diameter = find_column(head, {"diameter_km", "diameter"});
  columns.system = find_column(head, {"coordinate_system"});
  return columns;
}

Place place_of(const Reader& reader, const Columns& columns, const std::vector<std::string>& fields) {
  const auto field = [&](std::size_t n) { return n < fields.size() ? trimmed(fields[n]) : std::string_view(); };
  const auto number = [&](std::size_t n, const char* what, double min, double max) {
    const std::optional<double> value = base::parse_number(field(n));
    if (value && *value >= min && *value <= max) return *value;
    reader.fail(std::string(what) + " from " + base::format_number(min) + " to " + base::format_number(max) +
                ", found " + shown_text(field(n)));
  };
  Place place;
  place.name = field(columns.name);
  if (place.name.empty()) reader.fail("a name, found none");
  place.lon_deg = number(columns.lon, "a longitude in degrees", -360, 360);
  place.lat_deg = number(columns.lat, "a latitude in degrees", -90, 90);
  if (columns.diameter && !field(*columns.diameter).empty()) {
    place.diameter_m = 1000 * number(*columns.diameter, "a diameter in kilometres", 0, kMaxDiameter_km);
  }
  if (columns.system && lower(field(*columns.system)).find("+west") != std::string::npos) {
    place.lon_deg = -place.lon_deg;
  }
  return place;
}

}  // namespace

std::vector<glm::dvec3> points_within(const Place& place, double planet_radius_m) {
  constexpr int kPoints = 16;
  constexpr double kMost_rad = 0.5;
  const double radius_rad = 0.5 * place.diameter_m / planet_radius_m;
  std::vector<glm::dvec3> points;
  if (!(radius_rad > 0) || radius_rad > kMost_rad) return points;
  const mars::LocalFrame frame = mars::local_frame({place.lon_deg, place.lat_deg});
  for (const double share : {0.25, 0.5, 0.75, 0.95}) {
    const double away_rad = share * radius_rad;
    for (int n = 0; n < kPoints; ++n) {
      const mars::SinCos azimuth = mars::sin_cos_deg(360.0 / kPoints * n);
      points.push_back(std::cos(away_rad) * frame.up +
                       std::sin(away_rad) * (azimuth.cos * frame.north + azimuth.sin * frame.east));
    }
  }
  return points;
}

std::vector<Place> parse_gazetteer(std::string_view text, const std::string& file) {
  Reader reader(text, file);
  std::vector<std::string> fields;
  if (!reader.next(fields))
    reader.fail("a first line that names the columns name, lon and lat, found an empty file");
  const Columns columns = find_columns(reader, fields);
  std::vector<Place> places;
  while (reader.next(fields)) places.push_back(place_of(reader, columns, fields));
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.diameter_m > b.diameter_m; });
  return places;
}

std::vector<Place> read_gazetteer(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = base::read_file(path, kMaxBytes);
  return parse_gazetteer({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.string());
}

std::string gazetteer_problem(const std::string& path) {
  if (path.empty()) return {};
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return "it is a folder";
  return ::access(path.c_str(), R_OK) == 0 ? "" : std::string("it cannot be read: ") + std::strerror(errno);
}

}  // namespace vpe::core
