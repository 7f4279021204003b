// What a planet is made from: sources of elevation and of colour, sampled at directions.
//
// A source is a pure function of the direction (and of the spacing hint): the value at a place does not
// depend on the batch it is asked in, on the thread, or on what was asked before. That is what makes tile
// borders identical. Every const member may be called from any number of threads at once.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "mars/geodesy/datum.h"
#include "vpe/base/rgb.h"

namespace mars {

// A source that cannot be opened or read. what() names the file, the operation, the library's own words and
// what to do.
class SourceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A cap of the sphere: all directions within `radius_rad` of unit `centre`.
struct Cap {
  glm::dvec3 centre{1, 0, 0};
  double radius_rad = 0;
};

// What a planet file records of a source.
struct SourceInfo {
  std::string name;                  // path as given, or the name of a built-in source
  std::int64_t size_bytes = 0;       // 0 for built-in sources
  std::int64_t mtime_s = 0;          // seconds since 1970, 0 for built-in sources
  double resolution_m = 0;           // post spacing at its best place
  double quantum_m = 0;              // step of its values; 0 = floating point
  VerticalDatum datum;               // of the values that the source gives
  double body_radius_m = 0;          // equatorial radius of the body that the product is of; 0 = not said
  std::optional<double> accuracy_m;  // one sigma, vertical, where the product states it
  bool illustration = false;         // true for made-up planets: never to be read as data
  std::string treatment;             // what was done to the product's own values; empty = nothing
};

// Called with directions and the source's own values there (metres); blocks may come in any order.
using PostVisitor =
    std::function<void(std::span<const glm::dvec3> directions, std::span<const double> heights_m)>;

class ElevationSource {
 public:
  virtual ~ElevationSource() = default;

  virtual std::vector<SourceInfo> infos() const = 0;

  // Elevation in metres in the source's vertical datum at unit directions; NaN where the source has none.
  // spacing_m: distance of the posts that the caller will keep. A source may leave out detail that is finer
  // than that, as a function of spacing and place alone. `heights_m` has the size of `directions`.
  // Throws SourceError on a read error.
  virtual void sample(std::span<const glm::dvec3> directions, double spacing_m,
                      std::span<double> heights_m) const = 0;

  // Index into infos() of the source that decides the value at each direction; -1 where none has data.
  virtual void origin(std::span<const glm::dvec3> directions, std::span<int> source_index) const = 0;

  // Finest own post spacing anywhere in the cap, metres; infinity where there is no data. Conservative: may
  // name data that only touches the cap, never misses any.
  virtual double spacing_in(const Cap& cap) const = 0;

  // Calls visit() with a regular subset of the source's own posts, at most about max_posts of them, for the
  // resampling error. Posts that another source overrides or blends are left out.
  virtual void visit_posts(std::size_t max_posts, const PostVisitor& visit) const = 0;
};

class ImageSource {
 public:
  virtual ~ImageSource() = default;

  virtual std::vector<SourceInfo> infos() const = 0;

  // Colour at unit directions, averaged over about texel_m; alpha 0 where there is none, else 255.
  // Sizes are equal. Throws SourceError on a read error.
  virtual void sample(std::span<const glm::dvec3> directions, double texel_m, std::span<vpe::base::Rgb> colours,
                      std::span<std::uint8_t> alpha) const = 0;

  // As ElevationSource::spacing_in, for texels.
  virtual double spacing_in(const Cap& cap) const = 0;
};

// Opens any raster that GDAL reads, in any CRS it can transform, as elevation or image. MEGDR labels of both
// conventions are placed by their own bounds. Throws SourceError.
std::shared_ptr<const ElevationSource> open_elevation(const std::string& path);
std::shared_ptr<const ImageSource> open_image(const std::string& path);

// Name and version of the library that reads rasters, for reports.
std::string raster_library();

struct StackOptions {
  // Width, in posts of the finer source, over which an inset fades into what lies below it at its rim.
  double feather_posts = 16;
  double feather_m = 0;  // > 0: in metres instead
  // At least so many posts of the next coarser source (unless feather_m is given): finer than that it knows nothing
  // of the ground that the inset fades into.
  double feather_base_posts = 0;
  // No fade is wider than kMaxFeather_posts of the inset's posts.
};

// Sources stacked by resolution: at each place the finest one that has data decides, feathered at its rim.
// Ties go to the one given first. Throws SourceError when empty, or when the datums of two sources differ.
std::shared_ptr<const ElevationSource> stack_elevation(
    std::vector<std::shared_ptr<const ElevationSource>> sources, const StackOptions& options = {});
std::shared_ptr<const ImageSource> stack_images(std::vector<std::shared_ptr<const ImageSource>> sources,
                                                const StackOptions& options = {});

}  // namespace mars
