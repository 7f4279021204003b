// Sources of elevation and colour, sampled at directions. Planets are built from them.
//
// A source is a pure function of the direction (and of the spacing hint): the value at a place does not depend
// on the batch, on the thread, or on earlier calls. Identical tile borders rely on this. Every const member may
// be called from any number of threads at once.
//
// Typical usage:
//   const auto source = stack_elevation({open_elevation("mola.img"), open_elevation("hrsc.tif")});
//   source->sample(directions, spacing_m, heights_m);  // NaN: nodata
#pragma once

#include <cmath>
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
#include "mars/sources/file_stamp.h"
#include "vpe/base/rgb.h"

namespace mars {

// Reports that a source cannot be opened or read. what() names the file, the operation, the library's own words
// and what to do.
class SourceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Describes a cap of the sphere: all directions within `radius_rad` of unit `centre`.
struct Cap {
  glm::dvec3 centre{1, 0, 0};
  double radius_rad = 0;
};

// Holds what a planet file records about a source.
struct SourceInfo {
  std::string name;                  // path as given, or the name of a built-in source
  std::int64_t size_bytes = 0;       // 0 for built-in sources
  std::int64_t mtime_s = 0;          // seconds since 1970, 0 for built-in sources
  std::vector<FileStamp> files;      // its local files when it was opened; not recorded
  std::string content;               // hash of samples of these files; empty: not known, which open_ leaves
  double resolution_m = 0;           // post spacing where it is finest
  double quantum_m = 0;              // step of its values; 0: floating point
  VerticalDatum datum;               // of the values that sample() gives
  double body_radius_m = 0;          // equatorial radius of the product's body; 0: not stated
  std::string body;                  // name of the body that the product states; empty: none
  std::optional<double> accuracy_m;  // one sigma, vertical, if the product states it
  bool is_remote = false;            // read over a network; not recorded
  bool illustration = false;         // true for synthetic planets, which must not be taken for data
  bool has_own_light = false;        // of imagery: a photograph in the light of its own sun, see own_light.h
  std::string treatment;             // changes made to the product's own values; empty: none
  std::vector<std::string> notes;    // sentences for the user about how it is read; not recorded
};

// Receives directions and the source's own values there, in metres. Blocks come in any order.
using PostVisitor =
    std::function<void(std::span<const glm::dvec3> directions, std::span<const double> heights_m)>;

// Returns true if posts in a cap are wanted. Empty: all are.
using WantedCap = std::function<bool(const Cap& cap)>;

class ElevationSource {
 public:
  virtual ~ElevationSource() = default;

  // Returns one info for each raster that the source is made of.
  virtual std::vector<SourceInfo> infos() const = 0;

  // Sets heights_m[i] to the elevation at unit directions, in metres above the source's vertical datum; NaN
  // means nodata. spacing_m is the distance of the posts that the caller will keep: a source may leave out
  // finer detail, as a function of spacing and place alone. Sizes must be equal. Throws SourceError on a read
  // error.
  virtual void sample(std::span<const glm::dvec3> directions, double spacing_m,
                      std::span<double> heights_m) const = 0;

  // Sets source_index[i] to the index into infos() of the source that decides the value at each direction, -1
  // for nodata.
  virtual void origin(std::span<const glm::dvec3> directions, std::span<int> source_index) const = 0;

  // Samples as sample() does, to the bit, and sets source_index[i] to the index into infos() of the source that
  // decides the value at this spacing, -1 for nodata. A source of several rasters overrides it, so that they are
  // sampled once.
  virtual void sample_with_origin(std::span<const glm::dvec3> directions, double spacing_m,
                                  std::span<double> heights_m, std::span<int> source_index) const {
    sample(directions, spacing_m, heights_m);
    for (std::size_t i = 0; i < heights_m.size(); ++i) source_index[i] = std::isfinite(heights_m[i]) ? 0 : -1;
  }

  // Returns the finest post spacing of the source anywhere in the cap, in metres, or infinity if there is no
  // data. Conservative: may count data that only touches the cap, never misses any.
  virtual double spacing_in(const Cap& cap) const = 0;

  // Calls visit() with a regular subset of the source's own posts, at most about max_posts of them. The build
  // measures the resampling error on them. Posts that another source overrides or blends are left out.
  virtual void visit_posts(std::size_t max_posts, const PostVisitor& visit) const = 0;

  // Does the same, but may leave out posts that lie in no wanted cap, so that they need not be read.
  virtual void visit_posts_in(std::size_t max_posts, const WantedCap& /*wanted*/,
                              const PostVisitor& visit) const {
    visit_posts(max_posts, visit);
  }

  // Calls visit() with about max_posts heights spread over the source, for figures about the whole of it, such as
  // its mean. They may be means of neighbouring posts, where those are cheaper to read.
  virtual void visit_means(std::size_t max_posts, const PostVisitor& visit) const {
    visit_posts(max_posts, visit);
  }
};

class ImageSource {
 public:
  virtual ~ImageSource() = default;

  virtual std::vector<SourceInfo> infos() const = 0;

  // Sets the colours at unit directions, averaged over about texel_m. alpha[i] is 0 for nodata, else 255. Sizes
  // must be equal. Throws SourceError on a read error.
  virtual void sample(std::span<const glm::dvec3> directions, double texel_m, std::span<vpe::base::Rgb> colours,
                      std::span<std::uint8_t> alpha) const = 0;

  // Returns the finest texel spacing, see ElevationSource::spacing_in().
  virtual double spacing_in(const Cap& cap) const = 0;
};

// Open any raster that GDAL reads, in any CRS that it can transform, as elevation or image. Labels that GDAL
// misplaces are corrected, see mars/raster/pds_map.h and isis_map.h. Throw SourceError.
std::shared_ptr<const ElevationSource> open_elevation(const std::string& path);
std::shared_ptr<const ImageSource> open_image(const std::string& path);

// Describes the state of a raster's files.
struct RasterState {
  std::string text;        // differs if any of the files was replaced or written to
  bool is_certain = true;  // false: the time of some file is not known, so that a change may not show
};

// Returns name, size and time of all files that open_elevation(path) or open_image(path) reads, with the parts of
// virtual rasters, of theirs, and the archives that files lie in. Throws SourceError.
RasterState raster_state(const std::string& path);

// Returns name and version of the library that reads rasters, for reports.
std::string raster_library();

struct StackOptions {
  // Width of the fade of an inset into the base along its data boundary, in posts of the inset; at most
  // kMaxFeather_posts. Smaller: keeps more of the inset, but steps show; larger: smoother, but replaces more of
  // the inset.
  double feather_posts = 16;
  double feather_m = 0;  // > 0: the width in metres instead
  // Least width in posts of the next coarser source; ignored if feather_m is given. The coarser source shows no
  // ground finer than its posts, so narrower fades leave a step.
  double feather_base_posts = 0;
};

// Stack sources by resolution: at each place the finest one that has data decides, feathered along its data
// boundary. Of sources of equal resolution the one given first decides. Throw SourceError if there are no
// sources, or if the datums of two differ.
std::shared_ptr<const ElevationSource> stack_elevation(
    std::vector<std::shared_ptr<const ElevationSource>> sources, const StackOptions& options = {});
std::shared_ptr<const ImageSource> stack_images(std::vector<std::shared_ptr<const ImageSource>> sources,
                                                const StackOptions& options = {});

}  // namespace mars
