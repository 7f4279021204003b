#include "vpe/overlay/features/panorama_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

namespace vpe::overlay {
namespace {

constexpr double kParts = 32;  // of a pixel, in which steps are kept
constexpr std::int64_t kSquare_px = 256;
constexpr std::size_t kPiecesOfChunk = 64;
constexpr std::size_t kPointsOfChunk = 256;

// Pieces [begin, end) of a layer: whole lines.
struct Chunk {
  std::size_t layer;
  std::size_t begin;
  std::size_t end;
};

std::vector<Chunk> chunks_of(const std::vector<SceneLayer>& layers) {
  std::vector<Chunk> chunks;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const auto& pieces = layers[k].features->pieces();
    for (std::size_t begin = 0; begin < pieces.size();) {
      std::size_t end = std::min(begin + kPiecesOfChunk, pieces.size());
      while (end < pieces.size() && !pieces[end].begins) ++end;
      chunks.push_back({k, begin, end});
      begin = end;
    }
  }
  return chunks;
}

}  // namespace

PanoramaLines::PanoramaLines(const std::vector<SceneLayer>& layers, MakeSight make_sight,
                             core::HiddenLines hidden, base::ThreadPool& pool, std::size_t memory_bytes)
    : layers_(layers),
      make_sight_(std::move(make_sight)),
      hidden_(hidden),
      pool_(pool),
      memory_bytes_(memory_bytes),
      frame_(make_sight_()->frame()),
      kept_(layers.size()) {}

FeaturePainter PanoramaLines::painter(std::size_t layer) const {
  return {frame_.scale, layers_[layer].opacity, hidden_};
}

std::size_t PanoramaLines::bytes() const {
  std::size_t total = 0;
  for (const Kept& kept : kept_)
    total += kept.runs.size() * sizeof(Run) + kept.steps.size() * sizeof(Step) +
             kept.markers.size() * sizeof(Marker);
  return total;
}

bool PanoramaLines::meets(double low_px, double high_px, double left_px, double right_px) const {
  const auto at = [&](double shift) { return low_px + shift <= right_px && high_px + shift >= left_px; };
  return at(0) || (frame_.turn_px > 0 && (at(frame_.turn_px) || at(-frame_.turn_px)));
}

// Halves the window while it takes too much memory.
void PanoramaLines::shrink(double least_right_px) {
  while (bytes() > memory_bytes_ && window_.right_px > least_right_px) {
    window_.right_px = std::max(least_right_px, 0.5 * (window_.left_px + window_.right_px));
    for (Kept& kept : kept_) {
      Kept left;
      for (const Run& run : kept.runs) {
        if (!meets(run.low_px.x, run.high_px.x, window_.left_px, window_.right_px)) continue;
        left.runs.push_back(run);
        left.runs.back().begin = left.steps.size();
        left.steps.insert(left.steps.end(), kept.steps.begin() + static_cast<std::ptrdiff_t>(run.begin),
                          kept.steps.begin() + static_cast<std::ptrdiff_t>(run.begin + run.steps));
      }
      std::ranges::copy_if(kept.markers, std::back_inserter(left.markers), [this](const Marker& m) {
        return meets(m.at_px.x - m.radius_px, m.at_px.x + m.radius_px, window_.left_px, window_.right_px);
      });
      kept = std::move(left);
    }
  }
}

void PanoramaLines::add_run(std::size_t layer, const DrapedRun& run, std::size_t begin, std::size_t end) {
  Kept& kept = kept_[layer];
  const mars::FeatureStyle& style = layers_[layer].features->style(run.feature);
  Run own;
  own.feature = run.feature;
  own.is_hidden = run.is_hidden;
  own.distance_m = static_cast<float>(run.distance_m);
  own.first_px = own.low_px = own.high_px = run.points_px[begin];
  for (std::size_t n = begin; n < end; ++n) {
    own.low_px = glm::min(own.low_px, run.points_px[n]);
    own.high_px = glm::max(own.high_px, run.points_px[n]);
  }
  const double around_px = 0.5 * painter(layer).width_px(style, own.distance_m) + 1.5;
  own.low_px -= around_px;
  own.high_px += around_px;
  if (!meets(own.low_px.x, own.high_px.x, window_.left_px, window_.right_px)) return;
  own.begin = kept.steps.size();
  own.steps = static_cast<std::uint32_t>(end - begin - 1);
  glm::dvec2 last(0);
  for (std::size_t n = begin + 1; n < end; ++n) {
    // Steps are between rounded positions, so that errors do not add up.
    const glm::dvec2 next = glm::round((run.points_px[n] - own.first_px) * kParts);
    const glm::dvec2 step = glm::clamp(next - last, -127.0, 127.0);
    kept.steps.push_back({static_cast<std::int8_t>(step.x), static_cast<std::int8_t>(step.y)});
    last += step;
  }
  kept.runs.push_back(own);
}

