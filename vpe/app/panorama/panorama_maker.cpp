#include "vpe/app/panorama/panorama_maker.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "panorama/image/tile_codec.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/panorama/panorama_files.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/base/file.h"

namespace vpe::app {

namespace fs = std::filesystem;
using panorama::Piece;
using panorama::Strip;

namespace {

// Smoothing of edges reads fewer pixels around a piece than this.
constexpr int kSmoothingMargin_px = 8;

class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds) {}
  ~Stopwatch() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& seconds_;
  Clock::time_point start_ = Clock::now();
};

std::string text_of(const PanoramaFigures& figures) {
  return nlohmann::json{{"tile_error_m", figures.geometric_error_m},
                        {"shift_bound_px", figures.shift_bound_px},
                        {"tiles_substituted", figures.tiles_substituted},
                        {"tiles_missing", figures.tiles_missing}}
      .dump();
}

std::optional<PanoramaFigures> figures_from(const std::vector<std::uint8_t>& text) {
  try {
    const auto json = nlohmann::json::parse(text);
    // JSON has null for an error without a bound.
    const auto bound = [&json](const char* key) {
      const auto& value = json.at(key);
      return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
    };
    return PanoramaFigures{bound("tile_error_m"), bound("shift_bound_px"), json.at("tiles_substituted"),
                           json.at("tiles_missing")};
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Marks strips with terrain that could not be drawn: the next run draws them again.
constexpr const char* kIncomplete = "-incomplete";

}  // namespace

void PanoramaFigures::add(const PanoramaFigures& other) {
  geometric_error_m = std::max(geometric_error_m, other.geometric_error_m);
  shift_bound_px = std::max(shift_bound_px, other.shift_bound_px);
  tiles_substituted += other.tiles_substituted;
  tiles_missing += other.tiles_missing;
}

namespace {

// Returns what is left beside the image in memory: a strip, and a piece with its samples.
int free_memory_mb(const PanoramaRequest& request, const PanoramaPlan& plan, int memory_mb) {
  constexpr std::size_t kPieceBytes = 24;
  constexpr std::size_t kCarriedBytes = 16;  // colours, ranges and origins of both eyes
  constexpr int kLeast_mb = 64;
  // Side by side, the columns of some strips are kept.
  const std::size_t of_carried =
      kCarriedBytes * (request.stereo && request.stereo->layout == core::StereoLayout::kSideBySide ? 3 : 1);
  const std::size_t pixel_bytes = sizeof(base::Rgb) * (plan.is_red_cyan ? 2 : 1) +
                                  (request.layers.empty() ? 0 : sizeof(float)) +
                                  (request.stereo && request.stereo->carried_gap_px ? of_carried : 0);
  const std::size_t held =
      static_cast<std::size_t>(plan.strips.front().width * plan.size.height_px) * pixel_bytes +
      static_cast<std::size_t>(panorama::PlanLimits::kPiecePixels) * kPieceBytes;
  return std::max(kLeast_mb, memory_mb - static_cast<int>(held >> 20));
}

}  // namespace

int layers_memory_mb(const PanoramaRequest& request, const PanoramaPlan& plan, int memory_mb) {
  return request.layers.empty() ? 0 : free_memory_mb(request, plan, memory_mb) / 4;
}

int renderer_memory_mb(const PanoramaRequest& request, const PanoramaPlan& plan, int memory_mb) {
  return free_memory_mb(request, plan, memory_mb) - layers_memory_mb(request, plan, memory_mb);
}

// Holds one strip while it is drawn: colours, and ranges if there are auxiliary layers.
struct PanoramaMaker::Canvas {
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::int64_t x = 0;  // of its left edge in the image
  std::vector<base::Rgb> colour;
  std::vector<float> range_m;
  std::vector<Piece> pieces;
  PanoramaFigures figures;

  std::size_t index(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>(row * width + column);
  }
};

PanoramaMaker::PanoramaMaker(const PanoramaRequest& request, const PanoramaPlan& plan, Scene scene,
                             PanoramaOverlays& overlays, base::ThreadPool& pool)
    : request_(request),
      plan_(plan),
      scene_(std::move(scene)),
      overlays_(overlays),
      pool_(pool),
      margin_px_(request.settings.values().smooth_edges ? kSmoothingMargin_px : 0) {}

fs::path PanoramaMaker::strip_path(std::size_t n) const { return strip_file(request_.output, n); }

StripLayout PanoramaMaker::layout(std::size_t n) const {
  return layout_of(plan_, plan_.strips[n], request_.layers.size());
}

std::optional<panorama::StripFile> PanoramaMaker::keep(std::size_t n) {
  auto strip = panorama::StripFile::open(strip_path(n), scene_.fingerprint, layout(n).blocks());
  if (!strip) return std::nullopt;
  const auto figures = figures_from(strip->block(0));
  if (!figures) return std::nullopt;
  add_figures(n, *figures);
  ++kept_;
  return strip;
}

std::vector<panorama::StripFile> PanoramaMaker::run(ProgressLine& line, PanoramaTimes& times) {
  if (request_.stereo && request_.stereo->carried_gap_px)
    carrier_ = std::make_unique<CarriedEye>(plan_.map, viewpoint(), *request_.stereo);
  lock_ =
      std::make_unique<FolderLock>(strips_folder(request_.output), FolderLock::Use::kAlone, request_.output);
  remove_stale_strips(request_.output);
  std::vector<std::optional<panorama::StripFile>> strips(plan_.strips.size());
  const std::vector<std::size_t> turns = order();
  for (std::size_t turn = 0; turn < turns.size(); ++turn) {
    const std::size_t n = turns[turn];
    try {
      InterruptGuard::check();
      strips[n] = keep(n);
      if (!strips[n]) strips[n] = make(n, line, times);
      if (!is_carried_beside()) continue;
      std::vector<Strip> wanted;
      for (std::size_t later = turn + 1; later < turns.size(); ++later)
        std::ranges::copy(left_columns_for(plan_.strips[turns[later]]), std::back_inserter(wanted));
      left_.keep(wanted);
    } catch (const Interrupted& e) {
      throw Interrupted(e.signal(), std::string(e.what()) + ": " + std::to_string(kept_ + made_) + " of " +
                                        std::to_string(plan_.strips.size()) + " strips of " +
                                        request_.output.string() + " are kept; the same command continues");
    }
  }
  renderer_.reset();
  surface_.reset();
  carrier_.reset();
  std::vector<panorama::StripFile> all;
  for (std::optional<panorama::StripFile>& strip : strips) all.push_back(std::move(*strip));
  return all;
}

void PanoramaMaker::add_figures(std::size_t n, const PanoramaFigures& figures) {
  figures_.add(figures);
  if (is_carried_beside() && plan_.strips[n].x < plan_.map.width_px)
    left_bound_px_ = std::max(left_bound_px_, figures.shift_bound_px);
}

bool PanoramaMaker::is_carried_beside() const {
  return request_.stereo && request_.stereo->carried_gap_px &&
         request_.stereo->layout == core::StereoLayout::kSideBySide;
}

// Returns the turns of the strips: from left to right; but a strip of a right eye that is carried comes as soon as the
// left eye's columns are there from which it is.
std::vector<std::size_t> PanoramaMaker::order() const {
  std::vector<std::size_t> turns(plan_.strips.size());
  std::iota(turns.begin(), turns.end(), std::size_t{0});
  if (!is_carried_beside()) return turns;
  // Returns the last column that a strip has or needs: with it in turn, all others are there.
  const auto last = [this](std::size_t n) {
    const Strip& strip = plan_.strips[n];
    std::int64_t end = 0;
    for (const Strip& of : left_columns_for(strip)) end = std::max(end, of.x + of.width);
    return end;
  };
  std::ranges::stable_sort(turns, {}, last);
  return turns;
}

void PanoramaMaker::prepare() {
  overlays_.prepare();
  const int surface_mb = layers_memory_mb(request_, plan_, memory_mb());
  if (surface_mb > 0) {
    surface_ = std::make_unique<paging::Surface>(scene_.planet, static_cast<std::size_t>(surface_mb) << 20);
  }
  renderer_ = scene_.make_renderer(renderer_memory_mb(request_, plan_, memory_mb()));
}

// Returns what is left beside vector layers.
int PanoramaMaker::memory_mb() const {
  return std::max(scene_.memory_mb / 4, scene_.memory_mb - static_cast<int>(overlays_.held_bytes() >> 20));
}

panorama::StripFile PanoramaMaker::make(std::size_t n, ProgressLine& line, PanoramaTimes& times) {
  const Strip& strip = plan_.strips[n];
  Canvas canvas;
  canvas.x = strip.x;
  canvas.width = strip.width;
  canvas.height = plan_.size.height_px;
  const std::size_t pixels = static_cast<std::size_t>(canvas.width * canvas.height);
  if (!renderer_) {
    const Stopwatch watch(times.start);
    prepare();
  }
  canvas.colour.swap(colour_);
  canvas.colour.resize(pixels);
  if (!request_.layers.empty()) canvas.range_m.resize(pixels);
  const auto show = [&](double part) {
    InterruptGuard::check();
    const double done = static_cast<double>(kept_ + made_) + part;
    line.show("drawing", 0.95 * done / static_cast<double>(plan_.strips.size()));
  };
  if (is_carried_beside()) {
    draw_carried_beside(strip, canvas, show, times);
  } else if (request_.stereo && request_.stereo->carried_gap_px) {
    draw_carried(strip, canvas, show, times);
  } else if (request_.stereo) {
    draw_eyes(strip, canvas, show, times);
  } else {
    canvas.pieces = panorama::pieces_of(plan_.map, viewpoint(), strip, margin_px_);
    for (std::size_t k = 0; k < canvas.pieces.size(); ++k) {
      show(static_cast<double>(k) / static_cast<double>(canvas.pieces.size()));
      draw(canvas.pieces[k], strip, canvas, times);
    }
  }
  lay_overlays(canvas);
  panorama::StripFile made = write(n, canvas, times);
  colour_.swap(canvas.colour);
  add_figures(n, canvas.figures);
  ++made_;
  return made;
}

panorama::StripFile PanoramaMaker::write(std::size_t n, const Canvas& canvas, PanoramaTimes& times) {
  const fs::path path = strip_path(n);
  const StripLayout strip = layout(n);
  const std::string fingerprint = scene_.fingerprint + (canvas.figures.tiles_missing > 0 ? kIncomplete : "");
  base::OutputFile file(path);
  panorama::StripWriter writer(file, fingerprint);
  {
    const Stopwatch watch(times.encoding);
    writer.add(bytes_of(text_of(canvas.figures)));
    add_image(writer, strip, canvas);
  }
  {
    const Stopwatch watch(times.layers);
    for (const panorama::Plane layer : request_.layers) add_layer(writer, strip, canvas, layer);
  }
  const Stopwatch watch(times.encoding);
  writer.finish();
  file.commit();
  auto made = panorama::StripFile::open(path, fingerprint, strip.blocks());
  if (!made) throw base::file_error("read back", path, "it differs from what was written", "check the disk");
  return std::move(*made);
}

// Lays areas of vector layers over columns of one eye's image with ranges, whose pieces have its pixels.
void PanoramaMaker::fill_areas(core::Frame& frame, const std::vector<Piece>& pieces) {
  const auto stride = static_cast<std::size_t>(frame.width);
  for (const Piece& piece : pieces)
    overlays_.fill(piece.view,
                   {frame.colour, frame.range_m,
                    static_cast<std::size_t>(piece.y) * stride + static_cast<std::size_t>(piece.x), stride});
}

// Draws lines of vector layers over columns [x, x + width) of an eye's image, which are columns of `pixels` from `begin` on.
void PanoramaMaker::drape_columns(panorama::Eye eye, std::int64_t x, std::int64_t width,
                                  std::vector<base::Rgb>& pixels, std::int64_t stride, std::int64_t begin) {
  std::vector<base::Rgb> columns;
  const std::int64_t height = plan_.map.height_px;
  for (std::int64_t y = 0; y < height; ++y)
    columns.insert(columns.end(), pixels.begin() + y * stride + begin,
                   pixels.begin() + y * stride + begin + width);
  overlays_.drape(eye, {x, 0, width, height, columns});
  for (std::int64_t y = 0; y < height; ++y)
    std::copy_n(columns.begin() + y * width, width, pixels.begin() + y * stride + begin);
}

// Draws the same overlays over both eyes of a pair, as if they were infinitely far away. Lines of vector layers lie where each
// eye sees the ground; in red-cyan they are drawn before the eyes are mixed.
void PanoramaMaker::lay_overlays(Canvas& canvas) {
  const bool is_pair = request_.stereo && !plan_.is_red_cyan;
  if (!is_pair) {
    if (!request_.stereo)
      overlays_.drape(std::nullopt, {canvas.x, 0, canvas.width, canvas.height, canvas.colour});
    return overlays_.lay({canvas.x, 0, canvas.width, canvas.height, canvas.colour});
  }
  std::vector<base::Rgb> half;  // the part of one eye's image in this strip
  for (std::int64_t y = 0; y < plan_.size.height_px; y += plan_.map.height_px) {
    for (std::int64_t x = 0; x < plan_.size.width_px; x += plan_.map.width_px) {
      const std::int64_t begin = std::max(x, canvas.x);
      const std::int64_t width = std::min(x + plan_.map.width_px, canvas.x + canvas.width) - begin;
      if (width <= 0) continue;
      half.clear();
      const auto row_of = [&](std::int64_t row) {
        return std::span(canvas.colour)
            .subspan(canvas.index(begin - canvas.x, y + row), static_cast<std::size_t>(width));
      };
      for (std::int64_t row = 0; row < plan_.map.height_px; ++row) {
        const auto pixels = row_of(row);
        half.insert(half.end(), pixels.begin(), pixels.end());
      }
      overlays_.drape(x > 0 || y > 0 ? panorama::Eye::kRight : panorama::Eye::kLeft,
                      {begin - x, 0, width, plan_.map.height_px, half});
      overlays_.lay({begin - x, 0, width, plan_.map.height_px, half});
      for (std::int64_t row = 0; row < plan_.map.height_px; ++row)
        std::copy_n(half.begin() + row * width, width, row_of(row).begin());
    }
  }
}

panorama::Viewpoint PanoramaMaker::viewpoint() const {
  return panorama::viewpoint_of(request_.camera, scene_.planet->radius_m());
}

// Goes by columns of one tile: cutting the whole strip into pieces could take more memory than the image.
void PanoramaMaker::draw_eyes(const Strip& strip, Canvas& canvas, const std::function<void(double)>& show,
                              PanoramaTimes& times) {
  const bool is_mixed = plan_.is_red_cyan;
  std::vector<base::Rgb> left;
  for (int begin = 0; begin < strip.width; begin += panorama::kTile_px) {
    const int width = std::min(static_cast<int>(panorama::kTile_px), strip.width - begin);
    const std::vector<Piece> pieces =
        panorama::pair_pieces_of(plan_.map, viewpoint(), *request_.stereo, {strip.x + begin, width});
    const std::size_t of_left = is_mixed ? pieces.size() / 2 : pieces.size();
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const double part = static_cast<double>(k) / static_cast<double>(pieces.size());
      show((begin + width * part) / strip.width);
      if (k == of_left) {
        left = canvas.colour;
        drape_columns(panorama::Eye::kLeft, strip.x + begin, width, left, canvas.width, begin);
      }
      draw(pieces[k], strip, canvas, times);
    }
    if (is_mixed)
      drape_columns(panorama::Eye::kRight, strip.x + begin, width, canvas.colour, canvas.width, begin);
    for (std::int64_t row = 0; row < canvas.height && is_mixed; ++row) {
      const auto columns = [&](std::vector<base::Rgb>& pixels) {
        return std::span<base::Rgb>(pixels).subspan(canvas.index(begin, row), static_cast<std::size_t>(width));
      };
      core::mix_red_cyan(columns(left), columns(canvas.colour));
      std::ranges::copy(columns(left), columns(canvas.colour).begin());
    }
  }
}

