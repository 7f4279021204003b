// The embedded Mars by wavelength: the power of heights from 64 km to 1 m, and how the detail continues that of
// the data.
//
// Power spectral densities are those of straight profiles eastwards and northwards, with Hann's taper, averaged
// over the parallel profiles of a square and gathered into half octaves. Across the square, profiles have the
// square of the taper as weight: both directions weigh ground alike. Squares of a kind of ground are averaged
// in logarithms: a single fresh crater of 15 km would outweigh a flat plain.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <span>
#include <string>
#include <vector>

#include "mars/embedded/embedded.h"
#include "tests/support/support.h"

namespace mars {
namespace {

using test_support::Random;

// Band b is the half octave about wavelengths of 2^(b/2) metres: 0 is 1 m, 20 is 1 km, 33 is 93 km.
constexpr int kBands = 34;
using Spectrum = std::array<double, kBands>;  // power spectral density [m^2 m]; 0: the band is not known

// The data show 15 km and more and lose power towards it; the detail begins with the octave about 8 km.
constexpr int kFirstDetailBand = 20;  // 1 km
constexpr int kLastDetailBand = 25;   // 5.8 km
constexpr int kFirstDataBand = 30;    // 33 km
constexpr int kLastDataBand = 33;     // 93 km
constexpr double kLargestKnee = 3.0;

using Heights = std::vector<double> (*)(const std::vector<glm::dvec3>& directions, double spacing_m);

template <bool kDetail>
std::vector<double> heights(const std::vector<glm::dvec3>& directions, double spacing_m) {
  static const auto source = embedded_elevation({.detail = kDetail});
  std::vector<double> out(directions.size());
  source->sample(directions, spacing_m, out);
  return out;
}

// Heights whose detail is multiplied by a factor.
template <int kPercent>
std::vector<double> scaled_heights(const std::vector<glm::dvec3>& directions, double spacing_m) {
  auto out = heights<true>(directions, spacing_m);
  const auto data = heights<false>(directions, spacing_m);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = data[i] + 0.01 * kPercent * (out[i] - data[i]);
  return out;
}

// Replaces 2^n values by their discrete Fourier transform.
void transform(std::vector<std::complex<double>>& values) {
  const std::size_t n = values.size();
  if (n == 1) return;
  std::vector<std::complex<double>> even, odd;
  for (std::size_t i = 0; i < n; i += 2) {
    even.push_back(values[i]);
    odd.push_back(values[i + 1]);
  }
  transform(even);
  transform(odd);
  for (std::size_t k = 0; k < n / 2; ++k) {
    const auto turned = std::polar(1.0, -2.0 * kPi * static_cast<double>(k) / static_cast<double>(n)) * odd[k];
    values[k] = even[k] + turned;
    values[k + n / 2] = even[k] - turned;
  }
}

double hann(std::size_t i, std::size_t n) {
  const double s = std::sin(kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
  return s * s;
}

// Adds weight times |transform|^2 of a profile, less its mean and slope, to `power`.
void add_profile(std::span<const double> profile, double weight, std::vector<double>& power) {
  const std::size_t n = profile.size();
  const double middle = 0.5 * (static_cast<double>(n) - 1.0);
  double mean = 0.0, slope = 0.0, square = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = static_cast<double>(i) - middle;
    mean += profile[i] / static_cast<double>(n);
    slope += x * profile[i];
    square += x * x;
  }
  std::vector<std::complex<double>> values(n);
  for (std::size_t i = 0; i < n; ++i)
    values[i] = hann(i, n) * (profile[i] - mean - slope / square * (static_cast<double>(i) - middle));
  transform(values);
  for (std::size_t k = 0; k < power.size(); ++k) power[k] += weight * std::norm(values[k]);
}

struct Layout {
  double spacing_m;
  std::size_t posts;  // of a profile
  std::size_t profiles;
};

// Spectrum of parallel profiles about a place, in a square.
Spectrum spectrum_of(const Layout& layout, const glm::dvec3& up, bool north, Heights sample) {
  const LocalFrame f = local_frame(lon_lat(up));
  const glm::dvec3 along = north ? f.north : f.east;
  const glm::dvec3 across = north ? f.east : f.north;
  const double side = static_cast<double>(layout.posts) * layout.spacing_m / kMarsRadius_m;
  const auto place = [side](std::size_t i, std::size_t n) {
    return ((static_cast<double>(i) + 0.5) / static_cast<double>(n) - 0.5) * side;
  };
  std::vector<glm::dvec3> directions;
  for (std::size_t j = 0; j < layout.profiles; ++j) {
    for (std::size_t i = 0; i < layout.posts; ++i)
      directions.push_back(
          glm::normalize(up + place(i, layout.posts) * along + place(j, layout.profiles) * across));
  }
  const auto h = sample(directions, layout.spacing_m);
  // Of wavelengths below four spacings part of the detail is left out.
  std::vector<double> power(layout.posts / 4 + 1);
  double weights = 0.0, taper = 0.0;
  for (std::size_t i = 0; i < layout.posts; ++i) taper += hann(i, layout.posts) * hann(i, layout.posts);
  for (std::size_t j = 0; j < layout.profiles; ++j) {
    const double weight = hann(j, layout.profiles) * hann(j, layout.profiles);
    add_profile(std::span(h).subspan(j * layout.posts, layout.posts), weight, power);
    weights += weight;
  }
  Spectrum sum{}, count{};
  for (std::size_t k = 3; k < power.size(); ++k) {  // the taper mixes the first two with the mean
    const double wavelength_m = static_cast<double>(layout.posts) * layout.spacing_m / static_cast<double>(k);
    const auto band = static_cast<std::size_t>(std::lround(2.0 * std::log2(wavelength_m)));
    if (band >= kBands) continue;
    sum[band] += 2.0 * layout.spacing_m * power[k] / (taper * weights);
    count[band] += 1.0;
  }
  for (std::size_t b = 0; b < kBands; ++b) sum[b] /= std::max(1.0, count[b]);
  return sum;
}

// Returns the geometric mean of spectra of one layout.
Spectrum mean_of(std::span<const Spectrum> spectra) {
  Spectrum mean{};
  for (std::size_t b = 0; b < kBands; ++b) {
    double sum = 0.0;
    if (spectra[0][b] == 0.0) continue;
    for (const Spectrum& s : spectra) sum += std::log(s[b]);
    mean[b] = std::exp(sum / static_cast<double>(spectra.size()));
  }
  return mean;
}

// Fits lines through the logarithms of power over the bands of the detail and of the data.
class Sides {
 public:
  explicit Sides(const Spectrum& power) {
    add(power, kFirstDetailBand, kLastDetailBand, detail_);
    add(power, kFirstDataBand, kLastDataBand, data_);
  }
  // Returns the power of the data over that of the detail, by two parallel lines.
  double step() const {
    const double slope = (detail_.covariance() + data_.covariance()) / (detail_.variance() + data_.variance());
    return std::exp2((data_.y - slope * data_.x) / data_.n - (detail_.y - slope * detail_.x) / detail_.n);
  }
  // Returns the power at a band by one line through all bands of both sides.
  double law(int band) const {
    const Sums all{detail_.n + data_.n, detail_.x + data_.x, detail_.y + data_.y, detail_.xx + data_.xx,
                   detail_.xy + data_.xy};
    const double slope = all.covariance() / all.variance();
    return std::exp2((all.y - slope * all.x) / all.n + slope * band);
  }

