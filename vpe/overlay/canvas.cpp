#include "vpe/overlay/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#ifndef VPE_WITHOUT_CAIRO

#include <cairo.h>

#include <cstring>
#include <optional>

#include "vpe/overlay/stroke_mask.h"

namespace vpe::overlay {

namespace {

constexpr const char* kFamily = "DejaVu Sans";

// Half of a capital's height, as a share of the font's size.
constexpr double kHalfCapital = 0.365;

struct Release {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_font_options_t* options) const { cairo_font_options_destroy(options); }
};

void require(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw std::runtime_error(std::string("cannot draw the overlays: Cairo: ") + cairo_status_to_string(status) +
                           "; make the image smaller or set fewer overlays");
}

void set_ink(cairo_t* context, const Ink& ink) { cairo_set_source_rgba(context, ink.r, ink.g, ink.b, ink.a); }

// Lays a colour over pixels as far as they are covered, premultiplied as Cairo's images are.
class InkBlend {
 public:
  explicit InkBlend(const Ink& ink) {
    const double a = std::clamp(ink.a, 0.0, 1.0);
    const auto byte = [](double x) {
      return static_cast<std::uint32_t>(std::lround(255 * std::clamp(x, 0.0, 1.0)));
    };
    premultiplied_ = {byte(a), byte(ink.r * a), byte(ink.g * a), byte(ink.b * a)};
  }

  void operator()(std::span<const std::uint8_t> coverage, std::uint32_t* pixels) const {
    constexpr std::size_t kSkipped = 8;
    for (std::size_t n = 0; n < coverage.size();) {
      if (n + kSkipped <= coverage.size()) {
        std::uint64_t eight = 0;
        std::memcpy(&eight, &coverage[n], kSkipped);
        if (eight == 0) {
          n += kSkipped;
          continue;
        }
      }
      if (coverage[n] != 0) pixels[n] = over(coverage[n], pixels[n]);
      ++n;
    }
  }

 private:
  static std::uint32_t product(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t t = a * b + 128;
    return (t + (t >> 8)) >> 8;
  }

  std::uint32_t over(std::uint32_t coverage, std::uint32_t below) const {
    const std::uint32_t clear = 255 - product(premultiplied_[0], coverage);
    std::uint32_t sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t old = below >> (24 - 8 * k) & 255U;
      sum = sum << 8 | std::min(255U, product(premultiplied_[k], coverage) + product(old, clear));
    }
    return sum;
  }

  std::array<std::uint32_t, 4> premultiplied_{};  // alpha, red, green, blue
};

void trace(cairo_t* context, std::span<const glm::dvec2> points, bool closed) {
  cairo_new_path(context);
  for (const glm::dvec2& p : points) cairo_line_to(context, p.x, p.y);
  if (closed) cairo_close_path(context);
}

void set_font(cairo_t* context, const Font& font) {
  cairo_select_font_face(context, kFamily, CAIRO_FONT_SLANT_NORMAL,
                         font.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, font.size_px);
}

}  // namespace

struct Canvas::State {
  std::unique_ptr<cairo_surface_t, Release> surface;
  std::unique_ptr<cairo_t, Release> context;
  std::optional<StrokeMask> mask;  // made when the first thin line is drawn

  StrokeMask& thin_lines(int width, int height) {
    if (!mask) mask.emplace(width, height);
    return *mask;
  }

  // Lays a colour over what the mask covers.
  void blend(const Ink& ink) {
    // Cairo does not draw yet what waits, nor does it know of what others draw.
    cairo_surface_flush(surface.get());
    unsigned char* const bytes = cairo_image_surface_get_data(surface.get());
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
    const InkBlend blend(ink);
    mask->take_rows([&](int y, int x, std::span<const std::uint8_t> coverage) {
      blend(coverage, reinterpret_cast<std::uint32_t*>(bytes + static_cast<std::size_t>(y) * stride) + x);
    });
    cairo_surface_mark_dirty(surface.get());
  }
};

