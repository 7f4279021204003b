// A window on the screen with Dear ImGui in it: GLFW, an OpenGL context for panels and finished images, fonts
// for its pixel density. Images of ground come as pixels (painter.h): their OpenGL is elsewhere.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "vpe/core/image/image.h"

struct GLFWwindow;

namespace vpe::window {

// No window can be had. what() says why and what to do instead.
class DisplayError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct DisplayOptions {
  std::string title = "vpe";
  int width = 1280;  // of the window, screen coordinates
  int height = 720;
  bool scales_size = false;  // on a dense monitor the window is so much larger; else exactly of that size
  double scale = 0;          // of letters and panels; 0: as the monitor has it
  std::string instead;       // what to do without a display, for messages
};

// Throws DisplayError when there is no display, before any work is done for a window.
void check_display(const DisplayOptions& options);

// What happened, in the order in which it did. Keys and buttons have GLFW's numbers.
struct Event {
  enum class Kind : std::uint8_t {
    kKeyPress,
    kKeyRepeat,
    kKeyRelease,
    kPress,
    kRelease,
    kMove,
    kScroll,
    kDrop
  };
  Kind kind = Kind::kMove;
  int code = 0;  // key or button
  int modifiers = 0;
  double x = 0;  // cursor, framebuffer pixels
  double y = 0;
  double scroll = 0;
  double time_s = 0;  // since the library began
  std::vector<std::string> files;
};

// One at a time in a process, on the main thread.
class Display {
 public:
  explicit Display(const DisplayOptions& options);
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  GLFWwindow* handle() const { return window_; }
  double scale() const { return scale_; }
  void framebuffer(int& width, int& height) const;
  std::pair<int, int> size() const;  // of the window, in screen coordinates, when it does not fill the screen
  bool should_close() const;
  void close();
  void set_title(const std::string& title);
  void set_fullscreen(bool on);
  bool is_fullscreen() const { return is_fullscreen_; }

  // Waits for events for at most so long (0: does not wait), and gives what happened since the last call.
  std::vector<Event> events(double wait_s);
  // Ends a wait of events() from any thread.
  static void wake();

  // Around what ImGui is asked to draw. end_frame() shows it, and gives its pixels when asked to.
  void begin_frame();
  void end_frame(core::RgbImage* shown = nullptr);

  struct State;  // for the library's callbacks

 private:
  void choose_scale(double wanted);
  core::RgbImage read_back() const;

  std::unique_ptr<State> state_;
  GLFWwindow* window_ = nullptr;
  double scale_ = 1;
  bool is_fullscreen_ = false;
  int windowed_[4] = {0, 0, 1280, 720};  // place and size to go back to
};

// Pixels that ImGui can draw. Belongs to a display's context.
class Texture {
 public:
  Texture();
  ~Texture();
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;

  void upload(const core::RgbImage& image);
  int width() const { return width_; }
  int height() const { return height_; }
  void* id() const;  // ImTextureID

 private:
  unsigned name_ = 0;
  int width_ = 0;
  int height_ = 0;
};

}  // namespace vpe::window
