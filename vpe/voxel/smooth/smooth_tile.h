// Smooth patches over the posts of a tile, in place of its flat facets.
//
// Stage of the pipeline (vpe/voxel/smooth/smooth_caster.h): SmoothGround keeps these tiles, and casts rays at them.
//
// A patch has the height of the posts at the corners of its cell. Between them heights are bilinear in the chart of the face
// (mars/geodesy/cube.h), or bicubic with the slopes of parabolas through three posts (Catmull-Rom patches, where posts are
// even). Heights and slopes at the border come from BorderRule, so that neighbours agree there at any levels. Heights are
// distances from the sphere along the vertical; an exaggeration multiplies them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "vpe/voxel/smooth/border_rule.h"
#include "vpe/voxel/smooth/smooth_patch.h"

namespace vpe::voxel {

// Holds the patches of one finest tile. Immutable; any thread may read it.
class SmoothTile {
 public:
  // Derives the border from `rule`. Throws paging::PlanetError if a tile beside it cannot be read.
  SmoothTile(const paging::SurfaceTile& posts, const BorderRule& rule, core::RayPatch patch, double radius_m);

  const lod::TileKey& key() const { return key_; }
  int intervals() const { return intervals_; }
  const std::vector<double>& u_lines() const { return lines_.u; }
  const std::vector<double>& v_lines() const { return lines_.v; }

  // Returns the patch of a cell, with heights above base_m() times the exaggeration.
  SmoothPatch patch(int i, int j, double exaggeration) const;
  double base_m() const { return base_m_; }

  // Returns bounds of the heights above the sphere, without exaggeration, of block (i, j) of 2^b x 2^b cells, 1 <= b <=
  // levels(); the largest is the tile.
  struct Bounds {
    float low_m = 0;
    float high_m = 0;
  };
  const Bounds& bounds(int b, int i, int j) const {
    const Level& level = blocks_[static_cast<std::size_t>(b - 1)];
    return level.blocks[static_cast<std::size_t>(j) * level.side + static_cast<std::size_t>(i)];
  }
  int levels() const { return static_cast<int>(blocks_.size()); }

  // Bounds the distance along the vertical between the patches and the reference surface over the tile, both
  // exaggerated. Adds facet_deviation_m() times the exaggeration, the sagitta of the facets (diagonal^2 / (8 R) on flat ground),
  // and by how much posts at the border of a coarser tile lie elsewhere. lod::TileTree::edge_shift_m() comes on top.
  double deviation_m(double exaggeration) const;

  // Bounds the distance between the patches and the flat triangles through their posts in the chart
  // (relief::Patch::facet_deviation_m).
  double facet_deviation_m() const { return facet_deviation_m_; }

  std::size_t bytes() const;

 private:
  struct Level {
    std::size_t side = 0;
    std::vector<Bounds> blocks;
  };
  // Slopes at a post of the border, for each unit of the chart.
  struct Slopes {
    float u = 0;
    float v = 0;
    float uv = 0;
  };
  // The share of the slope before a line, and of that behind it, in the slope at the line.
  struct Weights {
    double before = 0;
    double behind = 0;
  };

  double post(int i, int j) const {
    return static_cast<double>(posts_[static_cast<std::size_t>(j * (intervals_ + 1) + i)]);
  }
  void set_border(const BorderRule& rule, const paging::SurfaceTile& posts, double& shift_m);
  std::size_t border_place(int i, int j) const;
  Slopes slopes(int i, int j) const;
  PatchNode node(int i, int j, double du, double dv) const;
  void set_bounds();
  void set_sagitta(double radius_m);
  std::array<double, 16> bezier(int i, int j) const;

  lod::TileKey key_;
  int intervals_ = 0;
  bool is_bicubic_ = true;
  double base_m_ = 0;
  lod::GridLines lines_;
  std::vector<Weights> u_weights_;
  std::vector<Weights> v_weights_;
  std::vector<float> posts_;  // above base_m_
  std::vector<Slopes> border_;
  std::vector<Level> blocks_;
  double facet_deviation_m_ = 0;
  double post_shift_m_ = 0;
  // Of deviation_m(): the sagitta is bend (r / l^2 + 2 g / l + 2 g^2 / r) with the greatest slope g of a facet, the least
  // length l of a point of the cube, and r from the least to the greatest radius.
  double radius_m_ = 0;
  double bend_ = 0;
  double length_ = 1;
  double slope_ = 0;
};

}  // namespace vpe::voxel
