#include "mars/sources/colour_match.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mars/geodesy/cube.h"
#include "mars/geodesy/sphere.h"
#include "mars/sources/adjusted.h"
#include "mars/sources/stack_walk.h"
#include "vpe/base/number.h"

namespace mars {
namespace {

using vpe::base::Rgb;

constexpr std::size_t kBands = 3;
constexpr int kCellsAlong = 6;      // places of a square along each side
constexpr int kDeepestSquare = 24;  // squares of 0.5 m on Mars
constexpr std::size_t kSquares = 2048;
constexpr std::size_t kFirstSquares = 256;  // that hold the image before its boundary is looked for
constexpr double kLeastSpread = 2;          // of quantiles, in values, below which a band has no gain
constexpr int kDigits = 6;                  // of gains and offsets

// A square of a cube face.
struct Square {
  Face face = Face::kPlusX;
  int level = 0;
  std::int64_t i = 0;
  std::int64_t j = 0;

  glm::dvec3 at(double x, double y) const {
    const auto line = [&](std::int64_t index, double share) {
      return face_line(index, level) * (1 - share) + face_line(index + 1, level) * share;
    };
    return glm::normalize(cube_point(face, line(i, x), line(j, y)));
  }
  Cap cap() const {
    Cap all{at(0.5, 0.5), 0};
    for (const double x : {0.0, 1.0})
      for (const double y : {0.0, 1.0})
        all.radius_rad = std::max(all.radius_rad, angle_between_rad(all.centre, at(x, y)));
    all.radius_rad += 1e-12;
    return all;
  }
};

std::vector<glm::dvec3> places_in(const Square& square) {
  std::vector<glm::dvec3> places;
  for (int y = 0; y < kCellsAlong; ++y)
    for (int x = 0; x < kCellsAlong; ++x)
      places.push_back(square.at((x + 0.5) / kCellsAlong, (y + 0.5) / kCellsAlong));
  return places;
}

std::vector<Square> whole_faces() {
  std::vector<Square> squares;
  for (int face = 0; face < kFaces; ++face) squares.push_back({static_cast<Face>(face), 0, 0, 0});
  return squares;
}

// Divides squares until `count` of them are wanted or more.
template <class Wanted>
std::vector<Square> divided(std::vector<Square> squares, std::size_t count, const Wanted& wanted) {
  for (;;) {
    std::erase_if(squares, [&](const Square& square) { return !wanted(square); });
    if (squares.size() >= count || squares.empty() || squares.front().level >= kDeepestSquare) break;
    std::vector<Square> finer;
    for (const Square& s : squares)
      for (int c = 0; c < 4; ++c) finer.push_back({s.face, s.level + 1, 2 * s.i + c % 2, 2 * s.j + c / 2});
    squares = std::move(finer);
  }
  return squares;
}

struct Pairs {
  std::array<std::vector<double>, kBands> own;
  std::array<std::vector<double>, kBands> below;
  std::int64_t places = 0;
};

void add_bands(const Rgb& own, const Rgb& below, Pairs& pairs) {
  const std::array<std::uint8_t, kBands> a{own.r, own.g, own.b};
  const std::array<std::uint8_t, kBands> b{below.r, below.g, below.b};
  ++pairs.places;
  for (std::size_t band = 0; band < kBands; ++band) {
    if (a[band] == 0 || a[band] == 255 || b[band] == 0 || b[band] == 255) continue;
    pairs.own[band].push_back(a[band]);
    pairs.below[band].push_back(b[band]);
  }
}

// Compares both at places of squares; with a limit only at those nearer to the boundary.
Pairs compare(const ImageSource& image, const ImageSource& below, const std::vector<Square>& squares,
              double texel_m, std::size_t most, std::optional<double> boundary_posts) {
  Pairs pairs;
  const auto* boundary = dynamic_cast<const BoundaryAware*>(&image);
  const std::size_t of_square = std::size_t{kCellsAlong} * kCellsAlong;
  const std::size_t step =
      std::max<std::size_t>(1, squares.size() * of_square / std::max<std::size_t>(most, 1));
  std::vector<Rgb> own(of_square);
  std::vector<Rgb> other(of_square);
  std::vector<std::uint8_t> has(of_square);
  std::vector<std::uint8_t> other_has(of_square);
  std::vector<double> distance(of_square, 0.0);
  for (std::size_t n = 0; n < squares.size(); n += step) {
    const std::vector<glm::dvec3> places = places_in(squares[n]);
    image.sample(places, texel_m, own, has);
    if (std::ranges::all_of(has, [](std::uint8_t a) { return a == 0; })) continue;
    below.sample(places, texel_m, other, other_has);
    if (boundary_posts && boundary != nullptr)
      boundary->boundary_distance(places, *boundary_posts + 1, distance);
    for (std::size_t i = 0; i < of_square; ++i) {
      if (has[i] == 0 || other_has[i] == 0) continue;
      if (boundary_posts && distance[i] > *boundary_posts) continue;
      add_bands(own[i], other[i], pairs);
    }
  }
  return pairs;
}

double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto index = static_cast<std::size_t>(at);
  const double rest = at - static_cast<double>(index);
  return index + 1 < sorted.size() ? sorted[index] * (1 - rest) + sorted[index + 1] * rest : sorted[index];
}

double median_difference(const std::vector<double>& own, const std::vector<double>& below, double gain,
                         double offset) {
  std::vector<double> differences;
  for (std::size_t n = 0; n < own.size(); ++n)
    differences.push_back(std::abs(gain * own[n] + offset - below[n]));
  std::ranges::sort(differences);
  return quantile(differences, 0.5);
}

double with_digits(double value) {
  return vpe::base::parse_number(vpe::base::format_significant(value, kDigits)).value_or(value);
}

// Many values are equal integers, so a quantile is that of values spread evenly over their step.
double spread_quantile(const std::vector<double>& sorted, double share) {
  const double rank = share * static_cast<double>(sorted.size());
  const double value = quantile(sorted, share);
  const double step = std::round(value);
  const auto first = std::lower_bound(sorted.begin(), sorted.end(), step) - sorted.begin();
  const auto last = std::upper_bound(sorted.begin(), sorted.end(), step) - sorted.begin();
  if (last == first) return value;
  const double within = (rank - static_cast<double>(first)) / static_cast<double>(last - first);
  return step - 0.5 + std::clamp(within, 0.0, 1.0);
}

void fit_band(std::vector<double> own, std::vector<double> below, const ColourMatchOptions& options,
              double& gain, double& offset) {
  std::ranges::sort(own);
  std::ranges::sort(below);
  std::vector<std::pair<double, double>> points;
  for (int percent = 10; percent <= 90; percent += 5)
    points.emplace_back(spread_quantile(own, percent / 100.0), spread_quantile(below, percent / 100.0));
  double mean_x = 0;
  double mean_y = 0;
  for (const auto& [x, y] : points) {
    mean_x += x / static_cast<double>(points.size());
    mean_y += y / static_cast<double>(points.size());
  }
  double xx = 0;
  double xy = 0;
  for (const auto& [x, y] : points) {
    xx += (x - mean_x) * (x - mean_x);
    xy += (x - mean_x) * (y - mean_y);
  }
  gain = 1;
  if (points.back().first - points.front().first >= kLeastSpread &&
      points.back().second - points.front().second >= kLeastSpread)
    gain = with_digits(std::clamp(xy / xx, 1 / options.most_gain, options.most_gain));
  offset = with_digits(mean_y - gain * mean_x);
}

using Tables = std::array<std::array<std::uint8_t, 256>, kBands>;

Tables tables_of(const ColourMatch& match) {
  Tables tables{};
  for (std::size_t band = 0; band < kBands; ++band) {
    for (std::size_t value = 0; value < 256; ++value) {
      const double matched = match.gain[band] * static_cast<double>(value) + match.offset[band];
      tables[band][value] = static_cast<std::uint8_t>(std::lround(std::clamp(matched, 0.0, 255.0)));
    }
  }
  return tables;
}

class MatchedImage : public ImageSource {
 public:
  MatchedImage(std::shared_ptr<const ImageSource> source, const ColourMatch& match)
      : source_(std::move(source)), tables_(tables_of(match)), infos_(source_->infos()) {
    for (SourceInfo& info : infos_) info.treatment = add_treatment(info.treatment, to_string(match));
  }