// Returns the columns of the left eye's image that a strip has or is carried from.
std::vector<Strip> PanoramaMaker::left_columns_for(const Strip& strip) const {
  std::vector<Strip> columns;
  const std::int64_t width = plan_.map.width_px;
  const std::int64_t end = strip.x + strip.width;
  if (strip.x < width) columns.push_back({strip.x, static_cast<int>(std::min(end, width) - strip.x)});
  const std::int64_t begin = std::max(strip.x, width);
  if (begin < end)
    std::ranges::copy(carrier_->columns_for({begin - width, static_cast<int>(end - begin)}),
                      std::back_inserter(columns));
  return columns;
}

// Draws columns of the left eye's image.
core::Frame PanoramaMaker::draw_left(const Strip& columns, Canvas& canvas,
                                     const std::function<void(double)>& show, PanoramaTimes& times) {
  core::Frame left;
  left.width = columns.width;
  left.height = static_cast<int>(plan_.map.height_px);
  left.colour.resize(static_cast<std::size_t>(left.width) * static_cast<std::size_t>(left.height));
  left.range_m.resize(left.colour.size());
  const std::vector<Piece> pieces = carrier_->left_pieces({columns});
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    show(static_cast<double>(k) / static_cast<double>(pieces.size()));
    const core::DrawResult result = draw_piece(pieces[k], true, canvas, times);
    copy_into(left, pieces[k], result.frame);
  }
  return left;
}

