#include "mars/embedded/embedded.h"

#include <algorithm>

#include "mars/embedded/colour.h"
#include "mars/embedded/math.h"
#include "mars/embedded/measured.h"
#include "mars/embedded/regions.h"
#include "mars/embedded/surface.h"

namespace mars {

namespace {

using embedded::Block;
using embedded::MeasuredMars;
using embedded::Surface;

// Holds the default spacings, or one spacing everywhere if a finest one is given.
class Spacings {
 public:
  Spacings(const EmbeddedSpacings& built, const EmbeddedOptions& options) : built_(built), options_(options) {}
  double finest() const {
    if (!options_.detail) return embedded::kMeasuredPost_m;
    return options_.finest_m > 0 ? options_.finest_m : built_.demo_m;
  }
  double in(const Cap& cap) const {
    if (!options_.detail) return embedded::kMeasuredPost_m;
    return options_.finest_m > 0 ? options_.finest_m : embedded_spacing_in(cap, built_);
  }

 private:
  EmbeddedSpacings built_;
  EmbeddedOptions options_;
};

SourceInfo measured_info(const char* name, const std::string& fault, bool is_height) {
  SourceInfo info;
  info.name = name;
  info.resolution_m = embedded::kMeasuredPost_m;
  info.datum = VerticalDatum::areoid();
  info.body_radius_m = kMarsRadius_m;
  if (is_height && fault.empty()) info.accuracy_m = kMeasuredAccuracy_m;
  if (!fault.empty()) {
    info.name = std::string("in place of ") + name;
    info.illustration = true;
    info.notes.push_back(fault);
  }
  return info;
}

SourceInfo detail_info(double finest_m, bool is_height) {
  SourceInfo info;
  info.name = kEmbeddedDetail;
  info.resolution_m = finest_m;
  info.datum = VerticalDatum::areoid();
  info.body_radius_m = kMarsRadius_m;
  info.illustration = true;
  if (is_height && MeasuredMars::get().has_heights()) info.accuracy_m = kDetailAccuracy_m;
  return info;
}

// Returns the spacing that sample() uses: that of the data if detail is left out.
double sampled_m(const EmbeddedOptions& options, double spacing_m) {
  return options.detail ? spacing_m : std::max(spacing_m, embedded::kCoarsestRelief_m);
}

class EmbeddedElevation final : public ElevationSource {
 public:
  explicit EmbeddedElevation(const EmbeddedOptions& options)
      : mars_(MeasuredMars::get()), options_(options), spacings_(kEmbeddedPosts, options) {}

  std::vector<SourceInfo> infos() const override {
    const SourceInfo data = measured_info("MOLA, 8 posts a degree (carried)", mars_.height_fault(), true);
    if (!options_.detail) return {data};
    return {data, detail_info(spacings_.finest(), true)};
  }

  void sample(std::span<const glm::dvec3> directions, double spacing_m,
              std::span<double> heights_m) const override {
    embedded::evaluate_all(mars_, directions, sampled_m(options_, spacing_m), embedded::best_simd(),
                           embedded::Wanted::kHeights,
                           [heights_m](const Block&, std::span<const std::uint32_t> index, const Surface& s) {
                             for (std::size_t i = 0; i < index.size(); ++i) heights_m[index[i]] = s.height_m[i];
                           });
  }

  void origin(std::span<const glm::dvec3> directions, std::span<int> source_index) const override {
    std::fill_n(source_index.begin(), directions.size(), options_.detail ? 1 : 0);
  }

  void sample_with_origin(std::span<const glm::dvec3> directions, double spacing_m, std::span<double> heights_m,
                          std::span<int> source_index) const override {
    sample(directions, spacing_m, heights_m);
    const bool has_detail =
        options_.detail && embedded::detail_spacing_m(spacing_m) < embedded::kCoarsestRelief_m;
    std::fill_n(source_index.begin(), directions.size(), has_detail ? 1 : 0);
  }

