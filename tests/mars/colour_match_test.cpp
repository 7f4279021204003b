// Colours of an image that are matched to those of the imagery below it, and images that are kept as layers.
#include "mars/sources/colour_match.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "mars/geodesy/sphere.h"
#include "mars/sources/layered_image.h"
#include "mars/sources/stack.h"
#include "tests/support/support.h"

namespace {

using vpe::base::Rgb;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const glm::dvec3 kCentre = mars::direction({137.4, -4.6});
constexpr double kRadius_rad = 0.01;
constexpr double kPost_m = 100;

// Returns values 60 to 170 of detail from the globe down to some 10 km.
glm::dvec3 ground(const glm::dvec3& d) {
  const auto wave = [&](double frequency, double phase) {
    return std::sin(frequency * d.x + phase) * std::cos(frequency * d.y - phase) *
           std::sin(frequency * d.z + 2 * phase);
  };
  const double all = 0.4 * wave(9, 0.3) + 0.5 * wave(900, 1.1) + 0.4 * wave(2300, 0.7);
  return {115 + 42 * all, 110 + 40 * all * all * all + 20 * all, 105 + 35 * std::abs(all)};
}

// Gives colours of the ground changed by a line for each band, in a cap or everywhere. Knows its boundary.
class LineImage : public mars::ImageSource, public mars::BoundaryAware {
 public:
  LineImage(std::string name, double resolution_m, glm::dvec3 gain, glm::dvec3 offset, double radius_rad)
      : name_(std::move(name)),
        resolution_m_(resolution_m),
        gain_(gain),
        offset_(offset),
        radius_rad_(radius_rad) {}

  std::vector<mars::SourceInfo> infos() const override {
    mars::SourceInfo info;
    info.name = name_;
    info.resolution_m = resolution_m_;
    info.treatment = "made up";
    return {info};
  }
  void sample(std::span<const glm::dvec3> directions, double, std::span<Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    for (std::size_t n = 0; n < directions.size(); ++n) {
      const glm::dvec3 value = ground(directions[n]) * gain_ + offset_;
      const auto byte = [](double v) {
        return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0, 255.0)));
      };
      alpha[n] = distance_rad(directions[n]) >= 0 ? 255 : 0;
      colours[n] = alpha[n] != 0 ? Rgb{byte(value.x), byte(value.y), byte(value.z)} : Rgb{};
    }
  }
  double spacing_in(const mars::Cap& cap) const override {
    return mars::angle_between_rad(cap.centre, kCentre) <= cap.radius_rad + radius_rad_ ? resolution_m_
                                                                                        : kInfinity;
  }
  void boundary_distance(std::span<const glm::dvec3> directions, double limit_posts,
                         std::span<double> posts) const override {
    for (std::size_t n = 0; n < posts.size(); ++n) {
      const double own = distance_rad(directions[n]) * mars::kMarsRadius_m / resolution_m_;
      posts[n] = std::clamp(own, 0.0, limit_posts);
    }
  }

 private:
  double distance_rad(const glm::dvec3& d) const { return radius_rad_ - mars::angle_between_rad(d, kCentre); }

  std::string name_;
  double resolution_m_;
  glm::dvec3 gain_;
  glm::dvec3 offset_;
  double radius_rad_;
};

std::shared_ptr<const LineImage> image(const std::string& name, double resolution_m, glm::dvec3 gain,
                                       glm::dvec3 offset, double radius_rad = kRadius_rad) {
  return std::make_shared<LineImage>(name, resolution_m, gain, offset, radius_rad);
}

// Holds the steps of values over the boundary, of all bands.
struct Steps {
  double largest = 0;
  double mean = 0;
};

Steps steps_at_boundary(const mars::ImageSource& inner, const mars::ImageSource& outer) {
  const mars::LonLat centre = mars::lon_lat(kCentre);
  std::vector<glm::dvec3> places;
  for (int n = 0; n < 2000; ++n) {
    const double azimuth = 2 * mars::kPi * n / 2000;
    const double reach_deg = 0.995 * kRadius_rad / mars::kRadiansPerDegree;
    places.push_back(mars::direction(
        {centre.lon_deg + reach_deg * std::sin(azimuth) / std::cos(centre.lat_deg * mars::kRadiansPerDegree),
         centre.lat_deg + reach_deg * std::cos(azimuth)}));
  }
  std::vector<Rgb> a(places.size());
  std::vector<Rgb> b(places.size());
  std::vector<std::uint8_t> has(places.size());
  inner.sample(places, kPost_m, a, has);
  outer.sample(places, kPost_m, b, has);
  Steps steps;
  for (std::size_t n = 0; n < places.size(); ++n) {
    for (const int difference : {a[n].r - b[n].r, a[n].g - b[n].g, a[n].b - b[n].b}) {
      steps.largest = std::max(steps.largest, static_cast<double>(std::abs(difference)));
      steps.mean += std::abs(difference) / (3.0 * static_cast<double>(places.size()));
    }
  }
  return steps;
}