// Carries a strip of the right eye's image from the left one's columns_for(strip).
RightEye PanoramaMaker::carry(const core::Frame& left, const Strip& strip, Canvas& canvas,
                              const std::function<void(double)>& show, PanoramaTimes& times) {
  const Stopwatch watch(times.casting);
  RightEye right = carrier_->carry(left, strip, dynamic_cast<core::PixelRenderer&>(*renderer_),
                                   scene_.draw_request, pool_, show);
  failures_.insert(failures_.end(), right.failures.begin(), right.failures.end());
  require_complete(render_options(request_), right.drawn);
  canvas.figures.shift_bound_px =
      std::max({canvas.figures.shift_bound_px, left_bound_px_, right.drawn.certificate.shift_bound_px});
  canvas.figures.shift_bound_px += right.added_px;
  canvas.figures.add({right.drawn.certificate.geometric_error_m, 0, right.drawn.stats.tiles_substituted,
                      static_cast<std::int64_t>(right.drawn.missing.size())});
  return right;
}

// Draws the left eye with what lies on its right, and carries it.
void PanoramaMaker::draw_carried(const Strip& strip, Canvas& canvas, const std::function<void(double)>& show,
                                 PanoramaTimes& times) {
  constexpr double kOfDrawing = 0.6;  // the left eye takes so much of the time
  const std::vector<Strip> columns = carrier_->columns_for(strip);
  core::Frame left = left_.join(columns, [&](const Strip& missing) {
    return draw_left(
        missing, canvas, [&](double part) { show(kOfDrawing * part); }, times);
  });
  left_.keep({});
  RightEye right = carry(
      left, strip, canvas, [&](double part) { show(kOfDrawing + (1 - kOfDrawing) * part); }, times);
  if (overlays_.has_areas()) {
    fill_areas(left, carrier_->left_pieces({strip}));
    fill_areas(right.frame, carrier_->right_pieces(strip));
  }
  if (plan_.is_red_cyan) {
    drape_columns(panorama::Eye::kLeft, strip.x, strip.width, left.colour, left.width, 0);
    drape_columns(panorama::Eye::kRight, strip.x, strip.width, right.frame.colour, strip.width, 0);
  }
  const auto width = static_cast<std::size_t>(strip.width);
  for (std::int64_t y = 0; y < plan_.map.height_px; ++y) {
    const std::span<base::Rgb> of_left(
        &left.colour[static_cast<std::size_t>(y) * static_cast<std::size_t>(left.width)], width);
    const std::span<base::Rgb> of_right(&right.frame.colour[static_cast<std::size_t>(y) * width], width);
    if (plan_.is_red_cyan) {
      core::mix_red_cyan(of_left, of_right);
    } else {
      std::ranges::copy(of_right, &canvas.colour[canvas.index(0, y + plan_.map.height_px)]);
    }
    std::ranges::copy(of_left, &canvas.colour[canvas.index(0, y)]);
  }
}

