#include "objects/posters/kiosk.h"

#include <cstdlib>
#include <glm/ext/matrix_transform.hpp>

#include "objects/model/shapes.h"

namespace objects {

namespace {

// Returns a sign: hills under a sky with a sun, in a frame. Whole numbers only, so it is the same everywhere.
Texture sign_texture() {
  constexpr int kSide = 64;
  constexpr int kFrame = 4;
  Texture t;
  t.width = kSide;
  t.height = kSide;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const bool is_frame = x < kFrame || y < kFrame || x >= kSide - kFrame || y >= kSide - kFrame;
      const int far_hill = 24 + std::abs(x - 42);
      const int near_hill = 32 + std::abs(x - 20) / 2;
      const bool is_sun = (x - 18) * (x - 18) + (y - 17) * (y - 17) <= 36;
      Rgba c{70, 150, 220, 255};
      if (is_sun) c = {255, 235, 150, 255};
      if (y >= far_hill) c = {190, 110, 60, 255};
      if (y >= near_hill) c = {120, 60, 35, 255};
      if (is_frame) c = {250, 250, 245, 255};
      t.texels.push_back(c);
    }
  }
  return t;
}

}  // namespace

Mesh make_kiosk() {
  constexpr float kBoard_m = 0.25F;  // half of a sign's side
  constexpr float kFoot_m = 0.5F;    // of the signs
  Mesh mesh;
  append(mesh, make_cylinder(0.03F, kFoot_m, 12), glm::mat4(1), {225, 225, 220, 255});
  append(mesh, make_box({2 * kBoard_m, 2 * kBoard_m, 2 * kBoard_m}),
         glm::translate(glm::mat4(1), {0, 0, kFoot_m}), {225, 225, 220, 255});
  mesh.uvs.assign(mesh.positions_m.size(), {0, 0});
  Material sign;
  sign.colour = {255, 255, 255, 255};
  sign.texture = 0;
  mesh.textures.push_back(sign_texture());
  mesh.material_table.push_back(sign);
  const auto material = static_cast<std::uint16_t>(mesh.material_table.size() - 1);
  constexpr float kOut_m = kBoard_m * 1.004F;
  for (int side = 0; side < 4; ++side) {
    const glm::vec3 outward(side == 0 ? 1 : side == 2 ? -1 : 0, side == 1 ? 1 : side == 3 ? -1 : 0, 0);
    const glm::vec3 right(-outward.y, outward.x, 0);
    const auto first = static_cast<std::uint32_t>(mesh.positions_m.size());
    for (int corner = 0; corner < 4; ++corner) {
      const float x = corner == 0 || corner == 3 ? -1.0F : 1.0F;
      const float z = corner < 2 ? 0.0F : 2 * kBoard_m;
      mesh.positions_m.push_back(kOut_m * outward + x * kBoard_m * right + glm::vec3(0, 0, kFoot_m + z));
      if (!mesh.normals.empty()) mesh.normals.push_back(outward);
      if (!mesh.colours.empty()) mesh.colours.push_back({255, 255, 255, 255});
      // A hair within the image: textures repeat.
      mesh.uvs.push_back({x < 0 ? 0.008F : 0.992F, z > 0 ? 0.008F : 0.992F});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
    mesh.materials.insert(mesh.materials.end(), 2, material);
  }
  return mesh;
}

}  // namespace objects
