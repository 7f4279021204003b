// Files of reliefs and of surfaces, and lines of flights.
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "relief/files/relief_file.h"
#include "relief/files/surface_file.h"
#include "relief/relief.h"
#include "relief/spec_line.h"
#include "tests/fuzz/targets.h"

namespace fuzz {
namespace {

Bytes relief_bytes(char selector, const std::string& text) {
  const std::string all = selector + text;
  return {all.begin(), all.end()};
}

void check_reliefs(const std::vector<relief::ReliefSpec>& specs) {
  require(relief::parse_relief_toml(relief::to_toml(specs), "again.relief.toml") == specs,
          "reliefs survive being written");
  relief::Relief placed;
  try {
    placed = relief::place(specs, mars::kMarsRadius_m, [](const glm::dvec3& d) { return 1000 * d.z; });
  } catch (const std::runtime_error& e) {
    require(std::string_view(e.what()).starts_with("relief "), "messages name the relief");
    return;
  }
  for (const relief::PlacedRelief& one : placed.placed()) {
    const mars::Cap& cap = one.cap();
    const double height_m = placed.height_m(cap.centre, -1);
    require(std::isfinite(height_m), "heights are numbers");
    const relief::Interval bounds_m = placed.bounds_m(cap, {-1, 1});
    require(bounds_m.low <= height_m && height_m <= bounds_m.high, "bounds hold");
    require(placed.spacing_m(cap) > 0, "spacings are above 0");
  }
}

void run_surface_file(std::string_view text) {
  try {
    const relief::SurfaceFile surface = relief::parse_surface_toml(text, "fuzz.surface.toml");
    require(surface.radius_m > 0, "radii are above 0");
    require(surface.maps.size() <= relief::kMostSurfaceMaps, "there are not too many maps");
    require(relief::is_round(surface.base) || surface.area_m.x0_m < surface.area_m.x1_m, "areas are not empty");
  } catch (const std::runtime_error& e) {
    require(std::string_view(e.what()).starts_with("fuzz.surface.toml:"), "messages name the file");
  }
}

// The first byte selects the form.
void run_relief(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()) + 1, bytes.size() - 1);
  const int form = bytes[0] % 3;
  if (form == 2) {
    run_surface_file(text);
    return;
  }
  std::vector<relief::ReliefSpec> specs;
  try {
    if (form == 0) {
      specs = relief::parse_relief_toml(text, "fuzz.relief.toml");
    } else {
      specs = {relief::parse_relief_line(text)};
    }
  } catch (const std::invalid_argument& e) {
    require(form == 1 && !std::string_view(e.what()).empty(), "lines have a reason");
    return;
  } catch (const std::runtime_error& e) {
    require(std::string_view(e.what()).starts_with("fuzz.relief.toml:"), "messages name the file");
    return;
  }
  check_reliefs(specs);
}

std::vector<Bytes> relief_seeds() {
  return {
      relief_bytes(
          0,
          "version = 1\n[[relief]]\nname = \"a\"\nkind = \"crater\"\nlon = 1\nlat = 2\nradius_m = 300\ndepth_m = 50\n"
          "rim_m = 9\nfloor_ratio = 0.2\npeak_m = 4\nejecta_ratio = 4\nstrength = 0.5\n"
          "[[relief]]\nkind = \"ramp\"\nlon = 3\nlat = 2\nazimuth_deg = 30\nlength_m = 80\nwidth_m = 6\nend_m = 9\n"
          "[[relief]]\nkind = \"flood\"\nlon = 1\nlat = 2\nlevel_m = 9\npolygon = [[0, 1], [2, 1], [1.5, 3]]\n"),
      relief_bytes(
          0,
          "version = 1\n[[relief]]\nkind = \"pad\"\nlon = 1\nlat = 2\nlength_m = 30\nwidth_m = 9\nmode = \"min\"\n"
          "[[relief]]\nkind = \"trench\"\nlon = 3\nlat = 90\nlength_m = 8e3\nwidth_m = 6\ndepth_m = 9\nslope_deg = 30\n"
          "[[relief]]\nkind = \"dune\"\nlon = 180\nlat = 2\nheight_m = 9\nform = \"transverse\"\nhorn_m = 3\n"
          "[[relief]]\nkind = \"noise\"\nlon = 1\nlat = 2\nradius_m = 90\namplitude_m = 2\nwavelength_m = 30\nseed = 7\n"),
      relief_bytes(1, "kind=dam lon=10 lat=-4 length=200 height=20 foundation=5 rise=3 spacing=auto"),
      relief_bytes(
          2,
          "version = 1\nreliefs = \"a.relief.toml\"\n[base]\nkind = \"ellipsoid\"\nsemi_axes_m = [13, 11.5, 9e3]\n"
          "[[map]]\nfile = \"a.tif\"\nheights = \"radius\"\nscale = 1e3\nposts = 65\nfill_m = -3\n"
          "[[map]]\nfile = \"b.tif\"\ncompose = \"replace\"\nmask = \"m.tif\"\ninterpolation = \"bilinear\"\n"),
      relief_bytes(
          2,
          "version = 1\n[base]\nkind = \"quadric\"\nsize_m = [9, 8]\nmatrix = [[1, 2, 3], [2, 5, 6], [3, 6, 9]]\n"
          "linear = [0, 0, 1]\nconstant = -4\nanchor_m = [0, 1, 2]\n"),
      relief_bytes(1, "kind=flood lon=1 lat=1 rise=5 falloff=20 polygon=0,0;2,0;2,2.5;0,2"),
  };
}

}  // namespace

const Target kRelief{"relief", run_relief, relief_seeds};

}  // namespace fuzz
