#include "tests/bench/ray_bench_agreement.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace bench {

namespace {

// Returns the difference relative to b; 0 for sky in both, infinity for a hit in only one.
double difference(double a, double b) {
  if (std::isinf(a) && std::isinf(b)) return 0.0;
  return std::abs(a - b) / (std::isinf(b) ? 1.0 : b);
}

float percentile(std::vector<float>& values, double share) {
  if (values.empty()) return 0.0F;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

Agreement compare(const vpe::core::View& view, std::span<const float> ours_m, std::span<const float> theirs_m,
                  const paging::Surface& surface, std::int64_t max_judged) {
  Agreement a;
  a.pixels = static_cast<std::int64_t>(ours_m.size());
  std::vector<float> differences;
  std::vector<std::size_t> differing;
  for (std::size_t n = 0; n < ours_m.size(); ++n) {
    const bool hit = std::isfinite(ours_m[n]);
    if (hit != std::isfinite(theirs_m[n])) {
      ++a.hit_miss;
      differing.push_back(n);
      continue;
    }
    if (!hit) continue;
    ++a.hits;
    const double d = difference(static_cast<double>(ours_m[n]), static_cast<double>(theirs_m[n]));
    differences.push_back(static_cast<float>(d));
    if (d <= kAgree) continue;
    ++a.far;
    differing.push_back(n);
  }
  a.p50 = static_cast<double>(percentile(differences, 0.5));
  a.p99 = static_cast<double>(percentile(differences, 0.99));
  a.p9999 = static_cast<double>(percentile(differences, 0.9999));

  a.judged = std::min<std::int64_t>(max_judged, static_cast<std::int64_t>(differing.size()));
  for (std::int64_t k = 0; k < a.judged; ++k) {
    const std::size_t n =
        differing[static_cast<std::size_t>(k) * differing.size() / static_cast<std::size_t>(a.judged)];
    const auto width = static_cast<std::size_t>(view.width);
    const double exact_m = surface.cast(
        view.camera.position_m,
        vpe::core::pixel_ray(view, static_cast<double>(n % width) + 0.5, static_cast<double>(n / width) + 0.5));
    const bool ours = difference(static_cast<double>(ours_m[n]), exact_m) <= kAgree;
    const bool theirs = difference(static_cast<double>(theirs_m[n]), exact_m) <= kAgree;
    if (!ours)
      a.ours_wrong.push_back({static_cast<int>(n % width), static_cast<int>(n / width),
                              static_cast<double>(ours_m[n]), static_cast<double>(theirs_m[n]), exact_m});
    ++(ours ? theirs ? a.both_right : a.ours_right : theirs ? a.theirs_right : a.none_right);
  }
  return a;
}

std::string to_text(const Agreement& a) {
  char text[320];
  const auto percent = [&](std::int64_t count) {
    return 100.0 * static_cast<double>(count) / static_cast<double>(std::max<std::int64_t>(1, a.pixels));
  };
  std::snprintf(
      text, sizeof text,
      "%.0f %% hits, hit/miss differs %.4f %%, beyond 1e-4 %.4f %%, p50 %.0e p99 %.0e p99.99 %.0e; of %lld "
      "judged right: ours %lld, Embree %lld, both %lld, none %lld",
      percent(a.hits), percent(a.hit_miss), percent(a.far), a.p50, a.p99, a.p9999,
      static_cast<long long>(a.judged), static_cast<long long>(a.ours_right),
      static_cast<long long>(a.theirs_right), static_cast<long long>(a.both_right),
      static_cast<long long>(a.none_right));
  return text;
}

}  // namespace bench
