#include "objects/model/texture_pyramid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace objects {

namespace {

glm::vec4 to_vec4(const Rgba& c) {
  return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b), static_cast<float>(c.a)};
}

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::lround(glm::clamp(value, 0.0F, 255.0F)));
}

// Hidden texels have no say in the colour of those beside them.
glm::vec4 weighted(const glm::vec4& c, float weight) { return {glm::vec3(c) * (c.w * weight), c.w * weight}; }

glm::vec4 unweighted(const glm::vec4& sum) {
  return sum.w > 0 ? glm::vec4(glm::vec3(sum) / sum.w, sum.w) : glm::vec4(0);
}

Texture halved(const Texture& from) {
  Texture out;
  out.width = std::max(1, from.width / 2);
  out.height = std::max(1, from.height / 2);
  out.texels.reserve(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
  for (int y = 0; y < out.height; ++y) {
    const int y0 = static_cast<int>(std::int64_t{y} * from.height / out.height);
    const int y1 = std::max(y0 + 1, static_cast<int>(std::int64_t{y + 1} * from.height / out.height));
    for (int x = 0; x < out.width; ++x) {
      const int x0 = static_cast<int>(std::int64_t{x} * from.width / out.width);
      const int x1 = std::max(x0 + 1, static_cast<int>(std::int64_t{x + 1} * from.width / out.width));
      glm::vec4 sum(0);
      const float share = 1.0F / static_cast<float>((x1 - x0) * (y1 - y0));
      for (int j = y0; j < y1; ++j) {
        for (int i = x0; i < x1; ++i)
          sum +=
              weighted(to_vec4(from.texels[static_cast<std::size_t>(j) * static_cast<std::size_t>(from.width) +
                                           static_cast<std::size_t>(i)]),
                       share);
      }
      const glm::vec4 c = unweighted(sum);
      out.texels.push_back({to_byte(c.x), to_byte(c.y), to_byte(c.z), to_byte(c.w)});
    }
  }
  return out;
}

int wrapped(float floored, int size) {
  const auto n = static_cast<std::int64_t>(floored) % size;
  return static_cast<int>(n < 0 ? n + size : n);
}

glm::vec4 bilinear(const Texture& t, const glm::vec2& uv) {
  const auto place = [](float value, int size) {
    const float repeated = value - std::floor(value);
    return repeated * static_cast<float>(size) - 0.5F;
  };
  const float x = place(uv.x, t.width);
  const float y = place(uv.y, t.height);
  const float left = std::floor(x);
  const float top = std::floor(y);
  glm::vec4 sum(0);
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const float wx = i == 0 ? 1.0F - (x - left) : x - left;
      const float wy = j == 0 ? 1.0F - (y - top) : y - top;
      const auto at = static_cast<std::size_t>(wrapped(top + static_cast<float>(j), t.height)) *
                          static_cast<std::size_t>(t.width) +
                      static_cast<std::size_t>(wrapped(left + static_cast<float>(i), t.width));
      sum += weighted(to_vec4(t.texels[at]), wx * wy);
    }
  }
  return unweighted(sum);
}

glm::vec4 bilinear_within(const Texture& t, const glm::vec2& uv, bool repeats_across) {
  const float x = uv.x * static_cast<float>(t.width) - 0.5F;
  const float y = uv.y * static_cast<float>(t.height) - 0.5F;
  const float left = std::floor(x);
  const float top = std::floor(y);
  glm::vec4 sum(0);
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const float wx = i == 0 ? 1.0F - (x - left) : x - left;
      const float wy = j == 0 ? 1.0F - (y - top) : y - top;
      const float column = left + static_cast<float>(i);
      const int across = repeats_across
                             ? wrapped(column, t.width)
                             : static_cast<int>(glm::clamp(column, 0.0F, static_cast<float>(t.width - 1)));
      const int down =
          static_cast<int>(glm::clamp(top + static_cast<float>(j), 0.0F, static_cast<float>(t.height - 1)));
      sum += weighted(to_vec4(t.texels[static_cast<std::size_t>(down) * static_cast<std::size_t>(t.width) +
                                       static_cast<std::size_t>(across)]),
                      wx * wy);
    }
  }
  return unweighted(sum);
}

}  // namespace

TexturePyramid::TexturePyramid(Texture texture)
    : is_opaque_(std::ranges::all_of(texture.texels, [](const Rgba& c) { return c.a == 255; })) {
  levels_.push_back(std::move(texture));
  while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(halved(levels_.back()));
}

glm::vec4 TexturePyramid::sample(const glm::vec2& uv, float footprint_uv) const {
  const auto side = static_cast<float>(std::max(levels_[0].width, levels_[0].height));
  const float texels = footprint_uv * side;
  const auto last = static_cast<float>(levels_.size() - 1);
  const float level = texels > 1 ? std::min(last, std::log2(texels)) : 0.0F;
  const auto finer = static_cast<std::size_t>(level);
  const float share = level - static_cast<float>(finer);
  const glm::vec4 fine = bilinear(levels_[finer], uv);
  if (share <= 0.0F || finer + 1 >= levels_.size()) return fine;
  return glm::mix(fine, bilinear(levels_[finer + 1], uv), share);
}

glm::vec4 TexturePyramid::sample_within(const glm::vec2& uv, float footprint_texels,
                                        bool repeats_across) const {
  const auto last = static_cast<float>(levels_.size() - 1);
  const float level = footprint_texels > 1 ? std::min(last, std::log2(footprint_texels)) : 0.0F;
  const auto finer = static_cast<std::size_t>(level);
  const float share = level - static_cast<float>(finer);
  const glm::vec4 fine = bilinear_within(levels_[finer], uv, repeats_across);
  if (share <= 0.0F || finer + 1 >= levels_.size()) return fine;
  return glm::mix(fine, bilinear_within(levels_[finer + 1], uv, repeats_across), share);
}

glm::vec4 TexturePyramid::mean() const { return to_vec4(levels_.back().texels.front()); }

std::size_t TexturePyramid::bytes() const {
  std::size_t sum = 0;
  for (const Texture& t : levels_) sum += t.texels.capacity() * sizeof(Rgba);
  return sum;
}

}  // namespace objects