// Draws what a strip has of the left image, and carries what it has of the right one.
void PanoramaMaker::draw_carried_beside(const Strip& strip, Canvas& canvas,
                                        const std::function<void(double)>& show, PanoramaTimes& times) {
  const auto draw_columns = [&](const Strip& missing) { return draw_left(missing, canvas, show, times); };
  const auto copy_rows = [&](const core::Frame& image, std::int64_t to, std::int64_t count) {
    for (std::int64_t y = 0; y < plan_.map.height_px; ++y)
      std::copy_n(&image.colour[static_cast<std::size_t>(y * image.width)], count,
                  &canvas.colour[canvas.index(to, y)]);
  };
  const std::int64_t of_left = std::clamp<std::int64_t>(plan_.map.width_px - strip.x, 0, strip.width);
  const auto fill = [&](core::Frame& image, const std::vector<Piece>& pieces) {
    if (overlays_.has_areas()) fill_areas(image, pieces);
  };
  if (of_left > 0) {
    const std::vector<Strip> columns{{strip.x, static_cast<int>(of_left)}};
    core::Frame image = left_.join(columns, draw_columns);
    fill(image, carrier_->left_pieces(columns));
    copy_rows(image, 0, of_left);
  }
  if (of_left == strip.width) return;
  const Strip right{strip.x + of_left - plan_.map.width_px, static_cast<int>(strip.width - of_left)};
  const core::Frame left = left_.join(carrier_->columns_for(right), draw_columns);
  RightEye carried = carry(left, right, canvas, show, times);
  fill(carried.frame, carrier_->right_pieces(right));
  copy_rows(carried.frame, of_left, right.width);
}

