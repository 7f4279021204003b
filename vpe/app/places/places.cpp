#include "vpe/app/places/places.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "mars/geodesy/place_text.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"

namespace vpe::app {

namespace {

using Fields = std::vector<std::string>;

constexpr std::string_view kBlanks = " \t\r";

std::string trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1));
}

// Splits a line of a table. Returns nullopt if a quote is not closed.
std::optional<Fields> split(std::string_view line, char separator) {
  Fields fields(1);
  bool is_quoted = false;
  bool was_quoted = false;
  for (std::size_t n = 0; n < line.size(); ++n) {
    std::string& field = fields.back();
    if (is_quoted) {
      if (line[n] != '"') {
        field += line[n];
      } else if (n + 1 < line.size() && line[n + 1] == '"') {
        field += line[n++];
      } else {
        is_quoted = false;
        was_quoted = true;
      }
    } else if (line[n] == separator) {
      if (!was_quoted) field = trimmed(field);
      fields.emplace_back();
      was_quoted = false;
    } else if (line[n] == '"' && trimmed(field).empty() && !was_quoted) {
      field.clear();
      is_quoted = true;
    } else if (!was_quoted || kBlanks.find(line[n]) == std::string_view::npos) {
      field += line[n];
    }
  }
  if (is_quoted) return std::nullopt;
  if (!was_quoted) fields.back() = trimmed(fields.back());
  return fields;
}

// Describes the header of a table.
struct Header {
  char separator = ',';
  std::size_t lon = 0;
  std::size_t lat = 0;
  Fields names;
};

std::optional<std::size_t> index_of(std::string_view name, const Fields& fields) {
  const auto found = std::find(fields.begin(), fields.end(), name);
  if (found == fields.end()) return std::nullopt;
  return static_cast<std::size_t>(found - fields.begin());
}

// Returns the header, or nullopt if the line is none. Throws if a header does not name a place's coordinates.
std::optional<Header> read_header(const std::string& line, const std::string& where) {
  constexpr std::array<std::string_view, 6> kLon{"lon", "longitude", "lon_deg", "longitude_deg", "lng", "long"};
  constexpr std::array<std::string_view, 4> kLat{"lat", "latitude", "lat_deg", "latitude_deg"};
  Header header;
  for (const char separator : {'\t', ';', ','}) {
    if (line.find(separator) == std::string::npos) continue;
    header.separator = separator;
    break;
  }
  header.names = split(line, header.separator).value_or(Fields{line});
  Fields lower = header.names;
  for (std::string& name : lower)
    for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const auto columns = [&](std::span<const std::string_view> names) {
    std::vector<std::size_t> found;
    for (std::size_t n = 0; n < lower.size(); ++n)
      if (std::find(names.begin(), names.end(), lower[n]) != names.end()) found.push_back(n);
    return found;
  };
  std::vector<std::size_t> lon = columns(kLon);
  std::vector<std::size_t> lat = columns(kLat);
  if (lon.empty() && lat.empty()) {
    if (const auto x = index_of("x", lower)) lon.push_back(*x);
    if (const auto y = index_of("y", lower)) lat.push_back(*y);
  }
  const bool has_digits = line.find_first_of("0123456789") != std::string::npos;
  if (lon.empty() && lat.empty() && has_digits) return std::nullopt;
  std::string fault;
  if (mars::parse_place(line, fault)) return std::nullopt;  // "lat 4 lon 5" is a place
  if (lon.size() != 1 || lat.size() != 1)
    throw UsageError(where + "'" + line +
                     "': a header must name one longitude and one latitude, as lon,lat or latitude,longitude; "
                     "or leave it out and give places as LON,LAT");
  header.lon = lon.front();
  header.lat = lat.front();
  return header;
}

mars::LonLat place_in(const Fields& fields, const Header& header, const std::string& where) {
  const auto coordinate = [&](std::size_t column, mars::Axis axis) {
    std::string fault;
    const auto degrees = mars::parse_coordinate(fields[column], axis, fault);
    if (!degrees)
      throw UsageError(where + "column " + header.names[column] + ", '" + fields[column] + "': " + fault);
    return *degrees;
  };
  return {coordinate(header.lon, mars::Axis::kLongitude), coordinate(header.lat, mars::Axis::kLatitude)};
}

// Appends the place of a line below a header, with its further cells.
void add_row(const std::string& line, const Header& header, const std::string& where, PlaceTable& table) {
  const auto fields = split(line, header.separator);
  if (!fields) throw UsageError(where + "a quote is not closed");
  if (fields->size() != header.names.size())
    throw UsageError(where + "'" + line + "': " + std::to_string(fields->size()) +
                     " fields, but the header has " + std::to_string(header.names.size()));
  table.places.push_back(place_in(*fields, header, where));
  Fields& cells = table.cells.emplace_back();
  for (std::size_t n = 0; n < fields->size(); ++n)
    if (n != header.lon && n != header.lat) cells.push_back((*fields)[n]);
}

}  // namespace

PlaceTable read_places(std::istream& in, const std::string& name) {
  PlaceTable table;
  std::optional<Header> header;
  std::string line;
  bool is_first = true;
  for (int number = 1; std::getline(in, line); ++number) {
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    if (line.ends_with('\r')) line.pop_back();
    if (trimmed(line).empty() || trimmed(line).front() == '#') continue;
    const std::string where = name + ", line " + std::to_string(number) + ": ";
    if (std::exchange(is_first, false)) {
      header = read_header(line, where);
      if (header) {
        for (std::size_t n = 0; n < header->names.size(); ++n)
          if (n != header->lon && n != header->lat) table.columns.push_back(header->names[n]);
        continue;
      }
    }
    if (header) {
      add_row(line, *header, where, table);
    } else {
      table.places.push_back(parse_place(line, where));
      table.cells.emplace_back();
    }
  }
  return table;
}

}  // namespace vpe::app