Canvas::Canvas(int width, int height) : width_(width), height_(height), state_(std::make_unique<State>()) {
  state_->surface.reset(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height));
  require(cairo_surface_status(state_->surface.get()));
  state_->context.reset(cairo_create(state_->surface.get()));
  cairo_t* context = state_->context.get();
  require(cairo_status(context));
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  // Without hinting, letters have the same shape at every position and angle.
  const std::unique_ptr<cairo_font_options_t, Release> options(cairo_font_options_create());
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(context, options.get());
}

Canvas::~Canvas() = default;

void Canvas::line(std::span<const glm::dvec2> points, bool closed, double width_px, const Ink& ink) {
  if (width_px <= kWidestThinLine_px) {
    state_->thin_lines(width_, height_).add(points, closed, width_px);
    state_->blend(ink);
    return;
  }
  cairo_t* context = state_->context.get();
  set_ink(context, ink);
  cairo_set_line_width(context, width_px);
  trace(context, points, closed);
  cairo_stroke(context);
}

void Canvas::dashed(std::span<const glm::dvec2> points, double width_px, const Ink& ink,
                    std::span<const double> lengths_px) {
  if (width_px <= kWidestThinLine_px && !lengths_px.empty()) {
    StrokeMask& mask = state_->thin_lines(width_, height_);
    for (const std::vector<glm::dvec2>& part : dashes(points, lengths_px)) mask.add(part, false, width_px);
    state_->blend(ink);
    return;
  }
  cairo_t* context = state_->context.get();
  cairo_set_dash(context, lengths_px.data(), static_cast<int>(lengths_px.size()), 0);
  line(points, false, width_px, ink);
  cairo_set_dash(context, nullptr, 0, 0);
}

void Canvas::paint(const Layer& image) {
  const int stride = cairo_format_stride_for_width(CAIRO_FORMAT_ARGB32, width_);
  std::vector<std::uint32_t> pixels(static_cast<std::size_t>(stride / 4) * static_cast<std::size_t>(height_));
  for (std::size_t y = 0; y < static_cast<std::size_t>(height_); ++y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(width_); ++x) {
      const core::Rgba& p = image.pixels.at(y * static_cast<std::size_t>(width_) + x);
      const auto premultiplied = [&](std::uint8_t value) { return (std::uint32_t{value} * p.a + 127U) / 255U; };
      pixels[y * static_cast<std::size_t>(stride / 4) + x] =
          std::uint32_t{p.a} << 24U | premultiplied(p.r) << 16U | premultiplied(p.g) << 8U | premultiplied(p.b);
    }
  }
  const std::unique_ptr<cairo_surface_t, Release> surface(cairo_image_surface_create_for_data(
      reinterpret_cast<unsigned char*>(pixels.data()), CAIRO_FORMAT_ARGB32, width_, height_, stride));
  require(cairo_surface_status(surface.get()));
  cairo_t* context = state_->context.get();
  cairo_set_source_surface(context, surface.get(), 0, 0);
  cairo_paint(context);
  // The source must not outlive its pixels.
  cairo_set_source_rgba(context, 0, 0, 0, 0);
}

void Canvas::polygon(std::span<const glm::dvec2> points, const Ink& ink) {
  cairo_t* context = state_->context.get();
  set_ink(context, ink);
  trace(context, points, true);
  cairo_fill(context);
}

TextSize Canvas::measure(std::string_view text, const Font& font) const {
  cairo_t* context = state_->context.get();
  set_font(context, font);
  cairo_text_extents_t extents;
  cairo_text_extents(context, printable_utf8(text).c_str(), &extents);
  // Leaves room for descenders below the line, and as much above it.
  return {extents.x_advance, 1.25 * font.size_px};
}

void Canvas::text(std::string_view text, glm::dvec2 centre, double angle_rad, const Lettering& style) {
  cairo_t* context = state_->context.get();
  const std::string shown = printable_utf8(text);
  const TextSize size = measure(text, style.font);
  cairo_save(context);
  cairo_translate(context, centre.x, centre.y);
  cairo_rotate(context, angle_rad);
  cairo_new_path(context);
  cairo_move_to(context, -0.5 * size.width, kHalfCapital * style.font.size_px);
  cairo_text_path(context, shown.c_str());
  set_ink(context, style.halo);
  cairo_set_line_width(context, std::max(2.0, 0.2 * style.font.size_px));
  cairo_stroke_preserve(context);
  set_ink(context, style.ink);
  cairo_fill(context);
  cairo_restore(context);
}

