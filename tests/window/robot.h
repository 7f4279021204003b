// A virtual screen, and a simulated user that moves the mouse and presses keys on it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vpe::window {

// Runs a virtual X server and sets `DISPLAY` to it during its lifetime.
class Screen {
 public:
  // Starts the server; why_not() is empty if it runs.
  Screen(int width, int height);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  const std::string& why_not() const { return why_not_; }

 private:
  int process_ = -1;
  std::string why_not_;
};

// Simulates input. Positions are in pixels of the whole screen.
class Robot {
 public:
  Robot();
  ~Robot();
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  void move(double x, double y);
  void move_by(int dx, int dy);  // as a mouse does, also where a cursor is held
  void press(int button = 1);
  void release(int button = 1);
  void wheel(int notches);                 // away from the hand
  void key_down(const std::string& name);  // X's names: "w", "F1", "space"
  void key_up(const std::string& name);
  void key(const std::string& name);
  void take_focus();  // from the window, as another program does

  // Returns the pixels of the cursor as the screen shows it, alpha in the highest byte, row by row.
  std::vector<std::uint32_t> cursor() const;

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace vpe::window
