// vpe-vdb-reader FILE UNIT_M UP [MEMORY_GB TIME_S]: writes the volume of an OpenVDB file (objects/volumes/volume_file.h) to
// standard output, or, with status 1, a stream with an error (objects/files/mesh_stream.h). vpe-model-reader becomes this
// program for such files, after it has set the limits on memory and time: the library takes longer to load than most models
// take to read.

#include <cstdlib>
#include <new>
#include <span>
#include <string>

#include "objects/files/child_limits.h"
#include "objects/files/mesh_stream.h"
#include "objects/reader/refusal.h"
#include "objects/reader/vdb/vdb_reader.h"

namespace {

int refuse(const std::string& reason, const std::string& advice) {
  objects::MeshStream stream;
  stream.error = reason;
  stream.advice = advice;
  objects::write_mesh_stream(stream, [](std::span<const std::uint8_t> bytes) { objects::send_output(bytes); });
  return 1;
}

}  // namespace

int main(int count, char** words) {
  if (count < 4) return 2;
  objects::ModelFileOptions options;
  options.unit_m = std::strtod(words[2], nullptr);
  const std::string up = words[3];
  options.up = up == "z" ? objects::UpAxis::kZ : up == "y" ? objects::UpAxis::kY : objects::UpAxis::kAuto;
  if (!(options.unit_m > 0)) return 2;
  try {
    return objects::send_output(objects::read_with_openvdb(words[1], options)) ? 0 : 1;
  } catch (const objects::Refusal& refusal) {
    return refuse(refusal.what(), refusal.advice());
  } catch (const std::bad_alloc&) {
    return refuse("reading it takes too much memory, or it claims more than it has",
                  "allow more memory, or resample it to fewer voxels");
  } catch (const std::exception& error) {
    return refuse(error.what(), "the file may be damaged; export it again");
  }
}