void PanoramaLines::keep(std::size_t layer, const DrapedRun& run) {
  if (run.is_hidden && hidden_ == core::HiddenLines::kLeftOut) return;
  for (std::size_t begin = 0; begin + 1 < run.points_px.size(); begin += kPointsOfChunk)
    add_run(layer, run, begin, std::min(begin + kPointsOfChunk + 1, run.points_px.size()));
}

struct PanoramaLines::Draped {
  std::vector<DrapedRun> runs;
};

// Drapes everything, and keeps what lies in columns from left_px on: at least up to least_right_px.
void PanoramaLines::drape(double left_px, double least_right_px) {
  ++passes_;
  window_ = {left_px, frame_.size_px.x};
  for (Kept& kept : kept_) kept = {};
  const bool is_first = passes_ == 1;
  if (is_first) {
    for (const SceneLayer& layer : layers_) use_.emplace_back(*layer.features);
    found_.resize(layers_.size());
    lengths_.resize(layers_.size());
  }
  const auto is_inside = [this](glm::dvec2 at) {
    const double x = frame_.turn_px > 0 ? at.x - frame_.turn_px * std::floor(at.x / frame_.turn_px) : at.x;
    return x >= 0 && x < frame_.size_px.x && at.y >= 0 && at.y < frame_.size_px.y;
  };
  const auto survey_run = [&](std::size_t k, const DrapedRun& run) {
    const GroundFeatures& features = *layers_[k].features;
    const glm::dvec2 middle = run.points_px[run.points_px.size() / 2];
    if (run.is_hidden || !is_inside(middle)) return;
    use_[k].lines[features.style_number(run.feature)] = 1;
    if (!features.has_labels()) return;
    double& length = lengths_[k][run.feature];
    const auto own = static_cast<double>(run.points_px.size());
    if (own <= length) return;
    length = own;
    const double width_px = painter(k).width_px(features.style(run.feature), run.distance_m);
    found_[k][run.feature] = {run.feature, middle, run.distance_m, width_px};
  };
  const std::vector<Chunk> chunks = chunks_of(layers_);
  const std::size_t batch = 4 * static_cast<std::size_t>(pool_.threads());
  std::vector<Draped> draped(batch);
  for (std::size_t begin = 0; begin < chunks.size(); begin += batch) {
    const std::size_t count = std::min(batch, chunks.size() - begin);
    pool_.run(count, [&](std::size_t n) {
      const Chunk& chunk = chunks[begin + n];
      const std::unique_ptr<GroundSight> sight = make_sight_();
      draped[n].runs.clear();
      drape_lines(*layers_[chunk.layer].features, chunk.begin, chunk.end, *sight,
                  [&](const DrapedRun& run) { draped[n].runs.push_back(run); });
    });
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t k = chunks[begin + n].layer;
      for (const DrapedRun& run : draped[n].runs) {
        if (is_first) survey_run(k, run);
        keep(k, run);
      }
    }
    shrink(least_right_px);
  }
  const std::unique_ptr<GroundSight> sight = make_sight_();
  for (std::size_t k = 0; k < layers_.size(); ++k) {
    const GroundFeatures& features = *layers_[k].features;
    const FeaturePainter own = painter(k);
    for (const GroundFeatures::Point& point : features.points()) {
      const mars::FeatureStyle& style = features.style(point.feature);
      const auto at = overlay::drape(*sight, point.place);
      if (!at || at->is_hidden || !is_inside(at->at_px) || !own.scale.shows(style, at->distance_m)) continue;
      const double radius_px = own.radius_px(style, at->distance_m);
      if (is_first)
        found_[k].try_emplace(point.feature, LabelAnchor{point.feature, at->at_px, at->distance_m, radius_px});
      if (!style.marker) continue;
      if (is_first) use_[k].points[features.style_number(point.feature)] = 1;
      const Marker marker{point.feature, at->at_px, at->distance_m, radius_px + own.rim_px() + 1};
      if (meets(marker.at_px.x - marker.radius_px, marker.at_px.x + marker.radius_px, window_.left_px,
                window_.right_px))
        kept_[k].markers.push_back(marker);
    }
    shrink(least_right_px);
  }
  if (!is_first) return;
  for (const auto& of_layer : found_) {
    std::vector<LabelAnchor>& anchors = anchors_.emplace_back();
    for (const auto& [feature, anchor] : of_layer) anchors.push_back(anchor);
  }
  found_.clear();
  lengths_.clear();
}

const std::vector<LayerUse>& PanoramaLines::use() {
  if (passes_ == 0) drape(0, 1);
  return use_;
}

const std::vector<std::vector<LabelAnchor>>& PanoramaLines::anchors() {
  if (passes_ == 0) drape(0, 1);
  return anchors_;
}

DrapedRun PanoramaLines::restore(const Kept& kept, const Run& run, double shift_px) const {
  DrapedRun out;
  out.feature = run.feature;
  out.is_hidden = run.is_hidden;
  out.distance_m = run.distance_m;
  const glm::dvec2 first = run.first_px + glm::dvec2(shift_px, 0);
  out.points_px.push_back(first);
  glm::dvec2 sum(0);
  for (std::size_t n = run.begin; n < run.begin + run.steps; ++n) {
    sum += glm::dvec2(kept.steps[n].x, kept.steps[n].y);
    out.points_px.push_back(first + sum / kParts);
  }
  return out;
}

