// Owners of OpenGL objects, and errors of OpenGL.
#pragma once

#include <string>
#include <utility>

#include "vpe/gl/opengl.h"

namespace vpe::gl {

// Owns an OpenGL object with a name, or none; movable, not copyable. Traits has create() and destroy(name). Objects must be
// made and destroyed while their context is current.
template <typename Traits>
class Object {
 public:
  Object() = default;
  // Makes an OpenGL object.
  static Object make() {
    Object object;
    object.name_ = Traits::create();
    return object;
  }
  Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Object() {
    if (name_ != 0) Traits::destroy(name_);
  }
  // Returns OpenGL's name of the object, or 0.
  GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  GLuint name_ = 0;
};

struct BufferTraits {
  static GLuint create();
  static void destroy(GLuint name);
};
struct VertexArrayTraits {
  static GLuint create();
  static void destroy(GLuint name);
};
struct Texture2DTraits {
  static GLuint create();
  static void destroy(GLuint name);
};
struct FramebufferTraits {
  static GLuint create();
  static void destroy(GLuint name);
};
struct RenderbufferTraits {
  static GLuint create();
  static void destroy(GLuint name);
};
struct ProgramTraits {
  static GLuint create();
  static void destroy(GLuint name);
};
using Buffer = Object<BufferTraits>;
using VertexArray = Object<VertexArrayTraits>;
using Texture2D = Object<Texture2DTraits>;
using Framebuffer = Object<FramebufferTraits>;
using Renderbuffer = Object<RenderbufferTraits>;
using Program = Object<ProgramTraits>;

// Owns a fence among the commands of the current context, or none; movable, not copyable. Must be destroyed while its context,
// or one that shares objects with it, is current.
class Fence {
 public:
  Fence() = default;
  // Makes a fence behind the commands so far, and sends them.
  static Fence make();
  Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
  Fence& operator=(Fence&& other) noexcept {
    std::swap(sync_, other.sync_);
    return *this;
  }
  ~Fence();
  // Waits until the commands before the fence have been executed. Without a fence does nothing.
  void wait() const;
  // Returns OpenGL's object, or null.
  GLsync sync() const { return sync_; }

 private:
  GLsync sync_ = nullptr;
};

// Compiles and links a program. geometry: null = no such stage. Throws std::runtime_error with the driver's
// log; `label` names the program in the message.
Program make_program(const std::string& label, const char* vertex, const char* fragment,
                     const char* geometry = nullptr);

// Throws std::runtime_error that names the operation if OpenGL has recorded an error.
void check_gl(const char* operation);

}  // namespace vpe::gl
