#include <cmath>
#include <limits>
#include <memory>

#include "mars/sources/source.h"
#include "mars/sources/stack_walk.h"

namespace mars {
namespace {

class ImageStack final : public ImageSource {
 public:
  ImageStack(std::vector<std::shared_ptr<const ImageSource>> sources, const StackOptions& options)
      : sources_(by_resolution(std::move(sources), options)), options_(options) {}

  std::vector<SourceInfo> infos() const override {
    std::vector<SourceInfo> all;
    for (const auto& source : sources_) {
      for (SourceInfo& info : source->infos()) all.push_back(std::move(info));
    }
    return all;
  }

  void sample(std::span<const glm::dvec3> directions, double texel_m, std::span<vpe::base::Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    struct Mix {
      glm::dvec3 weighted{0};
      double weight = 0;
    };
    std::vector<Mix> mixes(directions.size());
    std::fill(colours.begin(), colours.end(), vpe::base::Rgb{});
    std::fill(alpha.begin(), alpha.end(), std::uint8_t{0});
    std::vector<vpe::base::Rgb> own;
    std::vector<std::uint8_t> own_alpha;
    walk_stack(
        sources_, options_, directions,
        [&](std::size_t s, std::span<const glm::dvec3> places, std::span<char> has) {
          own.resize(places.size());
          own_alpha.resize(places.size());
          sources_[s]->sample(places, texel_m, own, own_alpha);
          for (std::size_t i = 0; i < has.size(); ++i) has[i] = own_alpha[i] != 0 ? 1 : 0;
        },
        [&](std::size_t, std::span<const std::size_t> places, std::span<const char> has,
            std::span<const double> shares) {
          for (std::size_t i = 0; i < places.size(); ++i) {
            if (has[i] == 0) continue;
            const std::size_t at = places[i];
            Mix& mix = mixes[at];
            mix.weighted += glm::dvec3(own[i].r, own[i].g, own[i].b) * shares[i];
            mix.weight += shares[i];
            if (mix.weight > 0) {
              const auto byte = [&](double v) {
                return static_cast<std::uint8_t>(std::lround(v / mix.weight));
              };
              colours[at] = {byte(mix.weighted.x), byte(mix.weighted.y), byte(mix.weighted.z)};
            } else if (alpha[at] == 0) {
              colours[at] = own[i];
            }
            alpha[at] = 255;
          }
        });
  }

  double spacing_in(const Cap& cap) const override {
    double finest = std::numeric_limits<double>::infinity();
    for (const auto& source : sources_) finest = std::min(finest, source->spacing_in(cap));
    return finest;
  }

 private:
  std::vector<std::shared_ptr<const ImageSource>> sources_;
  StackOptions options_;
};

}  // namespace

std::shared_ptr<const ImageSource> stack_images(std::vector<std::shared_ptr<const ImageSource>> sources,
                                                const StackOptions& options) {
  return std::make_shared<ImageStack>(std::move(sources), options);
}

}  // namespace mars
