// Stretches of a line that lie in the solid parts of a model, and those of a mesh.
//
// Typical usage:
//   const std::vector<SolidSpan> spans = mesh_spans(model.levels()[0], model.textures(), model.ball(), line);
//   for (const SolidSpan& s : spans) tell(line.at_m(s.begin), line.at_m(s.end));
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "objects/model/mesh_level.h"
#include "objects/model/texture_pyramid.h"

namespace objects {

// Describes a line in the model frame (objects/model/mesh.h), in double precision. t counts in lengths of its
// direction and may be negative.
struct ModelLine {
  glm::dvec3 origin_m{0, 0, 0};
  glm::dvec3 direction{0, 0, 1};  // of any length but 0

  glm::dvec3 at_m(double t) const { return origin_m + t * direction; }
};

// Holds a stretch of a line in a solid, in t of the line. A sheet without thickness begins and ends at one
// place.
struct SolidSpan {
  double begin = 0;
  double end = 0;  // not before begin
};

// Sorts spans, and joins those that overlap or are at most `touch` apart. Pure.
void join_spans(std::vector<SolidSpan>& spans, double touch);

// Gives the opacity, of 255, from which on a part of a model bounds a solid.
inline constexpr float kSolidOpacity = 127.5F;

// Bounds two rounding errors of mesh_spans(), relative to the largest distance of a vertex from the model's
// origin: how far beside the line a triangle may be that is met, and how far apart surfaces may be that are
// taken as touching.
inline constexpr double kMeshSpanError = 1e-6;

// Returns the stretches of a whole line in the solid parts of a mesh, ascending; between any two of them is
// air. `ball` must hold the mesh. A line enters a solid where the corners of a triangle run counter-clockwise
// seen against the line, and leaves it where they run clockwise. Solids of a mesh that overlap or touch are
// joined. Where a surface does not close around the line, entries and exits are paired as brackets are, and
// each one without a partner is a sheet; an open surface inside of a solid may so cut it. Both sides of a
// triangle count, whether they are drawn or not. Semi-transparent triangles count from kSolidOpacity on. Meets
// nothing if the line is not finite. Pure.
std::vector<SolidSpan> mesh_spans(const MeshLevel& level, const std::vector<TexturePyramid>& textures,
                                  const Ball& ball, const ModelLine& line);

}  // namespace objects