  double spacing_in(const Cap& cap) const override { return spacings_.in(cap); }

  // Visits posts of the data, in whole rows spread over the planet.
  void visit_posts(std::size_t max_posts, const PostVisitor& visit) const override {
    visit_posts_in(max_posts, {}, visit);
  }

  void visit_posts_in(std::size_t max_posts, const WantedCap& wanted, const PostVisitor& visit) const override {
    if (max_posts == 0) return;
    constexpr int kColumns = embedded::kMeasuredColumns;
    constexpr int kRows = kColumns / 2;
    std::vector<glm::dvec3> batch;
    std::vector<double> heights;
    // Rows near the poles have posts as far apart as those of the equator.
    const double share = std::min(1.0, static_cast<double>(max_posts) / (kColumns * kRows * 0.63));
    const int step = std::max(1, static_cast<int>(std::sqrt(1.0 / std::max(share, 1e-6))));
    for (int row = step / 2; row < kRows; row += step) {
      const double lat_deg = 90.0 - (row + 0.5) * embedded::kMeasuredPost_deg;
      const int apart =
          std::min(kColumns, static_cast<int>(step / embedded::exact_sin_cos_deg(lat_deg).cos + 0.5));
      batch.clear();
      for (int column = 0; column + apart <= kColumns; column += apart) {
        const glm::dvec3 at = embedded::place((column + 0.5) * embedded::kMeasuredPost_deg, lat_deg);
        if (!wanted || wanted({at, 0})) batch.push_back(at);
      }
      heights.resize(batch.size());
      sample(batch, embedded::kMeasuredPost_m, heights);
      visit(batch, heights);
    }
  }

 private:
  const MeasuredMars& mars_;
  EmbeddedOptions options_;
  Spacings spacings_;
};

class EmbeddedImage final : public ImageSource {
 public:
  explicit EmbeddedImage(const EmbeddedOptions& options)
      : mars_(MeasuredMars::get()), options_(options), spacings_(kEmbeddedTexels, options) {}

  std::vector<SourceInfo> infos() const override {
    const SourceInfo data = measured_info("MDIM 2.1, 8 pixels a degree (carried)", mars_.colour_fault(), false);
    if (!options_.detail) return {data};
    return {data, detail_info(spacings_.finest(), false)};
  }

  void sample(std::span<const glm::dvec3> directions, double texel_m, std::span<vpe::base::Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    std::fill_n(alpha.begin(), directions.size(), std::uint8_t{255});
    embedded::evaluate_all(mars_, directions, sampled_m(options_, texel_m), embedded::best_simd(),
                           embedded::Wanted::kColours,
                           [&](const Block& block, std::span<const std::uint32_t> index, const Surface& s) {
                             vpe::base::Rgb rgb[embedded::kBlock];
                             embedded::colour(block, mars_, s, rgb);
                             for (std::size_t i = 0; i < index.size(); ++i) colours[index[i]] = rgb[i];
                           });
  }

  double spacing_in(const Cap& cap) const override { return spacings_.in(cap); }

 private:
  const MeasuredMars& mars_;
  EmbeddedOptions options_;
  Spacings spacings_;
};

}  // namespace

std::shared_ptr<const ElevationSource> embedded_elevation(const EmbeddedOptions& options) {
  return std::make_shared<EmbeddedElevation>(options);
}
std::shared_ptr<const ImageSource> embedded_image(const EmbeddedOptions& options) {
  return std::make_shared<EmbeddedImage>(options);
}

double embedded_spacing_in(const Cap& cap, const EmbeddedSpacings& spacings) {
  switch (embedded_region_in(cap)) {
    case EmbeddedRegion::kDemo: return spacings.demo_m;
    case EmbeddedRegion::kLandmark: return spacings.landmark_m;
    case EmbeddedRegion::kBroad: return spacings.broad_m;
    case EmbeddedRegion::kPlain: break;
  }
  return spacings.plain_m;
}

}  // namespace mars