void PanoramaMaker::draw(const Piece& piece, const Strip& strip, Canvas& canvas, PanoramaTimes& times) {
  const bool want_range = !request_.layers.empty();
  core::DrawResult result = draw_piece(piece, want_range || overlays_.has_areas(), canvas, times);
  core::Frame& frame = result.frame;
  if (overlays_.has_areas())
    overlays_.fill(piece.view, {frame.colour, frame.range_m, 0, static_cast<std::size_t>(frame.width)});
  for (int row = 0; row < piece.height; ++row) {
    const auto from = static_cast<std::size_t>(row + piece.margin_px) * static_cast<std::size_t>(frame.width) +
                      static_cast<std::size_t>(piece.margin_px);
    const std::size_t to = canvas.index(piece.x - strip.x, piece.y + row);
    std::copy_n(frame.colour.data() + from, piece.width, canvas.colour.data() + to);
    if (want_range) std::copy_n(frame.range_m.data() + from, piece.width, canvas.range_m.data() + to);
  }
}

core::DrawResult PanoramaMaker::draw_piece(const Piece& piece, bool want_range, Canvas& canvas,
                                           PanoramaTimes& times) {
  core::DrawRequest draw_request = scene_.draw_request;
  draw_request.view = piece.view;
  draw_request.want_range = want_range;
  core::DrawResult result = renderer_->draw(draw_request);
  failures_.insert(failures_.end(), result.failures.begin(), result.failures.end());
  require_complete(render_options(request_), result);
  constexpr double kMs = 1e-3;
  const core::FrameStats& stats = result.stats;
  if (request_.backend == core::Backend::kRay) {
    times.casting += kMs * stats.select_ms;
    times.shading += kMs * (stats.draw_ms - stats.select_ms);
  } else {
    times.paging += kMs * stats.load_ms;
    times.casting += kMs * (stats.select_ms + stats.draw_ms);
    times.shading += kMs * stats.read_ms;
  }
  canvas.figures.add({result.certificate.geometric_error_m,
                      result.certificate.image_bound_px.value_or(result.certificate.shift_bound_px),
                      stats.tiles_substituted, static_cast<std::int64_t>(result.missing.size())});
  return result;
}

