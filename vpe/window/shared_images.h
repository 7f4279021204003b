// Images of triangles that stay in OpenGL: the painter draws them into textures that the window shows, without a copy through
// the CPU.
//
// Typical usage:
//   SharedImages shared(display, explore::DrawContextChoice::kAuto, has_gpu);
//   shared.place(request, is_recording);    // each request; at most one is under way
//   if (!shared.take(drawn)) texture.upload(drawn.image);
//   const Texture& shown = shared.shown() != nullptr ? *shared.shown() : texture;
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>

#include "vpe/explore/files/preferences.h"
#include "vpe/window/ui/display.h"
#include "vpe/window/workers/painter.h"

namespace vpe::window {

// Returns why an image has to be pixels, or "". `drawn` is the request as the painter draws it.
std::string why_pixels(const ImageRequest& drawn, bool is_recording);

// Owns a context that shares objects with the display's, and two textures: one is shown while the next image is drawn into
// the other. For the main thread, with the display's context current. Painters that use the context must end before.
class SharedImages {
 public:
  // Makes the context, unless the choice is against it. Where that fails there is none, and why_not() says why.
  SharedImages(const Display& display, explore::DrawContextChoice choice, bool has_gpu);
  ~SharedImages();
  SharedImages(const SharedImages&) = delete;
  SharedImages& operator=(const SharedImages&) = delete;

  // Returns why there is no context, or "".
  const std::string& why_not() const { return why_not_; }
  // Says in a request where it is drawn.
  void place(ImageRequest& request, const ImageRequest& drawn, bool is_recording);
  // Takes an image, before the next request, and shows it from now on. Returns false if it is pixels; then no texture of these is shown.
  bool take(const DrawnImage& drawn);
  // Returns the texture of the image that was taken last, or null.
  const Texture* shown() const;
  // Returns the bytes of both textures.
  std::size_t bytes() const;
  // Returns the number of images that were taken in textures.
  int count() const { return count_; }

 private:
  class HiddenWindow;

  std::unique_ptr<HiddenWindow> context_;  // null: there is none
  std::string why_not_;
  bool needs_gpu_ = false;
  std::array<Texture, 2> textures_;
  std::size_t next_ = 0;    // texture of the next image
  bool is_shown_ = false;   // the other one is
  void* unused_ = nullptr;  // GLsync of the last request
  int count_ = 0;
};

}  // namespace vpe::window
