// Stacks: several shapes in one plane, composed from the lowest to the topmost.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "relief/field/rect_bins.h"
#include "relief/shape.h"

namespace relief {

// States what a layer does with the height h below it and its own height s.
enum class Compose : std::uint8_t {
  kSum,      // h + s
  kMax,      // the larger one
  kReplace,  // (1 - m) h + m s, with the value m of a mask
};

// Holds a shape and how it is composed. The mask is a shape whose values are shares from 0 to 1; values beyond count as
// the nearest of them. Only kReplace has one.
struct StackLayer {
  std::shared_ptr<const Shape> shape;
  Compose compose = Compose::kSum;
  std::shared_ptr<const Shape> mask;
};

inline constexpr std::size_t kMaxStackLayers = 65536;

// Composes shapes. The ground below the first layer is 0. A place costs as much as there are layers near it. Immutable.
class Stack : public Shape {
 public:
  // Throws std::invalid_argument if a shape is missing, a mask is missing or not asked for, or there are more than
  // kMaxStackLayers layers.
  explicit Stack(std::vector<StackLayer> layers);

  const std::vector<StackLayer>& layers() const { return layers_; }

  // Returns the smallest rectangle around the supports. Without layers it is a point.
  Rect support() const override { return support_; }
  double height_m(double x_m, double y_m) const override;
  glm::dvec2 gradient(double x_m, double y_m) const override;
  Interval bounds_m(const Rect& rect) const override;

 private:
  std::vector<StackLayer> layers_;
  RectBins reaches_;  // of the layers: outside of it a layer changes nothing
  Rect support_;
};

}  // namespace relief
