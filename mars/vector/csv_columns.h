// Places and numbers in columns of text.
#pragma once

#include <string>

#include "mars/vector/feature.h"
#include "mars/vector/shape_reader.h"

namespace mars {

// Holds which columns of a table hold places.
struct PlaceColumns {
  int lon = -1;
  int lat = -1;
  int wkt = -1;  // -1: lon and lat hold them
};

// Finds the columns of the places of a table, by the names that the user gives or else by those of read_features().
// Throws SourceError, which lists the columns, if there are none or if several fit.
PlaceColumns find_place_columns(const FeatureLayer& table, const std::string& path,
                                const std::string& lon_column, const std::string& lat_column);

// Returns the shapes of a row, in the coordinates of the file; none if its cells of the place are empty. Throws
// SourceError for texts that are no numbers or no WKT.
std::vector<Shape> row_shapes(const Feature& row, const FeatureLayer& table, const PlaceColumns& columns,
                              const FeaturePlace& place, ReadBudget& budget);

// Turns the texts of each column into integers, or else numbers, if all texts of the column are such; empty texts
// become none. A text such as 007 or +5 is no number, because a number would not give it back.
void convert_columns(FeatureLayer& table);

}  // namespace mars
