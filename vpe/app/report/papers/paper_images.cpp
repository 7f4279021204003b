#include "vpe/app/report/papers/paper_images.h"

#include <algorithm>
#include <cstdlib>

namespace vpe::app {

report::PageImage write_paper_image(const std::filesystem::path& folder, const std::string& name,
                                    const std::string& caption, const core::RgbImage& image) {
  core::write_image(folder / name, image.pixels, image.width, image.height);
  return {caption, core::encode_png(image.pixels, image.width, image.height, 6)};
}

core::RgbImage eightfold_difference(const core::RgbImage& a, const core::RgbImage& b) {
  core::RgbImage image{a.width, a.height, {}};
  for (std::size_t n = 0; n < a.pixels.size(); ++n) {
    const auto tone = [](int x, int y) {
      return static_cast<std::uint8_t>(std::min(255, 8 * std::abs(x - y)));
    };
    const base::Rgb& p = a.pixels[n];
    const base::Rgb& q = b.pixels[n];
    image.pixels.push_back({tone(p.r, q.r), tone(p.g, q.g), tone(p.b, q.b)});
  }
  return image;
}

}  // namespace vpe::app
