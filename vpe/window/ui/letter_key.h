// Keys that mean a letter.
//
// GLFW would include OpenGL's own headers.
#pragma once

#ifndef GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_NONE
#endif
#include <GLFW/glfw3.h>

namespace vpe::window {

// Returns true if a key bears a letter, 'a' to 'z', on the user's keyboard. Keyboards that do not say it have the American
// layout.
inline bool is_letter_key(int code, char letter) {
  const char* name = glfwGetKeyName(code, 0);
  return name != nullptr ? name[0] == letter && name[1] == '\0' : code == GLFW_KEY_A + (letter - 'a');
}

}  // namespace vpe::window