void PanoramaMaker::add_tiles(panorama::StripWriter& writer, const StripLayout& layout, const Canvas& canvas,
                              const panorama::SampleFormat& format, const FillRow& fill) const {
  constexpr std::int64_t kSide = panorama::kTile_px;
  const std::size_t pixel_bytes = format.pixel_bytes();
  const std::size_t row_bytes = pixel_bytes * kSide;
  // Pixels beyond the image repeat its edge.
  const auto fill_tile = [&](std::int64_t column, std::int64_t row, std::uint8_t* tile) {
    const std::int64_t columns = std::min(kSide, canvas.width - column);
    const std::int64_t rows = std::min(kSide, canvas.height - row);
    for (std::int64_t j = 0; j < rows; ++j) {
      std::uint8_t* out = tile + static_cast<std::size_t>(j) * row_bytes;
      fill(column, row + j, columns, out);
      for (std::int64_t i = columns; i < kSide; ++i)
        std::memcpy(out + static_cast<std::size_t>(i) * pixel_bytes,
                    out + static_cast<std::size_t>(columns - 1) * pixel_bytes, pixel_bytes);
    }
    for (std::int64_t j = rows; j < kSide; ++j)
      std::memcpy(tile + static_cast<std::size_t>(j) * row_bytes,
                  tile + static_cast<std::size_t>(rows - 1) * row_bytes, row_bytes);
  };
  const std::size_t batch = 4 * static_cast<std::size_t>(pool_.threads());
  std::vector<std::vector<std::uint8_t>> packed(batch);
  for (std::size_t begin = 0; begin < layout.tiles(); begin += batch) {
    InterruptGuard::check();
    const std::size_t count = std::min(batch, layout.tiles() - begin);
    pool_.run(count, [&](std::size_t n) {
      thread_local std::vector<std::uint8_t> tile;  // reused, like the packer's own buffer
      tile.resize(format.tile_bytes());
      const auto index = static_cast<std::int64_t>(begin + n);
      fill_tile(index % layout.tiles_across * kSide, index / layout.tiles_across * kSide, tile.data());
      packed[n] = panorama::pack_tile(tile, format);
    });
    for (std::size_t n = 0; n < count; ++n) writer.add(packed[n]);
  }
}

