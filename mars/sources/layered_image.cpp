#include "mars/sources/layered_image.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mars/sources/stack_walk.h"

namespace mars {
namespace {

// Gives a source the shares with which a stack shows it.
class FadedImage final : public ImageSource {
 public:
  FadedImage(std::shared_ptr<const ImageSource> source, double feather_posts)
      : source_(std::move(source)),
        boundary_(feather_posts > 0 ? dynamic_cast<const BoundaryAware*>(source_.get()) : nullptr),
        feather_posts_(feather_posts) {}

  std::vector<SourceInfo> infos() const override { return source_->infos(); }
  double spacing_in(const Cap& cap) const override { return source_->spacing_in(cap); }

  void sample(std::span<const glm::dvec3> directions, double texel_m, std::span<vpe::base::Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    source_->sample(directions, texel_m, colours, alpha);
    if (boundary_ == nullptr) return;
    std::vector<glm::dvec3> places;
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < alpha.size(); ++i) {
      if (alpha[i] == 0) continue;
      places.push_back(directions[i]);
      numbers.push_back(i);
    }
    std::vector<double> distances(places.size());
    boundary_->boundary_distance(places, feather_posts_, distances);
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const long share = std::lround(255 * smooth_step(distances[k] / feather_posts_));
      alpha[numbers[k]] = static_cast<std::uint8_t>(std::max(share, 1L));
    }
  }

 private:
  std::shared_ptr<const ImageSource> source_;
  const BoundaryAware* boundary_;
  double feather_posts_;
};

class LayeredStack final : public ImageSource, public LayeredImage {
 public:
  LayeredStack(const std::vector<NamedImage>& images, const StackOptions& options) {
    std::vector<std::shared_ptr<const ImageSource>> sources;
    for (const NamedImage& image : images) sources.push_back(image.source);
    composed_ = sources.size() == 1 ? sources.front() : stack_images(sources, options);
    sources = by_resolution(std::move(sources), options);
    int info = 0;
    for (std::size_t s = 0; s < sources.size(); ++s) {
      const bool is_lowest = s + 1 == sources.size();
      const auto named = std::ranges::find(images, sources[s], &NamedImage::source);
      layers_.push_back(
          {named->name,
           std::make_shared<FadedImage>(sources[s], is_lowest ? 0.0 : feather_posts(sources, s, options)),
           info});
      info += static_cast<int>(sources[s]->infos().size());
    }
    std::ranges::reverse(layers_);
  }

  std::vector<SourceInfo> infos() const override { return composed_->infos(); }
  double spacing_in(const Cap& cap) const override { return composed_->spacing_in(cap); }
  void sample(std::span<const glm::dvec3> directions, double texel_m, std::span<vpe::base::Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    composed_->sample(directions, texel_m, colours, alpha);
  }
  const std::vector<ImageLayerSource>& layers() const override { return layers_; }

 private:
  std::shared_ptr<const ImageSource> composed_;
  std::vector<ImageLayerSource> layers_;
};

}  // namespace

const std::vector<ImageLayerSource>* layers_of(const ImageSource* image) {
  const auto* layered = dynamic_cast<const LayeredImage*>(image);
  return layered == nullptr ? nullptr : &layered->layers();
}

std::shared_ptr<const ImageSource> stack_images_apart(std::vector<NamedImage> images,
                                                      const StackOptions& options) {
  for (std::size_t n = 0; n < images.size(); ++n) {
    if (images[n].name.empty()) throw SourceError("image layers: a name is empty; give each layer a name");
    for (std::size_t k = 0; k < n; ++k) {
      if (images[k].name == images[n].name || images[k].source == images[n].source)
        throw SourceError("image layers: '" + images[n].name +
                          "' stands twice; give each layer a name of its own");
    }
  }
  return std::make_shared<LayeredStack>(images, options);
}

}  // namespace mars