TEST(ColourMatch, ALinearDifferenceIsRemoved) {
  const auto below = image("below", 400, {1, 1, 1}, {0, 0, 0}, 4);
  const std::vector<std::pair<glm::dvec3, glm::dvec3>> lines{
      {{0.7, 0.8, 1.2}, {30, 10, -20}}, {{1.3, 1.2, 1.1}, {-30, -20, 15}}, {{0.5, 0.5, 0.5}, {100, 90, 80}}};
  for (const auto& [gain, offset] : lines) {
    const auto inset = image("inset", kPost_m, gain, offset);
    EXPECT_GT(steps_at_boundary(*inset, *below).mean, 5);
    const auto match = mars::fit_colour_match(*inset, *below);
    ASSERT_TRUE(match.has_value());
    const auto matched = mars::with_colour_match(inset, *match);
    const Steps steps = steps_at_boundary(*matched, *below);
    EXPECT_LT(steps.mean, 1);
    EXPECT_LE(steps.largest, 2);
    EXPECT_LT(match->difference_after, 1);
    EXPECT_GT(match->difference_before, 5);
    for (std::size_t band = 0; band < 3; ++band)
      EXPECT_NEAR(match->gain[band] * gain[static_cast<int>(band)], 1, 0.03) << band;
  }
}

TEST(ColourMatch, AShiftedImageIsMatchedToo) {
  // Noise of half the contrast that has nothing to do with the ground below.
  class Shifted : public LineImage {
   public:
    using LineImage::LineImage;
    void sample(std::span<const glm::dvec3> directions, double texel_m, std::span<Rgb> colours,
                std::span<std::uint8_t> alpha) const override {
      std::vector<glm::dvec3> moved;
      for (const glm::dvec3& d : directions) moved.push_back(glm::normalize(d + glm::dvec3(3e-4, -2e-4, 1e-4)));
      LineImage::sample(moved, texel_m, colours, alpha);
    }
  };
  const auto below = image("below", 400, {1, 1, 1}, {0, 0, 0}, 4);
  const auto inset = std::make_shared<Shifted>("inset", kPost_m, glm::dvec3(0.7, 0.8, 0.9),
                                               glm::dvec3(30, 10, 5), kRadius_rad);
  const auto match = mars::fit_colour_match(*inset, *below);
  ASSERT_TRUE(match.has_value());
  EXPECT_NEAR(match->gain[0], 1 / 0.7, 0.15);
  EXPECT_NEAR(match->gain[2], 1 / 0.9, 0.15);
}

TEST(ColourMatch, ImagesWithoutCommonGroundHaveNone) {
  const auto inset = image("inset", kPost_m, {1, 1, 1}, {0, 0, 0});
  class Elsewhere : public LineImage {
   public:
    using LineImage::LineImage;
    void sample(std::span<const glm::dvec3> directions, double, std::span<Rgb>,
                std::span<std::uint8_t> alpha) const override {
      std::fill_n(alpha.begin(), directions.size(), std::uint8_t{0});
    }
  };
  const Elsewhere below("below", 400, {1, 1, 1}, {0, 0, 0}, 4);
  EXPECT_FALSE(mars::fit_colour_match(*inset, below).has_value());
}

TEST(ColourMatch, AnImageOfOneValueTakesAnOffset) {
  const auto below = image("below", 400, {1, 1, 1}, {0, 0, 0}, 4);
  const auto flat = image("flat", kPost_m, {0, 0, 0}, {50, 60, 70});
  const auto match = mars::fit_colour_match(*flat, *below);
  ASSERT_TRUE(match.has_value());
  EXPECT_EQ(match->gain, (std::array<double, 3>{1, 1, 1}));
  EXPECT_NEAR(match->offset[0], 115 - 50, 12);
}