 private:
  struct Sums {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    double variance() const { return xx - x * x / n; }
    double covariance() const { return xy - x * y / n; }
  };
  static void add(const Spectrum& power, int first, int last, Sums& to) {
    for (int b = first; b <= last; ++b) {
      const double y = std::log2(power[static_cast<std::size_t>(b)]);
      to.n += 1.0;
      to.x += b;
      to.y += y;
      to.xx += b * b;
      to.xy += b * y;
    }
  }
  Sums detail_, data_;
};

// A knee is a step between the power of the data and that of the detail, or a hollow or a hump between 8 and
// 23 km. The step has lines of its own: one line through both sides tilts, and shows only about its root.
struct Knee {
  double step;          // data over detail
  double hollow, hump;  // least and most power over the line through both sides
  double factor() const { return std::max({step, 1.0 / step, 1.0 / hollow, hump}); }
};

Knee knee_of(const Spectrum& power) {
  const Sides sides(power);
  Knee knee{sides.step(), 1.0, 1.0};
  for (int b = kLastDetailBand + 1; b < kFirstDataBand; ++b) {
    const double departure = power[static_cast<std::size_t>(b)] / sides.law(b);
    knee.hollow = std::min(knee.hollow, departure);
    knee.hump = std::max(knee.hump, departure);
  }
  return knee;
}

// Squares of 262 km, and detail down to wavelengths of 1 km.
constexpr Layout kBroad{256.0, 1024, 32};

struct Kind {
  const char* name;
  std::vector<LonLat> squares;  // their centres
};

const Kind kCanyon{"Coprates", {{-71, -12}, {-68, -12}, {-65, -12}, {-62, -13}}};
const Kind kPlain{"Utopia, Amazonis", {{120, 45}, {110, 40}, {115, 40}, {-155, 25}}};
const Kind kOlympus{"Olympus", {{-131, 17}, {-136, 17}, {-134, 21}, {-134, 15}}};
const Kind kArsia{"Arsia", {{-121, -9}, {-120, -7}, {-119, -10}, {-121, -11}}};
const Kind kNorthCap{"Planum Boreum", {{0, 87}, {90, 87}, {180, 87}, {-90, 87}}};
const Kind kSouthCap{"Planum Australe", {{0, -87}, {90, -87}, {180, -87}, {-90, -87}}};

Spectrum broad_spectrum(const Kind& kind, bool north, Heights sample) {
  std::vector<Spectrum> spectra;
  for (const LonLat& p : kind.squares) spectra.push_back(spectrum_of(kBroad, direction(p), north, sample));
  return mean_of(spectra);
}

std::string text(const Knee& k) {
  return "step " + std::to_string(k.step) + ", hollow " + std::to_string(k.hollow) + ", hump " +
         std::to_string(k.hump);
}

// Expects less power in each octave than in the next longer one, from half octave to half octave.
void expect_fall(const std::string& what, const Spectrum& power, int from, int to) {
  for (int b = from; b - 2 >= to; --b) {
    const double longer = power[static_cast<std::size_t>(b)];
    const double shorter = power[static_cast<std::size_t>(b - 2)];
    EXPECT_LT(shorter, longer) << what << ", " << std::exp2(0.5 * b) << " m";
    EXPECT_GT(shorter, 0.0) << what << ", " << std::exp2(0.5 * b) << " m";
  }
}

// Returns a place in a square of kBroad, as often as its tapers weigh that place.
glm::dvec3 place_in(LonLat p, Random& random) {
  const LocalFrame f = local_frame(p);
  const double side = static_cast<double>(kBroad.posts) * kBroad.spacing_m / kMarsRadius_m;
  const auto offset = [&] {
    for (;;) {
      const double u = random.uniform(0, 1);
      if (random.uniform(0, 1) < std::pow(std::sin(kPi * u), 4)) return (u - 0.5) * side;
    }
  };
  const double east = offset();
  const double north = offset();
  return glm::normalize(f.up + east * f.east + north * f.north);
}

void check_fall(const Kind& kind) {
  Random random(91);
  // Steps between octaves are compared within one layout each, since those of others lie on other ground.
  struct Range {
    Layout layout;
    int from, to;
  };
  for (const Range& r : {Range{{16.0, 256, 16}, 20, 12}, {{2.0, 256, 16}, 14, 6}, {{0.25, 256, 16}, 8, 0}}) {
    std::vector<Spectrum> spectra;
    for (const LonLat& p : kind.squares) {
      for (const bool north : {false, true})
        spectra.push_back(spectrum_of(r.layout, place_in(p, random), north, heights<true>));
    }
    const Spectrum power = mean_of(spectra);
    expect_fall(kind.name, power, r.from, r.to);
  }
}

void check(const Kind& kind) {
  for (const bool north : {false, true}) {
    const Spectrum power = broad_spectrum(kind, north, heights<true>);
    const Knee knee = knee_of(power);
    const std::string what = std::string(kind.name) + (north ? " northwards" : " eastwards");
    ::testing::Test::RecordProperty(what, text(knee));
    EXPECT_LE(knee.factor(), kLargestKnee) << what << ": " << text(knee);
    expect_fall(what, power, 32, kFirstDetailBand);
  }
  check_fall(kind);
}

TEST(EmbeddedSpectrum, CanyonsHaveNoKnee) { check(kCanyon); }
TEST(EmbeddedSpectrum, PlainsHaveNoKnee) { check(kPlain); }
TEST(EmbeddedSpectrum, VolcanoesHaveNoKnee) {
  check(kOlympus);
  check(kArsia);
}
TEST(EmbeddedSpectrum, CapsHaveNoKnee) {
  check(kNorthCap);
  check(kSouthCap);
}

// Detail three times as high, a third as high, and none.
TEST(EmbeddedSpectrum, DetailOfOtherHeightHasAKnee) {
  EXPECT_LT(knee_of(broad_spectrum(kArsia, true, scaled_heights<300>)).step, 1.0 / kLargestKnee);
  EXPECT_GT(knee_of(broad_spectrum(kArsia, true, scaled_heights<33>)).step, kLargestKnee);
  EXPECT_GT(knee_of(broad_spectrum(kArsia, true, heights<false>)).factor(), kLargestKnee);
}

}  // namespace
}  // namespace mars