void Canvas::clear(glm::dvec2 centre, TextSize size, double angle_rad) {
  cairo_t* context = state_->context.get();
  cairo_save(context);
  cairo_translate(context, centre.x, centre.y);
  cairo_rotate(context, angle_rad);
  cairo_set_operator(context, CAIRO_OPERATOR_CLEAR);
  cairo_rectangle(context, -0.5 * size.width, -0.5 * size.height, size.width, size.height);
  cairo_fill(context);
  cairo_restore(context);
}

Layer Canvas::layer() const {
  require(cairo_status(state_->context.get()));
  cairo_surface_t* surface = state_->surface.get();
  cairo_surface_flush(surface);
  require(cairo_surface_status(surface));
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
  const unsigned char* bytes = cairo_image_surface_get_data(surface);
  Layer layer{width_, height_, {}};
  layer.pixels.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  const auto width = static_cast<std::size_t>(width_);
  for (std::size_t y = 0; y < static_cast<std::size_t>(height_); ++y) {
    const auto* row = reinterpret_cast<const std::uint32_t*>(bytes + y * stride);
    for (std::size_t x = 0; x < width; ++x) {
      const std::uint32_t argb = row[x];
      const std::uint32_t alpha = argb >> 24;
      if (alpha == 0) {
        layer.pixels[y * width + x] = {0, 0, 0, 0};
        continue;
      }
      const auto straight = [&](unsigned shift) {
        const std::uint32_t value = (argb >> shift & 255U) * 255U + alpha / 2;
        return static_cast<std::uint8_t>(std::min(value / alpha, 255U));
      };
      layer.pixels[y * width + x] = {straight(16), straight(8), straight(0), static_cast<std::uint8_t>(alpha)};
    }
  }
  return layer;
}

}  // namespace vpe::overlay

#else

namespace vpe::overlay {

// Settings reject every overlay in this build (core::overlays_refused), so these functions are not reached.
struct Canvas::State {};
Canvas::Canvas(int width, int height) : width_(width), height_(height) {
  throw std::runtime_error(std::string(core::overlays_refused()));
}
Canvas::~Canvas() = default;
void Canvas::line(std::span<const glm::dvec2>, bool, double, const Ink&) {}
void Canvas::dashed(std::span<const glm::dvec2>, double, const Ink&, std::span<const double>) {}
void Canvas::paint(const Layer&) {}
void Canvas::polygon(std::span<const glm::dvec2>, const Ink&) {}
TextSize Canvas::measure(std::string_view, const Font&) const { return {}; }
void Canvas::text(std::string_view, glm::dvec2, double, const Lettering&) {}
void Canvas::clear(glm::dvec2, TextSize, double) {}
Layer Canvas::layer() const { return {}; }

}  // namespace vpe::overlay

#endif

namespace vpe::overlay {

std::string printable_utf8(std::string_view text) {
  std::string out;
  for (std::size_t n = 0; n < text.size();) {
    const auto byte = [&](std::size_t k) {
      return n + k < text.size() ? static_cast<unsigned char>(text[n + k]) : 0U;
    };
    const unsigned first = byte(0);
    if (first < 0x80) {
      out += first < 0x20 || first == 0x7f ? ' ' : static_cast<char>(first);
      ++n;
      continue;
    }
    const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    unsigned code = first & (0xffU >> (length + 1));
    bool good = first >= 0xc2 && first <= 0xf4;
    for (std::size_t k = 1; k < length; ++k) {
      good = good && (byte(k) & 0xc0U) == 0x80U;
      code = code << 6 | (byte(k) & 0x3fU);
    }
    // Rejects overlong forms, surrogates, and codes beyond U+10FFFF.
    good = good &&
           code >= (length == 4   ? 0x10000U
                    : length == 3 ? 0x800U
                                  : 0x80U) &&
           code <= 0x10ffffU && (code < 0xd800U || code > 0xdfffU);
    if (good) out.append(text.substr(n, length));
    if (!good) out += "\xef\xbf\xbd";
    n += good ? length : 1;
  }
  return out;
}

}  // namespace vpe::overlay
