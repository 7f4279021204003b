#include "mars/raster/placement/ground_grid.h"

#include <cpl_string.h>
#include <gdal_alg.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <utility>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal/gdal_scope.h"
#include "vpe/base/number.h"
#include "vpe/base/quantile.h"

namespace mars {
namespace {

constexpr int kLatticeSide = 21;  // places along a side of the raster that are looked at
constexpr int kRounds = 12;
constexpr double kFound_px = 0.1;        // error of a place on the ground that counts as found
constexpr double kShareOfExtent = 1e-4;  // step of derivatives
constexpr double kLeastCosine = 0.02;
constexpr double kMostSide_px = 1e9;

bool is_place(const glm::dvec2& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

struct Box {
  glm::dvec2 low{std::numeric_limits<double>::infinity()};
  glm::dvec2 high{-std::numeric_limits<double>::infinity()};

  void add(const glm::dvec2& p) {
    if (!is_place(p)) return;
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

Box box_of(std::span<const glm::dvec2> places) {
  Box box;
  for (const glm::dvec2& p : places) box.add(p);
  return box;
}

// The places of a lattice over the raster, and the derivatives of pixels by the ground there.
struct FoundPlaces {
  std::vector<glm::dvec2> places;
  std::vector<glm::dmat2> slopes;
};

// Returns the derivatives of to_pixels() by central differences.
std::vector<glm::dmat2> slopes_at(const PixelMapper& mapper, const std::vector<glm::dvec2>& places,
                                  const glm::dvec2& step) {
  std::vector<glm::dvec2> points;
  for (const glm::dvec2& p : places) {
    points.insert(points.end(), {p - glm::dvec2(step.x, 0), p + glm::dvec2(step.x, 0),
                                 p - glm::dvec2(0, step.y), p + glm::dvec2(0, step.y)});
  }
  mapper.to_pixels(points);
  std::vector<glm::dmat2> slopes;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec2* at = points.data() + 4 * i;
    slopes.emplace_back((at[1] - at[0]) / (2 * step.x), (at[3] - at[2]) / (2 * step.y));
  }
  return slopes;
}

// Finds the places that to_pixels() takes to the lattice, by Newton's method from what to_ground() says.
FoundPlaces find_places(const PixelMapper& mapper, int width, int height) {
  std::vector<glm::dvec2> pixels;
  for (int row = 0; row < kLatticeSide; ++row) {
    for (int column = 0; column < kLatticeSide; ++column)
      pixels.push_back(glm::dvec2(width * double{1} * column, height * double{1} * row) / (kLatticeSide - 1.0));
  }
  std::vector<glm::dvec2> places = pixels;
  mapper.to_ground(places);
  const Box box = box_of(places);
  const glm::dvec2 step = (box.high - box.low) * kShareOfExtent;
  FoundPlaces found;
  if (!(step.x > 0 && step.y > 0)) return found;
  std::vector<double> errors_px(pixels.size(), std::numeric_limits<double>::infinity());
  for (int round = 0; round < kRounds; ++round) {
    std::vector<glm::dvec2> back = places;
    mapper.to_pixels(back);
    const std::vector<glm::dmat2> slopes = slopes_at(mapper, places, step);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const glm::dvec2 off = pixels[i] - back[i];
      errors_px[i] = is_place(off) ? glm::length(off) : std::numeric_limits<double>::infinity();
      const double area = glm::determinant(slopes[i]);
      if (round + 1 < kRounds && std::isfinite(errors_px[i]) && std::isfinite(area) && area != 0)
        places[i] += glm::inverse(slopes[i]) * off;
    }
  }
  const std::vector<glm::dmat2> slopes = slopes_at(mapper, places, step);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double area = glm::determinant(slopes[i]);
    if (!(errors_px[i] <= kFound_px) || !std::isfinite(area) || area == 0) continue;
    found.places.push_back(places[i]);
    found.slopes.push_back(slopes[i]);
  }
  return found;
}

}  // namespace

PixelMapper::PixelMapper(const std::string& path, GDALDataset& dataset,
                         const std::vector<std::string>& options) {
  CPLStringList list;
  for (const std::string& option : options) list.AddString(option.c_str());
  transformer_ = GDALCreateGenImgProjTransformer2(GDALDataset::ToHandle(&dataset), nullptr, list.List());
  if (transformer_ == nullptr) {
    throw source_error(path, "GDAL cannot place it by " + (options.empty() ? "itself" : options.front()),
                       GdalScope::last_message(), "check its control points or RPC with gdalinfo");
  }
}

PixelMapper::~PixelMapper() {
  if (transformer_ != nullptr) GDALDestroyGenImgProjTransformer(transformer_);
}

void PixelMapper::to_pixels(std::vector<glm::dvec2>& points) const { run(true, points); }

void PixelMapper::to_ground(std::vector<glm::dvec2>& points) const { run(false, points); }

void* PixelMapper::release() { return std::exchange(transformer_, nullptr); }

void PixelMapper::run(bool to_pixels, std::vector<glm::dvec2>& points) const {
  std::vector<double> x;
  std::vector<double> y;
  for (const glm::dvec2& p : points) {
    // GDAL's splines and polynomials take any number for a place.
    x.push_back(is_place(p) ? p.x : 0.0);
    y.push_back(is_place(p) ? p.y : 0.0);
  }
  std::vector<double> z(points.size(), 0.0);
  std::vector<int> good(points.size(), 0);
  GDALGenImgProjTransform(transformer_, to_pixels ? TRUE : FALSE, static_cast<int>(points.size()), x.data(),
                          y.data(), z.data(), good.data());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 p(x[i], y[i]);
    points[i] = is_place(points[i]) && good[i] != 0 && is_place(p)
                    ? p
                    : glm::dvec2(std::numeric_limits<double>::quiet_NaN());
  }
}

