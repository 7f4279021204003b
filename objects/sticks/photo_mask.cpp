#include "objects/sticks/photo_mask.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

#include "vpe/base/file.h"

namespace objects {

namespace {

constexpr double kMostContourPlace_px = 1e6;
constexpr std::string_view kContourAdvice = "write a point 'x,y' in pixels on each line";

std::string_view without_spaces(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

bool read_place(std::string_view text, double& place_px) {
  text = without_spaces(text);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), place_px);
  return error == std::errc() && end == text.data() + text.size() && std::abs(place_px) <= kMostContourPlace_px;
}

}  // namespace

PhotoMask mask_by_background(const vpe::core::RgbImage& image, const vpe::base::Rgb& colour, int tolerance) {
  PhotoMask mask{image.width, image.height, std::vector<std::uint8_t>(image.pixels.size(), 1)};
  const auto is_near = [&](std::uint8_t a, std::uint8_t b) { return std::abs(int{a} - int{b}) <= tolerance; };
  std::vector<std::size_t> front;
  const auto enter = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
    const std::size_t at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
    const vpe::base::Rgb& p = image.pixels[at];
    if (mask.shows[at] == 0 || !is_near(p.r, colour.r) || !is_near(p.g, colour.g) || !is_near(p.b, colour.b))
      return;
    mask.shows[at] = 0;
    front.push_back(at);
  };
  const auto spread = [&] {
    while (!front.empty()) {
      const auto at = static_cast<std::int64_t>(front.back());
      front.pop_back();
      const int x = static_cast<int>(at % image.width);
      const int y = static_cast<int>(at / image.width);
      enter(x - 1, y);
      enter(x + 1, y);
      enter(x, y - 1);
      enter(x, y + 1);
    }
  };
  for (int x = 0; x < image.width; ++x) {
    enter(x, 0);
    enter(x, image.height - 1);
    spread();
  }
  for (int y = 0; y < image.height; ++y) {
    enter(0, y);
    enter(image.width - 1, y);
    spread();
  }
  return mask;
}

PhotoMask mask_by_contour(const std::vector<glm::dvec2>& points, int width, int height) {
  if (width <= 0 || height <= 0 || width > vpe::core::kMaxImageSide_px || height > vpe::core::kMaxImageSide_px)
    throw std::invalid_argument("a mask of " + std::to_string(width) + " x " + std::to_string(height) +
                                " pixels cannot be made");
  PhotoMask mask{width, height, {}};
  mask.shows.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  // Where edges cross rows, row by row: an edge takes time in proportion to its rows.
  std::vector<std::vector<double>> crossings(static_cast<std::size_t>(height));
  for (std::size_t n = 0; n < points.size(); ++n) {
    glm::dvec2 a = points[n];
    glm::dvec2 b = points[(n + 1) % points.size()];
    if (a.y > b.y) std::swap(a, b);
    const auto row = [&](double y) {
      return static_cast<int>(std::clamp(std::ceil(y - 0.5), 0.0, static_cast<double>(height)));
    };
    for (int y = row(a.y); y < row(b.y); ++y)
      crossings[static_cast<std::size_t>(y)].push_back(a.x + (b.x - a.x) * ((y + 0.5 - a.y) / (b.y - a.y)));
  }
  for (int y = 0; y < height; ++y) {
    std::vector<double>& xs = crossings[static_cast<std::size_t>(y)];
    std::sort(xs.begin(), xs.end());
    const auto pixel = [&](double x) {
      return static_cast<std::ptrdiff_t>(std::clamp(std::ceil(x - 0.5), 0.0, static_cast<double>(width)));
    };
    const auto begin = mask.shows.begin() + std::ptrdiff_t{y} * width;
    for (std::size_t n = 0; n + 1 < xs.size(); n += 2)
      std::fill(begin + pixel(xs[n]), begin + pixel(xs[n + 1]), 1);
  }
  return mask;
}

std::vector<glm::dvec2> read_contour_file(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = vpe::base::read_file(path, ContourLimits::kMostBytes);
  std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::vector<glm::dvec2> points;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = without_spaces(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (line.empty() || line.front() == '#') continue;
    const std::size_t comma = line.find(',');
    glm::dvec2 point(0);
    if (comma == std::string_view::npos || !read_place(line.substr(0, comma), point.x) ||
        !read_place(line.substr(comma + 1), point.y))
      throw vpe::base::file_error("read the contour", path,
                                  "line " + std::to_string(number) + " is not a point", kContourAdvice);
    if (points.size() == ContourLimits::kMostPoints)
      throw vpe::base::file_error("read the contour", path,
                                  "line " + std::to_string(number) + ": too many points",
                                  "leave out points; 1000000 are allowed");
    points.push_back(point);
  }
  if (points.size() < 3)
    throw vpe::base::file_error("read the contour", path, "it has " + std::to_string(points.size()) + " points",
                                "give the corners of a polygon, at least three");
  return points;
}

}  // namespace objects
