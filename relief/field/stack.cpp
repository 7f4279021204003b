#include "relief/field/stack.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "relief/field/interval_algebra.h"

namespace relief {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

Rect around(const Rect& a, const Rect& b) {
  return {std::min(a.x0_m, b.x0_m), std::min(a.y0_m, b.y0_m), std::max(a.x1_m, b.x1_m),
          std::max(a.y1_m, b.y1_m)};
}

// Where the layer can change the height below it.
Rect reach(const StackLayer& layer) {
  if (layer.compose == Compose::kSum) return layer.shape->support();
  if (layer.compose == Compose::kReplace) return layer.mask->support();
  return {-kInfinite, -kInfinite, kInfinite, kInfinite};  // the height below may be negative where s is 0
}

Interval shares(const Interval& mask) {
  return {std::clamp(mask.low, 0.0, 1.0), std::clamp(mask.high, 0.0, 1.0)};
}

}  // namespace

Stack::Stack(std::vector<StackLayer> layers) : layers_(std::move(layers)) {
  if (layers_.size() > kMaxStackLayers)
    throw std::invalid_argument("a stack of " + std::to_string(layers_.size()) + " shapes: at most " +
                                std::to_string(kMaxStackLayers) + " are allowed");
  std::vector<Rect> reaches;
  for (const StackLayer& layer : layers_) {
    const std::string name = "layer " + std::to_string(&layer - layers_.data() + 1) + " of a stack ";
    if (layer.shape == nullptr) throw std::invalid_argument(name + "has no shape");
    const bool needs_mask = layer.compose == Compose::kReplace;
    if (needs_mask && layer.mask == nullptr)
      throw std::invalid_argument(name + "replaces by a mask, but has none");
    if (!needs_mask && layer.mask != nullptr)
      throw std::invalid_argument(name + "has a mask, but only layers that replace may have one");
    const Rect rect = needs_mask ? layer.mask->support() : layer.shape->support();
    support_ = reaches.empty() ? rect : around(support_, rect);
    reaches.push_back(reach(layer));
  }
  reaches_ = RectBins(std::move(reaches));
}

double Stack::height_m(double x_m, double y_m) const {
  double height = 0;
  reaches_.visit(Rect{x_m, y_m, x_m, y_m}, [&](std::size_t n) {
    const StackLayer& layer = layers_[n];
    const double own = layer.shape->height_m(x_m, y_m);
    if (layer.compose == Compose::kSum) {
      height += own;
    } else if (layer.compose == Compose::kMax) {
      height = std::max(height, own);
    } else {
      const double share = std::clamp(layer.mask->height_m(x_m, y_m), 0.0, 1.0);
      height = (1 - share) * height + share * own;
    }
  });
  return height;
}

glm::dvec2 Stack::gradient(double x_m, double y_m) const {
  double height = 0;
  glm::dvec2 slope{0, 0};
  reaches_.visit(Rect{x_m, y_m, x_m, y_m}, [&](std::size_t n) {
    const StackLayer& layer = layers_[n];
    const double own = layer.shape->height_m(x_m, y_m);
    const glm::dvec2 own_slope = layer.shape->gradient(x_m, y_m);
    if (layer.compose == Compose::kSum) {
      height += own;
      slope += own_slope;
    } else if (layer.compose == Compose::kMax) {
      if (own > height) slope = own_slope;
      height = std::max(height, own);
    } else {
      const double mask = layer.mask->height_m(x_m, y_m);
      const double share = std::clamp(mask, 0.0, 1.0);
      const glm::dvec2 share_slope = share == mask ? layer.mask->gradient(x_m, y_m) : glm::dvec2(0, 0);
      slope = (1 - share) * slope + share * own_slope + (own - height) * share_slope;
      height = (1 - share) * height + share * own;
    }
  });
  return slope;
}

Interval Stack::bounds_m(const Rect& rect) const {
  Interval height{0, 0};
  double size = 0;  // of the numbers that were added, for their rounding
  reaches_.visit(rect, [&](std::size_t n) {
    const StackLayer& layer = layers_[n];
    const Interval own = layer.shape->bounds_m(rect);
    size += std::max(std::abs(own.low), std::abs(own.high));
    if (layer.compose == Compose::kSum) {
      height = sum(height, own);
    } else if (layer.compose == Compose::kMax) {
      height = {std::max(height.low, own.low), std::max(height.high, own.high)};
    } else {
      // A mean lies between its terms and moves with them and with the share: its extremes have extreme shares.
      const Interval share = shares(layer.mask->bounds_m(rect));
      const auto mean = [](double a, double b, double s) { return (1 - s) * a + s * b; };
      height = {std::min(mean(height.low, own.low, share.low), mean(height.low, own.low, share.high)),
                std::max(mean(height.high, own.high, share.low), mean(height.high, own.high, share.high))};
    }
  });
  return widened(height, 1e-15 * size);
}

}  // namespace relief
