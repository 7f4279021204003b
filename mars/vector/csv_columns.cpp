#include "mars/vector/csv_columns.h"

#include <ogr_geometry.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <string_view>
#include <utility>

#include "mars/raster/gdal/gdal_scope.h"
#include "vpe/base/number.h"
#include "vpe/base/quote.h"

namespace mars {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kPairs{
    {{"lon", "lat"},
     {"longitude", "latitude"},
     {"lon_deg", "lat_deg"},
     {"center_longitude", "center_latitude"},
     {"long", "lat"},
     {"x", "y"}}};
constexpr std::size_t kMostListed = 20;

bool is_same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, {}, [](unsigned char c) { return std::tolower(c); },
      [](unsigned char c) { return std::tolower(c); });
}

// Returns the number of the column of a name, -1: none.
int column_of(const FeatureLayer& table, std::string_view name) {
  for (std::size_t i = 0; i < table.fields.size(); ++i) {
    if (is_same_name(table.fields[i], name)) return static_cast<int>(i);
  }
  return -1;
}

std::string columns_of(const FeatureLayer& table) {
  std::string text = "its columns are ";
  for (std::size_t i = 0; i < std::min(table.fields.size(), kMostListed); ++i)
    text += (i == 0 ? "" : ", ") + vpe::base::quote_text(table.fields[i]);
  return text + (table.fields.size() > kMostListed ? ", ..." : "");
}

std::string_view text_at(const Feature& row, int column) {
  const auto* text = std::get_if<std::string>(&row.values[static_cast<std::size_t>(column)]);
  return text == nullptr ? std::string_view() : std::string_view(*text);
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

double coordinate(std::string_view text, const std::string& column, const FeaturePlace& place) {
  const auto value = vpe::base::parse_number(text);
  if (value) return *value;
  throw place.error("column " + vpe::base::quote_text(column) + " has " + vpe::base::quote_text(text),
                    "expected degrees, as 137.44");
}

std::vector<Shape> wkt_shapes(std::string_view text, const FeaturePlace& place, ReadBudget& budget) {
  const GdalScope scope;
  const std::string copy(text);
  const char* rest = copy.c_str();
  OGRGeometry* made = nullptr;
  const OGRErr error = OGRGeometryFactory::createFromWkt(&rest, nullptr, &made);
  const std::unique_ptr<OGRGeometry> geometry(made);
  if (error != OGRERR_NONE || !geometry || !trimmed(rest).empty()) {
    throw place.error("column WKT has " + vpe::base::quote_text(text), "expected WKT, as POINT (137.44 -4.59)");
  }
  return shapes_of(*geometry, place, budget);
}

// Returns whether a number gives the text back in its usual form.
bool is_plain_number(std::string_view text) {
  const std::string_view digits = text.starts_with('-') ? text.substr(1) : text;
  if (digits.empty() || digits.front() == '+') return false;
  return digits.front() != '0' || digits.size() == 1 ||
         std::isdigit(static_cast<unsigned char>(digits[1])) == 0;
}

enum class ColumnKind { integer, number, text };

ColumnKind kind_of_column(const FeatureLayer& table, std::size_t column) {
  ColumnKind kind = ColumnKind::integer;
  for (const Feature& row : table.features) {
    const std::string_view text = text_at(row, static_cast<int>(column));
    if (text.empty()) continue;
    if (!is_plain_number(text) || !vpe::base::parse_number(text)) return ColumnKind::text;
    if (!vpe::base::parse_integer(text)) kind = ColumnKind::number;
  }
  return kind;
}

}  // namespace

PlaceColumns find_place_columns(const FeatureLayer& table, const std::string& path,
                                const std::string& lon_column, const std::string& lat_column) {
  if (!lon_column.empty() || !lat_column.empty()) {
    const PlaceColumns named{column_of(table, lon_column), column_of(table, lat_column), -1};
    if (named.lon >= 0 && named.lat >= 0) return named;
    throw source_error(path,
                       "has no column " + vpe::base::quote_text(named.lon < 0 ? lon_column : lat_column) +
                           " of " + (named.lon < 0 ? "longitudes" : "latitudes"),
                       columns_of(table), "name both columns of the places");
  }
  const int wkt = column_of(table, "wkt");
  if (wkt >= 0) return {-1, -1, wkt};
  for (const auto& [lon, lat] : kPairs) {
    const PlaceColumns found{column_of(table, lon), column_of(table, lat), -1};
    if (found.lon >= 0 && found.lat >= 0) return found;
  }
  throw source_error(path, "has no columns of longitude and latitude", columns_of(table),
                     "name the columns lon and lat, or one WKT, in the first line");
}

std::vector<Shape> row_shapes(const Feature& row, const FeatureLayer& table, const PlaceColumns& columns,
                              const FeaturePlace& place, ReadBudget& budget) {
  if (columns.wkt >= 0) {
    const std::string_view text = trimmed(text_at(row, columns.wkt));
    return text.empty() ? std::vector<Shape>() : wkt_shapes(text, place, budget);
  }
  const std::string_view lon = trimmed(text_at(row, columns.lon));
  const std::string_view lat = trimmed(text_at(row, columns.lat));
  if (lon.empty() && lat.empty()) return {};
  budget.take_vertices(1, place);
  return {Shape{ShapeKind::point,
                {{{coordinate(lon, table.fields[static_cast<std::size_t>(columns.lon)], place),
                   coordinate(lat, table.fields[static_cast<std::size_t>(columns.lat)], place)}}}}};
}

void convert_columns(FeatureLayer& table) {
  for (std::size_t column = 0; column < table.fields.size(); ++column) {
    const ColumnKind kind = kind_of_column(table, column);
    for (Feature& row : table.features) {
      FieldValue& value = row.values[column];
      const std::string_view text = text_at(row, static_cast<int>(column));
      if (text.empty()) {
        value = std::monostate();
      } else if (kind == ColumnKind::integer) {
        value = *vpe::base::parse_integer(text);
      } else if (kind == ColumnKind::number) {
        value = *vpe::base::parse_number(text);
      }
    }
  }
}

}  // namespace mars
