// Choices of users about the mouse.
#pragma once

namespace vpe::explore {

struct MouseChoices {
  double speed = 1;             // factor on rotation and tilt by a drag
  bool invert_wheel = false;    // rolling away zooms out
  bool throws = true;           // a drag that ends in motion goes on and dies off
  bool tilt_on_arrival = true;  // the wheel tilts a camera that it brings down from straight above
};

}  // namespace vpe::explore
