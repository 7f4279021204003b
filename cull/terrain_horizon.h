// What lies behind nearer ground: a floating horizon by azimuth about the camera.
//
// Drawn ground has one radius for every direction from the planet's centre. So a ray from a camera above the
// ground that passes below it anywhere, at some ground angle from the point under the camera, has met it at that
// angle or before. A wall is an arc over which the ground's radius has a lower bound: it blocks every ray that
// passes under it. For each bin of azimuth the horizon keeps the slope (rise over run in the camera's own vertical
// plane) below which walls block every ray of the bin.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "cull/bounding_region.h"

namespace cull {

// Pieces of one line of a face's chart, a great circle: u = line from v = ends[n] to ends[n + 1] (column) or v
// = line from u = ends[n] to ends[n + 1], where the ground's radius is at least radius_m[n].
struct OccluderSegment {
  mars::Face face = mars::Face::kPlusX;
  bool column = true;
  double line = 0;
  std::span<const double> ends;      // ascending, one more than radii
  std::span<const double> radius_m;  // at most kMostPieces
  static constexpr std::size_t kMostPieces = 64;
};

// Thread rule: one at a time. Results depend on the camera, the margin and the walls added alone.
class TerrainHorizon {
 public:
  // Bins lie evenly along the sides of a square about the vertical: no trigonometry, and widths between 0.11
  // and 0.22 degrees.
  static constexpr int kBinsPerSide = 512;
  static constexpr int kBins = 4 * kBinsPerSide;

  // Least margin: 2 cm at 20 km. It holds the rounding of everything here for walls and tiles more than
  // kNearest_rad of ground angle from the point under the camera; nearer ones are not used and not hidden.
  static constexpr double kRounding_rad = 1e-6;
  static constexpr double kNearest_rad = 1e-7;

  TerrainHorizon();

  // Forgets all walls. A shell is hidden only when every ray within margin_rad (at least kRounding_rad is
  // taken) of a ray to it is blocked: for walls or tiles that are drawn that far off their place.
  void begin(const Camera& camera, double margin_rad = 0.0);

  // Walls that belong to ground nearer to the camera, along every azimuth, than the shells tested after it.
  void add(const OccluderSegment& occluder);

  // True when every point of the shell is behind the walls added so far. Conservative. Never for a shell over
  // or opposite the point under the camera.
  bool hidden(const BoundingRegion& region) const;

  // Bins that a rectangle spans; kBins when it is over or opposite the point under the camera.
  double bins_spanned(const mars::ChartRect& rect) const;

  // Slope below which rays with the azimuth of a direction are blocked; -infinity where none are.
  double blocked_slope(const glm::dvec3& direction) const;

 private:
  // Ground rays that are blocked below `slope` in a part of a bin: from the bin's low end to `end`, or from
  // `end` to its high end. Pieces on both sides of a tile's border meet there with equal bits.
  struct Part {
    double end;
    double slope;
  };
  static constexpr std::size_t kParts = 4;
  struct Parts {
    std::array<Part, kParts> entry;
    std::uint8_t count = 0;
  };
  struct Span {
    double low, high;  // in bins, 0 <= low < kBins, high >= low
    bool valid;
  };

  double azimuth(const glm::dvec3& p) const;
  Span span(const mars::ChartRect& rect) const;
  void raise(int bin, double slope);
  void add_part(int bin, bool from_low_end, const Part& part);

  Camera camera_;
  glm::dvec3 a_{1, 0, 0};
  glm::dvec3 b_{0, 1, 0};
  double margin_rad_ = kRounding_rad;
  std::vector<glm::dvec2> boundary_;  // unit vectors along the bins' low ends
  std::vector<double> slope_;
  std::vector<Parts> low_;
  std::vector<Parts> high_;
};

}  // namespace cull