  std::vector<SourceInfo> infos() const override { return infos_; }
  double spacing_in(const Cap& cap) const override { return source_->spacing_in(cap); }
  void sample(std::span<const glm::dvec3> directions, double texel_m, std::span<Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    source_->sample(directions, texel_m, colours, alpha);
    for (std::size_t i = 0; i < colours.size(); ++i) {
      if (alpha[i] == 0) continue;
      colours[i] = {tables_[0][colours[i].r], tables_[1][colours[i].g], tables_[2][colours[i].b]};
    }
  }

 protected:
  std::shared_ptr<const ImageSource> source_;

 private:
  Tables tables_;
  std::vector<SourceInfo> infos_;
};

// The same of a source that knows its boundary.
class MatchedBoundedImage final : public MatchedImage, public BoundaryAware {
 public:
  using MatchedImage::MatchedImage;
  void boundary_distance(std::span<const glm::dvec3> directions, double limit_posts,
                         std::span<double> posts) const override {
    dynamic_cast<const BoundaryAware&>(*source_).boundary_distance(directions, limit_posts, posts);
  }
};

}  // namespace

std::optional<ColourMatch> fit_colour_match(const ImageSource& image, const ImageSource& below,
                                            const ColourMatchOptions& options) {
  const double texel_m = std::max(resolution_m(image), resolution_m(below));
  const auto touches = [&](const Square& square) {
    const Cap cap = square.cap();
    return std::isfinite(image.spacing_in(cap)) && std::isfinite(below.spacing_in(cap));
  };
  // A square at the boundary has places with data and places without.
  const auto is_at_boundary = [&](const Square& square) {
    if (!touches(square)) return false;
    const std::vector<glm::dvec3> places = places_in(square);
    std::vector<Rgb> colours(places.size());
    std::vector<std::uint8_t> alpha(places.size());
    image.sample(places, texel_m, colours, alpha);
    const auto with = std::ranges::count_if(alpha, [](std::uint8_t a) { return a != 0; });
    return with > 0 && with < static_cast<std::ptrdiff_t>(places.size());
  };
  const std::size_t least = options.least_places;
  Pairs pairs;
  if (dynamic_cast<const BoundaryAware*>(&image) != nullptr) {
    const std::vector<Square> squares =
        divided(divided(whole_faces(), kFirstSquares, touches), kSquares, is_at_boundary);
    pairs = compare(image, below, squares, texel_m, options.places, options.boundary_posts);
  }
  const auto is_enough = [&] {
    return std::ranges::all_of(pairs.own, [&](const auto& values) { return values.size() >= least; });
  };
  if (!is_enough())
    pairs =
        compare(image, below, divided(whole_faces(), kSquares, touches), texel_m, options.places, std::nullopt);
  if (!is_enough()) return std::nullopt;
  ColourMatch match;
  match.places = pairs.places;
  for (std::size_t band = 0; band < kBands; ++band) {
    fit_band(pairs.own[band], pairs.below[band], options, match.gain[band], match.offset[band]);
    match.difference_before =
        std::max(match.difference_before, median_difference(pairs.own[band], pairs.below[band], 1, 0));
    match.difference_after =
        std::max(match.difference_after,
                 median_difference(pairs.own[band], pairs.below[band], match.gain[band], match.offset[band]));
  }
  return match;
}

std::shared_ptr<const ImageSource> with_colour_match(std::shared_ptr<const ImageSource> image,
                                                     const ColourMatch& match) {
  if (dynamic_cast<const BoundaryAware*>(image.get()) != nullptr)
    return std::make_shared<MatchedBoundedImage>(std::move(image), match);
  return std::make_shared<MatchedImage>(std::move(image), match);
}

// Planet files store this text: it must not change.
std::string to_string(const ColourMatch& match) {
  constexpr std::array<const char*, kBands> kNames{"red", "green", "blue"};
  std::string text = "colours matched to the imagery below: ";
  for (std::size_t band = 0; band < kBands; ++band) {
    const double offset = match.offset[band];
    text += std::string(band > 0 ? ", " : "") + kNames[band] + " " +
            vpe::base::format_significant(match.gain[band], kDigits) + " v " + (offset < 0 ? "- " : "+ ") +
            vpe::base::format_significant(std::abs(offset), kDigits);
  }
  return text;
}

}  // namespace mars
