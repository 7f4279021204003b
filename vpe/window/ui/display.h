// A window on the screen with Dear ImGui: GLFW, an OpenGL context for panels and finished images, fonts for its
// pixel density. Images of terrain arrive as pixels or in textures (painter.h); this
// context does not draw them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "vpe/core/image/image.h"

struct GLFWcursor;
struct GLFWwindow;

namespace vpe::window {

// Thrown if no window can be opened. what() contains the reason and an alternative.
class DisplayError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct DisplayOptions {
  std::string title = "vpe";
  int width = 1280;  // of the window, screen coordinates
  int height = 720;
  bool scales_size = false;       // enlarge the window on a dense monitor
  double scale = 0;               // of text and panels; 0: the monitor's scale
  std::string instead;            // alternative to a window, for messages
  std::function<double()> clock;  // returns seconds and never goes back; empty: time since GLFW was initialised
};

// Throws DisplayError if there is no display. Call it before other work for a window.
void check_display(const DisplayOptions& options);

// Describes an event. Keys and buttons have GLFW's numbers.
struct Event {
  enum class Kind : std::uint8_t {
    kKeyPress,
    kKeyRepeat,
    kKeyRelease,
    kPress,
    kRelease,
    kMove,
    kScroll,
    kDrop,
    kFocusLost
  };
  Kind kind = Kind::kMove;
  int code = 0;  // key or button
  int modifiers = 0;
  double x = 0;  // cursor, framebuffer pixels
  double y = 0;
  double dx =
      0;  // motion of the cursor since the last kMove, framebuffer pixels; while it is caught, without end
  double dy = 0;
  double scroll = 0;
  double time_s = 0;  // by Display::now_s()
  std::vector<std::string> files;
};

// Owns the window. There is one at a time in a process, used by the main thread.
//
// Typical usage:
//   for (const Event& event : display.events(0.5)) handle(event);
//   display.begin_frame();
//   ImGui::Text("...");
//   display.end_frame();
class Display {
 public:
  explicit Display(const DisplayOptions& options);
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  GLFWwindow* handle() const { return window_; }
  // Returns the time of the clock of DisplayOptions, seconds.
  double now_s() const;
  double scale() const { return scale_; }
  // Returns the scale of DisplayOptions, or the monitor's.
  double usual_scale() const { return usual_scale_; }
  // Makes fonts and sizes for another scale, kSmallestScale to kLargestScale, between two frames. The same one again
  // costs nothing.
  void set_scale(double scale);
  void framebuffer(int& width, int& height) const;
  // Returns the window's size in screen coordinates, or its former size while it fills the screen.
  std::pair<int, int> size() const;
  bool should_close() const;
  void close();
  void set_title(const std::string& title);
  void set_fullscreen(bool on);
  bool is_fullscreen() const { return is_fullscreen_; }
  // Hides the cursor and holds it, so that only its motion counts (Event::dx, dy); unaccelerated, where the system can
  // say that. ImGui sees no mouse meanwhile. Off puts the cursor back to where it was.
  void catch_cursor(bool on);
  bool has_caught_cursor() const { return has_caught_cursor_; }
  // Shows a closed hand in place of the cursor that ImGui chooses.
  void show_hand(bool on);

  // Waits for events for at most `wait_s` seconds (0: does not wait). Returns the events since the last call.
  std::vector<Event> events(double wait_s);
  // Ends the waiting of events(). May be called from any thread.
  static void wake();

  // Begin and end a frame of ImGui. end_frame() shows the frame, and stores its pixels in `shown` unless that
  // is null.
  void begin_frame();
  void end_frame(core::RgbImage* shown = nullptr);
  // Returns true if ImGui has kept input for the next frame, so that another one is due.
  static bool has_input_left();

  static constexpr double kSmallestScale = 0.5;
  static constexpr double kLargestScale = 4;

  struct State;  // for the library's callbacks

 private:
  void make_fonts();
  core::RgbImage read_back() const;

  std::unique_ptr<State> state_;
  GLFWwindow* window_ = nullptr;
  double scale_ = 1;
  double usual_scale_ = 1;
  bool is_fullscreen_ = false;
  bool has_caught_cursor_ = false;
  bool shows_hand_ = false;
  GLFWcursor* hand_ = nullptr;           // once it was shown
  int hand_factor_ = 0;                  // of its size
  int windowed_[4] = {0, 0, 1280, 720};  // position and size outside of full screen
};

// Holds an image that ImGui can draw. Belongs to a display's OpenGL context.
class Texture {
 public:
  Texture();
  ~Texture();
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;

  void upload(const core::RgbImage& image);
  // Takes pixels of red, green, blue and opacity, row by row from the top.
  void upload_rgba(std::span<const std::uint8_t> pixels, int width, int height);
  // Says that another context has stored an image of this size in it (name()).
  void set_stored(int width, int height);
  // Returns the stored image.
  core::RgbImage read_back() const;
  int width() const { return width_; }
  int height() const { return height_; }
  void* id() const;                        // ImTextureID
  unsigned name() const { return name_; }  // OpenGL's

 private:
  void upload(unsigned format, const std::uint8_t* pixels, int width, int height);

  unsigned name_ = 0;
  unsigned format_ = 0;
  int width_ = 0;
  int height_ = 0;
};

}  // namespace vpe::window