GroundUnits::GroundUnits(const OGRSpatialReference& crs, std::span<const glm::dvec2> places) {
  if (crs.IsGeographic() == 0) {
    unit_m_ = crs.IsProjected() != 0 ? crs.GetLinearUnits() : 1.0;
    return;
  }
  radians_ = crs.GetAngularUnits();
  unit_m_ = radians_ * crs.GetSemiMajor();
  latitude_ = 1;
  OGRAxisOrientation first = OAO_Other;
  crs.GetAxis(nullptr, crs.GetDataAxisToSRSAxisMapping()[0] - 1, &first);
  if (first == OAO_East) return;
  const double quarter = kPi / 2 / radians_ * (1 + 1e-9);
  const Box box = box_of(places);
  const auto can_be = [&](int i) { return box.low[i] >= -quarter && box.high[i] <= quarter; };
  if (!can_be(1) && can_be(0)) latitude_ = 0;
}

glm::dvec2 GroundUnits::metres(const glm::dvec2& place) const {
  glm::dvec2 metres(unit_m_);
  if (latitude_ >= 0) metres[1 - latitude_] *= std::max(kLeastCosine, std::cos(place[latitude_] * radians_));
  return metres;
}

GroundGrid choose_grid(const std::string& path, const PixelMapper& mapper, int width, int height,
                       const OGRSpatialReference& crs, const std::string& advice) {
  const FoundPlaces found = find_places(mapper, width, height);
  constexpr std::size_t kAll = std::size_t{kLatticeSide} * kLatticeSide;
  if (2 * found.places.size() < kAll) {
    throw source_error(
        path, "most of it has no place on the ground",
        std::to_string(found.places.size()) + " of " + std::to_string(kAll) + " places were found", advice);
  }
  const GroundUnits units(crs, found.places);
  std::vector<double> sizes_m;
  bool is_folded = false;
  for (std::size_t i = 0; i < found.places.size(); ++i) {
    const glm::dvec2 metres = units.metres(found.places[i]);
    const double area = glm::determinant(found.slopes[i]);
    is_folded = is_folded || (area > 0) != (glm::determinant(found.slopes.front()) > 0);
    sizes_m.push_back(std::sqrt(metres.x * metres.y / std::abs(area)));
  }
  if (is_folded)
    throw source_error(path, "its placement is folded: parts of it are mirrored against each other", "",
                       advice);

  GroundGrid grid;
  grid.pixel_m = vpe::base::median_upper(sizes_m);
  const Box box = box_of(found.places);
  const glm::dvec2 step = grid.pixel_m / units.metres((box.low + box.high) / 2.0);
  const glm::dvec2 low = box.low - step;
  const glm::dvec2 high = box.high + step;
  if (units.latitude() >= 0) {
    const double quarter = kPi / 2 / crs.GetAngularUnits();
    if (low[units.latitude()] < -quarter || high[units.latitude()] > quarter) {
      throw source_error(path, "its placement in longitude and latitude reaches beyond a pole", "",
                         "place it in a polar map, e.g. with control points in a stereographic system");
    }
  }
  const glm::dvec2 size = glm::ceil((high - low) / step);
  if (!(size.x <= kMostSide_px && size.y <= kMostSide_px &&
        size.x * size.y <= kMostGrowth * std::max(1e4, double{1} * width * height))) {
    throw source_error(path, "its placement spreads it over too many pixels",
                       vpe::base::format_general(size.x, 4) + " x " + vpe::base::format_general(size.y, 4),
                       advice);
  }
  grid.width = std::max(1, static_cast<int>(size.x));
  grid.height = std::max(1, static_cast<int>(size.y));
  grid.to_ground = {low.x, step.x, 0, high.y, 0, -step.y};
  return grid;
}

}  // namespace mars
