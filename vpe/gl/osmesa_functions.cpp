// OpenGL functions that libOSMesa does not export.
//
// It has those of ARB_direct_state_access and ARB_clip_control, but only behind its own lookup, which knows
// them once there is a context.
#ifdef VPE_OSMESA

#include <stdexcept>
#include <string>

#include "vpe/gl/opengl.h"

namespace vpe::gl {
namespace {

template <typename Function>
Function look_up(const char* name) {
  const OSMESAproc found = OSMesaGetProcAddress(name);
  if (found == nullptr) throw std::runtime_error(std::string("OSMesa: this library lacks ") + name);
  return reinterpret_cast<Function>(found);
}

}  // namespace
}  // namespace vpe::gl

// NOLINTBEGIN(cppcoreguidelines-macro-usage): defines each function as OpenGL declares it
#define VPE_FORWARD(result, name, parameters, arguments)                            \
  result APIENTRY name parameters {                                                 \
    static const auto call = vpe::gl::look_up<result(APIENTRY*) parameters>(#name); \
    return call arguments;                                                          \
  }

extern "C" {
VPE_FORWARD(void, glBindTextureUnit, (GLuint unit, GLuint texture), (unit, texture))
VPE_FORWARD(void, glBlitNamedFramebuffer,
            (GLuint readFramebuffer, GLuint drawFramebuffer, GLint srcX0, GLint srcY0, GLint srcX1, GLint srcY1,
             GLint dstX0, GLint dstY0, GLint dstX1, GLint dstY1, GLbitfield mask, GLenum filter),
            (readFramebuffer, drawFramebuffer, srcX0, srcY0, srcX1, srcY1, dstX0, dstY0, dstX1, dstY1, mask,
             filter))
VPE_FORWARD(GLenum, glCheckNamedFramebufferStatus, (GLuint framebuffer, GLenum target), (framebuffer, target))
VPE_FORWARD(void, glClipControl, (GLenum origin, GLenum depth), (origin, depth))
VPE_FORWARD(void, glCreateBuffers, (GLsizei n, GLuint* buffers), (n, buffers))
VPE_FORWARD(void, glCreateFramebuffers, (GLsizei n, GLuint* framebuffers), (n, framebuffers))
VPE_FORWARD(void, glCreateRenderbuffers, (GLsizei n, GLuint* renderbuffers), (n, renderbuffers))
VPE_FORWARD(void, glCreateTextures, (GLenum target, GLsizei n, GLuint* textures), (target, n, textures))
VPE_FORWARD(void, glCreateVertexArrays, (GLsizei n, GLuint* arrays), (n, arrays))
VPE_FORWARD(void, glEnableVertexArrayAttrib, (GLuint vaobj, GLuint index), (vaobj, index))
VPE_FORWARD(void, glNamedBufferStorage, (GLuint buffer, GLsizeiptr size, const void* data, GLbitfield flags),
            (buffer, size, data, flags))
VPE_FORWARD(void, glNamedFramebufferRenderbuffer,
            (GLuint framebuffer, GLenum attachment, GLenum renderbuffertarget, GLuint renderbuffer),
            (framebuffer, attachment, renderbuffertarget, renderbuffer))
VPE_FORWARD(void, glNamedFramebufferTexture,
            (GLuint framebuffer, GLenum attachment, GLuint texture, GLint level),
            (framebuffer, attachment, texture, level))
VPE_FORWARD(void, glNamedRenderbufferStorage,
            (GLuint renderbuffer, GLenum internalformat, GLsizei width, GLsizei height),
            (renderbuffer, internalformat, width, height))
VPE_FORWARD(void, glNamedRenderbufferStorageMultisample,
            (GLuint renderbuffer, GLsizei samples, GLenum internalformat, GLsizei width, GLsizei height),
            (renderbuffer, samples, internalformat, width, height))
VPE_FORWARD(void, glTextureParameteri, (GLuint texture, GLenum pname, GLint param), (texture, pname, param))
VPE_FORWARD(void, glTextureStorage2D,
            (GLuint texture, GLsizei levels, GLenum internalformat, GLsizei width, GLsizei height),
            (texture, levels, internalformat, width, height))
VPE_FORWARD(void, glTextureSubImage2D,
            (GLuint texture, GLint level, GLint xoffset, GLint yoffset, GLsizei width, GLsizei height,
             GLenum format, GLenum type, const void* pixels),
            (texture, level, xoffset, yoffset, width, height, format, type, pixels))
VPE_FORWARD(void, glVertexArrayAttribBinding, (GLuint vaobj, GLuint attribindex, GLuint bindingindex),
            (vaobj, attribindex, bindingindex))
VPE_FORWARD(void, glVertexArrayAttribFormat,
            (GLuint vaobj, GLuint attribindex, GLint size, GLenum type, GLboolean normalized,
             GLuint relativeoffset),
            (vaobj, attribindex, size, type, normalized, relativeoffset))
VPE_FORWARD(void, glVertexArrayElementBuffer, (GLuint vaobj, GLuint buffer), (vaobj, buffer))
VPE_FORWARD(void, glVertexArrayVertexBuffer,
            (GLuint vaobj, GLuint bindingindex, GLuint buffer, GLintptr offset, GLsizei stride),
            (vaobj, bindingindex, buffer, offset, stride))
}
// NOLINTEND(cppcoreguidelines-macro-usage)

#undef VPE_FORWARD

#endif
