// Occlusion culling: finds ground behind nearer ground, by a floating horizon over azimuth around the camera.
//
// Drawn ground has one radius for every direction from the planet's centre. Consider a ray from a camera above
// the ground that passes below the ground at some ground angle from the point under the camera: it has met the
// ground at that angle or before. An occluder segment is an arc along which the ground's radius has a lower
// bound; it blocks every ray that passes below it. For each bin of azimuth the horizon keeps the slope (rise
// over run in the camera's own vertical plane) below which segments block every ray of the bin.
//
// Typical usage, from near to far:
//   horizon.begin(camera);
//   for (tile : front_to_back) {
//     if (horizon.hidden(tile.region)) continue;  // invisible
//     for (const OccluderSegment& segment : segments_of(tile)) horizon.add(segment);
//   }
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "cull/bounding_region.h"

namespace cull {

// A row of pieces along one line of a face's chart, which is a great circle. Piece n runs along u = line from v
// = ends[n] to ends[n + 1] (column), or along v = line from u = ends[n] to ends[n + 1]. The ground's radius is
// at least radius_m[n] there.
struct OccluderSegment {
  mars::Face face = mars::Face::kPlusX;
  bool column = true;
  double line = 0;
  std::span<const double> ends;      // ascending, one more than radii
  std::span<const double> radius_m;  // at most kMostPieces
  static constexpr std::size_t kMostPieces = 64;
};

// Collects occluders and tests regions against them. Use it from one thread at a time. Results depend only on
// the camera, the margin and the segments added.
class TerrainHorizon {
 public:
  // Bins lie evenly along the sides of a square about the vertical, which needs no trigonometry. They are
  // between 0.11 and 0.22 degrees wide. More bins: finer occluders, slower.
  static constexpr int kBinsPerSide = 512;
  static constexpr int kBins = 4 * kBinsPerSide;

  // The least margin, 2 cm at 20 km. It covers the rounding of all computations here for segments and tiles
  // that are more than kNearest_rad of ground angle from the point under the camera; nearer segments are not
  // used, nearer tiles are never hidden.
  static constexpr double kRounding_rad = 1e-6;
  static constexpr double kNearest_rad = 1e-7;

  TerrainHorizon();

  // Removes all segments and sets the camera. A region is hidden only if every ray within margin_rad of a ray
  // to it is blocked; the margin covers occluders and tiles that are drawn off their exact position by that
  // angle. At least kRounding_rad is used. Larger: hides less.
  void begin(const Camera& camera, double margin_rad = 0.0);

  // Adds an occluder. Its ground must be nearer to the camera, along every azimuth, than the regions tested
  // after it.
  void add(const OccluderSegment& occluder);

  // Returns true if every point of the region is behind the segments added so far. Conservative. Always false
  // for a region over or opposite the point under the camera.
  bool hidden(const BoundingRegion& region) const;

  // Returns the number of bins that a rectangle spans; kBins if it is over or opposite the point under the
  // camera.
  double bins_spanned(const mars::ChartRect& rect) const;

  // Returns the slope below which rays with the azimuth of a direction are blocked; -infinity where none are.
  double blocked_slope(const glm::dvec3& direction) const;

 private:
  // Blocks the rays below `slope` in one end of a bin: from the bin's low end to `end`, or from `end` to its
  // high end. Pieces on both sides of a tile's border meet there with equal bits.
  struct BinPart {
    double end;
    double slope;
  };
  static constexpr std::size_t kParts = 4;
  struct BinParts {
    std::array<BinPart, kParts> entry;
    std::uint8_t count = 0;
  };
  struct Span {
    double low, high;  // in bins, 0 <= low < kBins, high >= low
    bool valid;
  };

  double azimuth(const glm::dvec3& p) const;
  Span span(const mars::ChartRect& rect) const;
  void raise(int bin, double slope);
  void add_part(int bin, bool from_low_end, const BinPart& part);

  Camera camera_;
  glm::dvec3 a_{1, 0, 0};
  glm::dvec3 b_{0, 1, 0};
  double margin_rad_ = kRounding_rad;
  std::vector<glm::dvec2> boundary_;  // unit vectors along the bins' low ends
  std::vector<double> slope_;
  std::vector<BinParts> low_;
  std::vector<BinParts> high_;
};

}  // namespace cull
