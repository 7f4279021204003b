#include "mars/embedded/embedded.h"

#include <algorithm>

#include "mars/embedded/colour.h"
#include "mars/embedded/math.h"
#include "mars/embedded/surface.h"

namespace mars {

namespace {

using embedded::Block;
using embedded::Surface;

SourceInfo info_of(double resolution_m) {
  SourceInfo info;
  info.name = "embedded Mars (illustration)";
  info.resolution_m = resolution_m;
  info.datum = VerticalDatum::areoid();
  info.body_radius_m = kMarsRadius_m;
  info.illustration = true;
  return info;
}

// Holds the default spacings, or one spacing everywhere if a finest one is given.
class Spacings {
 public:
  Spacings(const EmbeddedSpacings& built, double finest_m) : built_(built), finest_m_(finest_m) {}
  double finest() const { return finest_m_ > 0 ? finest_m_ : built_.demo_m; }
  double in(const Cap& cap) const { return finest_m_ > 0 ? finest_m_ : embedded_spacing_in(cap, built_); }

 private:
  EmbeddedSpacings built_;
  double finest_m_;
};

class EmbeddedElevation final : public ElevationSource {
 public:
  explicit EmbeddedElevation(double finest_m) : spacings_(kEmbeddedPosts, finest_m) {}

  std::vector<SourceInfo> infos() const override { return {info_of(spacings_.finest())}; }

  void sample(std::span<const glm::dvec3> directions, double spacing_m,
              std::span<double> heights_m) const override {
    embedded::evaluate_all(directions, spacing_m, embedded::best_simd(),
                           [heights_m](const Block&, std::span<const std::uint32_t> index, const Surface& s) {
                             for (std::size_t i = 0; i < index.size(); ++i) heights_m[index[i]] = s.height_m[i];
                           });
  }

  void origin(std::span<const glm::dvec3> directions, std::span<int> source_index) const override {
    std::fill_n(source_index.begin(), directions.size(), 0);
  }

  double spacing_in(const Cap& cap) const override { return spacings_.in(cap); }

  // Visits a Fibonacci lattice over the planet, each post with the spacing of its place.
  void visit_posts(std::size_t max_posts, const PostVisitor& visit) const override {
    constexpr double kGolden = 0.61803398874989484820;
    constexpr std::size_t kBatch = 4096;
    const double spacings[] = {kEmbeddedPosts.plain_m, kEmbeddedPosts.landmark_m, kEmbeddedPosts.demo_m};
    std::vector<glm::dvec3> batch[3];
    std::vector<double> heights;
    const auto flush = [&](std::size_t kind) {
      heights.resize(batch[kind].size());
      sample(batch[kind], spacings[kind], heights);
      visit(batch[kind], heights);
      batch[kind].clear();
    };
    for (std::size_t k = 0; k < max_posts; ++k) {
      const double z = 1.0 - (2.0 * static_cast<double>(k) + 1.0) / static_cast<double>(max_posts);
      const double circles = static_cast<double>(k) * kGolden;
      const double part = circles - static_cast<double>(static_cast<std::int64_t>(circles));
      const SinCos lon = embedded::exact_sin_cos_deg(part * 360.0);
      const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
      const glm::dvec3 direction{r * lon.cos, r * lon.sin, z};
      const double wanted = embedded_spacing_in({direction, 0.0}, kEmbeddedPosts);
      const std::size_t kind = wanted == spacings[0] ? 0 : (wanted == spacings[1] ? 1 : 2);
      batch[kind].push_back(direction);
      if (batch[kind].size() == kBatch) flush(kind);
    }
    for (std::size_t kind = 0; kind < 3; ++kind) {
      if (!batch[kind].empty()) flush(kind);
    }
  }

 private:
  Spacings spacings_;
};

class EmbeddedImage final : public ImageSource {
 public:
  explicit EmbeddedImage(double finest_m) : spacings_(kEmbeddedTexels, finest_m) {}

  std::vector<SourceInfo> infos() const override { return {info_of(spacings_.finest())}; }

  void sample(std::span<const glm::dvec3> directions, double texel_m, std::span<vpe::base::Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    std::fill_n(alpha.begin(), directions.size(), std::uint8_t{255});
    embedded::evaluate_all(
        directions, texel_m, embedded::best_simd(),
        [colours](const Block& block, std::span<const std::uint32_t> index, const Surface& s) {
          vpe::base::Rgb rgb[embedded::kBlock];
          embedded::colour(block, s, rgb);
          for (std::size_t i = 0; i < index.size(); ++i) colours[index[i]] = rgb[i];
        });
  }

  double spacing_in(const Cap& cap) const override { return spacings_.in(cap); }

 private:
  Spacings spacings_;
};

}  // namespace

std::shared_ptr<const ElevationSource> embedded_elevation(double finest_m) {
  return std::make_shared<EmbeddedElevation>(finest_m);
}
std::shared_ptr<const ImageSource> embedded_image(double finest_m) {
  return std::make_shared<EmbeddedImage>(finest_m);
}

}  // namespace mars
