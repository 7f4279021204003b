// Section 3.4.1 of Hitchner (1992): textures in place of triangles, measured here.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "paging/planet/planet_file.h"
#include "vpe/report/page.h"

namespace vpe::app {

struct TexturePaperView {
  std::string name;
  mars::Pose pose;
};

struct TexturePaperPlan {
  std::vector<TexturePaperView> views;  // more: steadier medians
  int width_px = 500;
  int height_px = 400;
  double fov_deg = 45;
  int rounds = 9;                                   // of each time. Larger: steadier medians
  std::size_t memory_bytes = std::size_t{1} << 30;  // for all renderers together
};

struct TexturePaper {
  report::Section section;
  std::vector<report::Table> tables;
};

// Draws each view with light of the vertices of all triangles (shading=vertex), and textured with all triangles and with 1/4,
// 1/16 and 1/64 of them. Compares the images with the textured one of all triangles, times them, and writes three of them
// into `folder`. All triangles are those of lod.tolerance=0.5 without occlusion culling. Without OpenGL, without imagery or
// without views the tables have no figures, and the section says why. Calls `step` before each image that is timed. Throws
// core::FileError, what renderers throw, and what `step` throws.
TexturePaper measure_texture_paper(const TexturePaperPlan& plan,
                                   const std::shared_ptr<const paging::PlanetFile>& planet,
                                   const std::filesystem::path& folder, const std::function<void()>& step);

// Returns how often measure_texture_paper() calls `step`.
int count_texture_steps(const TexturePaperPlan& plan);

}  // namespace vpe::app
