#include "vpe/gl/objects.h"

#include <array>
#include <optional>
#include <stdexcept>
#include <vector>

namespace vpe::gl {

GLuint BufferTraits::create() {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  return name;
}
void BufferTraits::destroy(GLuint name) { glDeleteBuffers(1, &name); }

GLuint VertexArrayTraits::create() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return name;
}
void VertexArrayTraits::destroy(GLuint name) { glDeleteVertexArrays(1, &name); }

GLuint Texture2DTraits::create() {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  return name;
}
void Texture2DTraits::destroy(GLuint name) { glDeleteTextures(1, &name); }

GLuint FramebufferTraits::create() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return name;
}
void FramebufferTraits::destroy(GLuint name) { glDeleteFramebuffers(1, &name); }

GLuint RenderbufferTraits::create() {
  GLuint name = 0;
  glCreateRenderbuffers(1, &name);
  return name;
}
void RenderbufferTraits::destroy(GLuint name) { glDeleteRenderbuffers(1, &name); }

GLuint ProgramTraits::create() { return glCreateProgram(); }
void ProgramTraits::destroy(GLuint name) { glDeleteProgram(name); }

namespace {

class Shader {
 public:
  Shader(const std::string& label, GLenum stage, const char* source) : name_(glCreateShader(stage)) {
    glShaderSource(name_, 1, &source, nullptr);
    glCompileShader(name_);
    GLint ok = GL_FALSE;
    glGetShaderiv(name_, GL_COMPILE_STATUS, &ok);
    if (ok == GL_TRUE) return;
    GLint length = 0;
    glGetShaderiv(name_, GL_INFO_LOG_LENGTH, &length);
    std::vector<char> log(static_cast<std::size_t>(length) + 1);
    glGetShaderInfoLog(name_, length, nullptr, log.data());
    glDeleteShader(name_);
    throw std::runtime_error("OpenGL: cannot compile the " + label + " shader: " + log.data());
  }
  ~Shader() { glDeleteShader(name_); }
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;
  GLuint name() const { return name_; }

 private:
  GLuint name_;
};

}  // namespace

Program make_program(const std::string& label, const char* vertex, const char* fragment, const char* geometry) {
  const Shader vertex_shader(label + " vertex", GL_VERTEX_SHADER, vertex);
  const Shader fragment_shader(label + " fragment", GL_FRAGMENT_SHADER, fragment);
  std::optional<Shader> geometry_shader;
  Program program = Program::make();
  glAttachShader(program.name(), vertex_shader.name());
  glAttachShader(program.name(), fragment_shader.name());
  if (geometry != nullptr) {
    geometry_shader.emplace(label + " geometry", GL_GEOMETRY_SHADER, geometry);
    glAttachShader(program.name(), geometry_shader->name());
  }
  glLinkProgram(program.name());
  GLint ok = GL_FALSE;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &ok);
  if (ok != GL_TRUE) {
    std::array<char, 4096> log{};
    glGetProgramInfoLog(program.name(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error("OpenGL: cannot link the " + label + " program: " + log.data());
  }
  glDetachShader(program.name(), vertex_shader.name());
  glDetachShader(program.name(), fragment_shader.name());
  if (geometry_shader) glDetachShader(program.name(), geometry_shader->name());
  return program;
}

Fence Fence::make() {
  Fence fence;
  fence.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
  return fence;
}

void Fence::wait() const {
  if (sync_ == nullptr) return;
  constexpr GLuint64 kOneSecond_ns = 1'000'000'000;
  while (glClientWaitSync(sync_, 0, kOneSecond_ns) == GL_TIMEOUT_EXPIRED) {
  }
}

Fence::~Fence() {
  if (sync_ != nullptr) glDeleteSync(sync_);
}

void check_gl(const char* operation) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  const char* words = error == GL_OUT_OF_MEMORY       ? "out of memory"
                      : error == GL_INVALID_OPERATION ? "invalid operation"
                                                      : "error";
  throw std::runtime_error(std::string("OpenGL: ") + operation + ": " + words + " (" + std::to_string(error) +
                           ")");
}

}  // namespace vpe::gl
