// A screen that nobody sees, and hands that move its mouse and press its keys as a person would.
#pragma once

#include <memory>
#include <string>

namespace vpe::window {

// A virtual X server of its own. `DISPLAY` is set to it while it lives.
class Screen {
 public:
  // Empty `why` when it runs.
  Screen(int width, int height);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  const std::string& why_not() const { return why_not_; }

 private:
  int process_ = -1;
  std::string why_not_;
};

// Positions are of the whole screen.
class Robot {
 public:
  Robot();
  ~Robot();
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  void move(double x, double y);
  void press(int button = 1);
  void release(int button = 1);
  void wheel(int notches);                 // away from the hand
  void key_down(const std::string& name);  // X's names: "w", "F1", "space"
  void key_up(const std::string& name);
  void key(const std::string& name);

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace vpe::window
