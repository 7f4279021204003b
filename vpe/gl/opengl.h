// OpenGL headers. No other file of this folder includes them.
//
// libepoxy looks each function up when it is called for the first time, so that a program that draws nothing
// opens no OpenGL library. OSMesa is linked directly, as libepoxy does not know its contexts.
#pragma once

#ifdef VPE_OSMESA
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>
#else
#include <epoxy/gl.h>
#endif