void PanoramaMaker::add_image(panorama::StripWriter& writer, const StripLayout& layout,
                              const Canvas& canvas) const {
  if (!layout.in_tiles) {
    for (std::int64_t band = 0; band < layout.bands; ++band) {
      const std::size_t begin = canvas.index(0, band * StripLayout::kBandRows);
      const std::size_t end =
          std::min(canvas.index(0, (band + 1) * StripLayout::kBandRows), canvas.colour.size());
      writer.add({reinterpret_cast<const std::uint8_t*>(canvas.colour.data() + begin),
                  (end - begin) * sizeof(base::Rgb)});
    }
    return;
  }
  add_tiles(writer, layout, canvas, panorama::kRgb,
            [&](std::int64_t column, std::int64_t row, std::int64_t count, std::uint8_t* out) {
              std::memcpy(out, &canvas.colour[canvas.index(column, row)],
                          static_cast<std::size_t>(count) * sizeof(base::Rgb));
            });
}

void PanoramaMaker::add_layer(panorama::StripWriter& writer, const StripLayout& layout, const Canvas& canvas,
                              panorama::Plane layer) const {
  const panorama::SampleFormat& format = panorama::info_of(layer).format;
  const double exaggeration = request_.settings.values().exaggeration;
  const auto holds = [](const Piece& p, std::int64_t x, std::int64_t y) {
    return x >= p.x && x < p.x + p.width && y >= p.y && y < p.y + p.height;
  };
  const auto fill = [&](std::int64_t column, std::int64_t row, std::int64_t count, std::uint8_t* out) {
    const Piece* piece = canvas.pieces.data();
    for (std::int64_t x = canvas.x + column; x < canvas.x + column + count; ++x) {
      if (!holds(*piece, x, row)) {
        piece = &*std::find_if(canvas.pieces.begin(), canvas.pieces.end(),
                               [&](const Piece& p) { return holds(p, x, row); });
      }
      panorama::measure(layer, *surface_, exaggeration, piece->view.camera.position_m,
                        panorama::line_of_sight(*piece, x, row),
                        canvas.range_m[canvas.index(x - canvas.x, row)], out);
      out += format.pixel_bytes();
    }
  };
  add_tiles(writer, layout, canvas, format, fill);
}

}  // namespace vpe::app
