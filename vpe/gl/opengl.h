// The one place that names the OpenGL headers.
//
// libepoxy finds each function when it is called for the first time: a program that draws nothing opens no
// OpenGL library. OSMesa is linked outright, as libepoxy does not know its contexts.
#pragma once

#ifdef VPE_OSMESA
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>
#else
#include <epoxy/gl.h>
#endif
