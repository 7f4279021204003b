// make_vdb KIND FILE: writes an OpenVDB file for tests. Kinds: fog (a box of density 0.5, 20 x 10 x 6 voxels of 0.25, y
// up), surface (a level set), whole (whole numbers), empty.
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <string>

int main(int count, char** words) {
  if (count != 3) return 2;
  openvdb::initialize();
  const std::string kind = words[1];
  openvdb::GridPtrVec grids;
  if (kind == "fog") {
    // A grid of another name comes first.
    const auto other = openvdb::FloatGrid::create(0);
    other->setName("temperature");
    other->tree().setValue({0, 0, 0}, 300);
    grids.push_back(other);
    const auto grid = openvdb::FloatGrid::create(0);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    grid->fill({{-4, 2, 0}, {15, 11, 5}}, 0.5F);
    grids.push_back(grid);
  } else if (kind == "surface") {
    grids.push_back(openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(2, {0, 0, 0}, 0.2F));
  } else if (kind == "whole") {
    const auto grid = openvdb::Int32Grid::create(0);
    grid->tree().setValue({0, 0, 0}, 3);
    grids.push_back(grid);
  } else if (kind == "empty") {
    const auto grid = openvdb::FloatGrid::create(0);
    grid->setName("density");
    grids.push_back(grid);
  } else {
    return 2;
  }
  openvdb::io::File(words[2]).write(grids);
  return 0;
}
