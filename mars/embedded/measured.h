// The measured Mars that the program carries: MOLA heights and MDIM 2.1 colours, eight posts a degree (mars/data).
#pragma once

#include <cstdint>
#include <string>

#include "mars/embedded/globe_grid.h"

namespace mars::embedded {

inline constexpr int kMeasuredColumns = 2880;
inline constexpr double kMeasuredPost_deg = 360.0 / kMeasuredColumns;
// Distance of the posts along a meridian.
inline constexpr double kMeasuredPost_m = kMeasuredPost_deg * 3396190.0 * 3.14159265358979323846 / 180.0;

// Holds what the data say about the ground around a place, in grids of 1440 columns. They are smooth over tens of
// kilometres.
struct Character {
  static constexpr int kCoarser = 2;  // posts of the data for a post of these grids, along both axes
  GlobeSpline relief;                 // standard deviation of heights in the octave about 8 km, metres
  GlobeSpline pits;                   // density of pits one post wide (craters); 1 in the southern highlands
  GlobeSpline broad;                  // mean height of 150 km around, metres
  GlobeSpline tone;                   // brightness of the imagery, 0..1
  GlobeSpline white;                  // blue over red of the imagery: 0.4 dust .. 1 ice
};

// Holds the carried data. Loading takes a fraction of a second and some 80 MB.
class MeasuredMars {
 public:
  // Returns the carried data, which the first call loads. Never throws: what cannot be read is left out and named in
  // height_fault() or colour_fault(). Without heights the planet is a sphere, without colours its ground is plain.
  static const MeasuredMars& get();

  // Loads the files from a folder. For tests.
  explicit MeasuredMars(const std::string& height_file, const std::string& colour_file);

  // Returns a number that no other object of the process has.
  std::uint64_t id() const { return id_; }

  bool has_heights() const { return !heights_.empty(); }
  bool has_colours() const { return !red_.empty(); }

  // Return why a file is left out: a sentence, or an empty string where it was read.
  const std::string& height_fault() const { return height_fault_; }
  const std::string& colour_fault() const { return colour_fault_; }

  // Return the functions through the posts: metres above the areoid, and colours 0..255 (which may overshoot).
  const GlobeSpline& heights() const { return heights_; }
  const GlobeSpline& red() const { return red_; }
  const GlobeSpline& green() const { return green_; }
  const GlobeSpline& blue() const { return blue_; }
  const Character& character() const { return character_; }

 private:
  void load_heights(const std::string& path);
  void load_colours(const std::string& path);

  std::uint64_t id_;
  std::string height_fault_, colour_fault_;
  GlobeSpline heights_, red_, green_, blue_;
  Character character_;
};

}  // namespace mars::embedded
