// Takes the coordinates out of OGR's geometries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mars/sources/source.h"
#include "mars/vector/feature.h"

class OGRGeometry;

namespace mars {

// Describes where in a file a fault is.
struct FeaturePlace {
  std::string path;
  std::string layer;
  std::int64_t number = 0;

  // Returns an error that says "PATH: layer 'LAYER', feature NUMBER: FAULT; ADVICE".
  SourceError error(const std::string& fault, const std::string& advice) const;
};

// Counts what a file may have, see FeatureReadOptions.
struct ReadBudget {
  std::size_t vertices = 0;  // that are left
  std::size_t bytes = 0;     // of texts, that are left
  std::size_t most_vertices = 0;
  std::size_t most_bytes = 0;

  // Take from what is left. Throw SourceError when it is not enough.
  void take_vertices(std::size_t count, const FeaturePlace& place);
  void take_bytes(std::size_t count, const FeaturePlace& place);
};

// Returns the shapes of a geometry in its own coordinates, without heights, empty parts and curves. Throws SourceError
// for coordinates that are not finite, for lines of fewer than 2 vertices and for rings of fewer than 3 places.
std::vector<Shape> shapes_of(const OGRGeometry& geometry, const FeaturePlace& place, ReadBudget& budget);

}  // namespace mars