void PanoramaLines::composite(const ImageRegion& region) {
  if (region.width <= 0 || region.height <= 0) return;
  // A square's items must all be there, even if the region has a part of it.
  const std::int64_t first_column = region.x / kSquare_px;
  const std::int64_t last_column = (region.x + region.width - 1) / kSquare_px;
  const auto left_px = static_cast<double>(first_column * kSquare_px);
  const auto right_px = static_cast<double>((last_column + 1) * kSquare_px);
  const double least_right_px = std::min(right_px, frame_.size_px.x);
  if (passes_ == 0 || left_px < window_.left_px || least_right_px > window_.right_px)
    drape(left_px, least_right_px);
  const std::int64_t first_row = region.y / kSquare_px;
  const std::int64_t columns = last_column - first_column + 1;
  const std::int64_t rows = (region.y + region.height - 1) / kSquare_px - first_row + 1;
  // What lies in each square: a layer, and the number of a run, or of a marker beyond all runs.
  struct Item {
    std::uint32_t layer;
    std::uint32_t number;
    double shift_px;
  };
  std::vector<std::vector<Item>> squares(static_cast<std::size_t>(columns * rows));
  const auto put = [&](glm::dvec2 low, glm::dvec2 high, const Item& item) {
    const auto square = [](double x) { return std::floor(x / static_cast<double>(kSquare_px)); };
    const auto part = [](double x, std::int64_t first, std::int64_t count) {
      return static_cast<std::int64_t>(
          std::clamp(x - static_cast<double>(first), -1.0, static_cast<double>(count)));
    };
    const std::int64_t x0 = std::max<std::int64_t>(0, part(square(low.x), first_column, columns));
    const std::int64_t x1 = std::min(columns - 1, part(square(high.x), first_column, columns));
    const std::int64_t y0 = std::max<std::int64_t>(0, part(square(low.y), first_row, rows));
    const std::int64_t y1 = std::min(rows - 1, part(square(high.y), first_row, rows));
    for (std::int64_t y = y0; y <= y1; ++y)
      for (std::int64_t x = x0; x <= x1; ++x)
        squares[static_cast<std::size_t>(y * columns + x)].push_back(item);
  };
  const auto put_all = [&](glm::dvec2 low, glm::dvec2 high, Item item) {
    for (const double turn : {0.0, -frame_.turn_px, frame_.turn_px}) {
      item.shift_px = turn;
      put(low + glm::dvec2(turn, 0), high + glm::dvec2(turn, 0), item);
      if (frame_.turn_px == 0) break;
    }
  };
  for (std::uint32_t k = 0; k < kept_.size(); ++k) {
    const Kept& kept = kept_[k];
    std::uint32_t number = 0;
    for (const Run& run : kept.runs) put_all(run.low_px, run.high_px, {k, number++, 0});
    for (const Marker& m : kept.markers)
      put_all(m.at_px - m.radius_px, m.at_px + m.radius_px, {k, number++, 0});
  }
  pool_.run(squares.size(), [&](std::size_t n) {
    if (squares[n].empty()) return;
    const auto number = static_cast<std::int64_t>(n);
    const std::int64_t x = (first_column + number % columns) * kSquare_px;
    const std::int64_t y = (first_row + number / columns) * kSquare_px;
    const glm::dvec2 corner(static_cast<double>(x), static_cast<double>(y));
    Canvas canvas(static_cast<int>(kSquare_px), static_cast<int>(kSquare_px));
    for (const Item& item : squares[n]) {
      const Kept& kept = kept_[item.layer];
      const GroundFeatures& features = *layers_[item.layer].features;
      if (item.number < kept.runs.size()) {
        const DrapedRun run = restore(kept, kept.runs[item.number], item.shift_px);
        painter(item.layer).run(canvas, run, features.style(run.feature), corner);
      } else {
        const Marker& m = kept.markers[item.number - kept.runs.size()];
        painter(item.layer)
            .marker(canvas, m.at_px + glm::dvec2(item.shift_px, 0) - corner, m.distance_m,
                    features.style(m.feature));
      }
    }
    const Layer drawn = canvas.layer();
    const std::int64_t left = std::max(x, region.x);
    const std::int64_t right = std::min(x + kSquare_px, region.x + region.width);
    const std::int64_t bottom = std::min(y + kSquare_px, region.y + region.height);
    for (std::int64_t row = std::max(y, region.y); row < bottom; ++row) {
      for (std::int64_t column = left; column < right; ++column) {
        const core::Rgba over = drawn.pixels[static_cast<std::size_t>((row - y) * kSquare_px + column - x)];
        if (over.a == 0) continue;
        base::Rgb& pixel =
            region.pixels[static_cast<std::size_t>((row - region.y) * region.width + column - region.x)];
        pixel = blend(over, pixel);
      }
    }
  });
}

}  // namespace vpe::overlay
