// Imagery that is kept as layers too: one for each source, beside the image composed of all.
//
// Typical usage:
//   const auto image = stack_images_apart({{"viking", open_image("viking.tif")}, {"ctx", open_image("ctx.tif")}});
//   for (const ImageLayerSource& layer : *layers_of(image.get())) layer.source->sample(directions, texel_m, colours, alpha);
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mars/sources/source.h"

namespace mars {

struct NamedImage {
  std::string name;
  std::shared_ptr<const ImageSource> source;
};

// Holds a layer. Its source sets alpha to the share with which the layer covers what lies below it, 1 to 255, and to 0 where it
// has no data. The share falls towards the boundary of the data as the stack fades the source there; that of the lowest
// layer does not.
struct ImageLayerSource {
  std::string name;
  std::shared_ptr<const ImageSource> source;
  int info = 0;  // index of its first info among those of the composed image
};

// Optional interface of an image source that has layers.
class LayeredImage {
 public:
  virtual ~LayeredImage() = default;

  // Returns the layers, the coarsest first: each covers those before it.
  virtual const std::vector<ImageLayerSource>& layers() const = 0;
};

// Returns the layers of an image source, which may be null; null if it has none.
const std::vector<ImageLayerSource>* layers_of(const ImageSource* image);

// Stacks images as stack_images() does, and keeps each as a layer. The stack of one image gives the image itself. Throws
// SourceError as stack_images() does, and for a name that stands twice or is empty.
std::shared_ptr<const ImageSource> stack_images_apart(std::vector<NamedImage> images,
                                                      const StackOptions& options = {});

}  // namespace mars