TEST(ColourMatch, IsStatedAndKeepsTheBoundary) {
  const auto inset = image("inset", kPost_m, {0.7, 0.8, 1.2}, {30, 10, -20});
  mars::ColourMatch match;
  match.gain = {1.25, 1, 0.5};
  match.offset = {-10.5, 0, 300};
  EXPECT_EQ(mars::to_string(match),
            "colours matched to the imagery below: red 1.25 v - 10.5, green 1 v + 0, blue 0.5 v + 300");
  const auto matched = mars::with_colour_match(inset, match);
  EXPECT_EQ(matched->infos().front().treatment, "made up; " + mars::to_string(match));
  const std::vector<glm::dvec3> places{kCentre, -kCentre};
  std::vector<Rgb> own(2);
  std::vector<Rgb> colours(2);
  std::vector<std::uint8_t> alpha(2);
  inset->sample(places, kPost_m, own, alpha);
  matched->sample(places, kPost_m, colours, alpha);
  EXPECT_EQ(colours[0].r, std::lround(1.25 * own[0].r - 10.5));
  EXPECT_EQ(colours[0].g, own[0].g);
  EXPECT_EQ(colours[0].b, 255);
  EXPECT_EQ(alpha[1], 0);
  EXPECT_EQ(colours[1], Rgb{});
  std::vector<double> distance(2);
  const auto* boundary = dynamic_cast<const mars::BoundaryAware*>(matched.get());
  ASSERT_NE(boundary, nullptr);
  boundary->boundary_distance(places, 16, distance);
  EXPECT_EQ(distance[0], 16);
  EXPECT_EQ(matched->spacing_in({kCentre, 0.1}), kPost_m);
}

TEST(LayeredImage, LayersStandInTheOrderOfTheStackAndFadeAsThere) {
  const auto below = image("below", 400, {1, 1, 1}, {0, 0, 0}, 4);
  const auto inset = image("inset", kPost_m, {0.7, 0.8, 1.2}, {30, 10, -20});
  const auto layered = mars::stack_images_apart({{"fine", inset}, {"wide", below}});
  const auto plain = mars::stack_images({inset, below});
  const auto* layers = mars::layers_of(layered.get());
  ASSERT_NE(layers, nullptr);
  ASSERT_EQ(layers->size(), 2U);
  EXPECT_EQ((*layers)[0].name, "wide");
  EXPECT_EQ((*layers)[1].name, "fine");
  const auto infos = layered->infos();
  for (const mars::ImageLayerSource& layer : *layers)
    EXPECT_EQ(infos.at(static_cast<std::size_t>(layer.info)).name, layer.source->infos().front().name);
  EXPECT_EQ(mars::layers_of(plain.get()), nullptr);
  EXPECT_EQ(mars::layers_of(nullptr), nullptr);

  std::vector<glm::dvec3> places;
  for (int n = 0; n <= 600; ++n)
    places.push_back(glm::normalize(kCentre + glm::dvec3(0, 0, kRadius_rad * (0.7 + n / 1000.0))));
  std::vector<Rgb> composed(places.size());
  std::vector<Rgb> same(places.size());
  std::vector<Rgb> wide(places.size());
  std::vector<Rgb> fine(places.size());
  std::vector<std::uint8_t> alpha(places.size());
  std::vector<std::uint8_t> share(places.size());
  layered->sample(places, kPost_m, composed, alpha);
  plain->sample(places, kPost_m, same, alpha);
  (*layers)[0].source->sample(places, kPost_m, wide, alpha);
  EXPECT_TRUE(std::ranges::all_of(alpha, [](std::uint8_t a) { return a == 255; }));
  (*layers)[1].source->sample(places, kPost_m, fine, share);
  EXPECT_EQ(share.front(), 255);
  EXPECT_EQ(share.back(), 0);
  int faded = 0;
  for (std::size_t n = 0; n < places.size(); ++n) {
    EXPECT_EQ(composed[n], same[n]);
    const double part = share[n] / 255.0;
    faded += share[n] > 0 && share[n] < 255 ? 1 : 0;
    EXPECT_NEAR(composed[n].r, part * fine[n].r + (1 - part) * wide[n].r, 1.1);
  }
  EXPECT_GT(faded, 20);
}

TEST(LayeredImage, WrongNamesAreRefused) {
  const auto below = image("below", 400, {1, 1, 1}, {0, 0, 0}, 4);
  const auto inset = image("inset", kPost_m, {1, 1, 1}, {0, 0, 0});
  EXPECT_THROW(mars::stack_images_apart({{"a", inset}, {"a", below}}), mars::SourceError);
  EXPECT_THROW(mars::stack_images_apart({{"a", inset}, {"b", inset}}), mars::SourceError);
  EXPECT_THROW(mars::stack_images_apart({{"", inset}}), mars::SourceError);
  EXPECT_THROW(mars::stack_images_apart({}), mars::SourceError);
  EXPECT_EQ(mars::layers_of(mars::stack_images_apart({{"a", inset}}).get())->size(), 1U);
}

}  // namespace
