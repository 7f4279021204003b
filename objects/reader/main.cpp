// vpe-model-reader FILE UNIT_M UP [MEMORY_GB TIME_S [points]]: writes the stream of a model
// (objects/files/mesh_stream.h) to standard output. With the word "points" a PLY of points without faces is a model,
// too. Ends with status 1 where the stream has an error in place of a mesh, and 2 for a wrong use. For an OpenVDB file
// it becomes vpe-vdb-reader, with its limits (objects/reader/vdb).

#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <string_view>

#include "objects/files/child_limits.h"
#include "objects/reader/assimp_reader.h"
#include "objects/reader/refusal.h"

namespace {

std::optional<objects::UpAxis> up_of(const std::string& word) {
  if (word == "auto") return objects::UpAxis::kAuto;
  if (word == "y") return objects::UpAxis::kY;
  if (word == "z") return objects::UpAxis::kZ;
  return {};
}

objects::MeshStream refused(const std::string& reason, const std::string& advice) {
  objects::MeshStream stream;
  stream.error = reason;
  stream.advice = advice;
  return stream;
}

bool is_vdb(std::string_view file) { return file.ends_with(".vdb") || file.ends_with(".VDB"); }

// Returns only where there is no such program.
void become_vdb_reader(char** words) {
  std::error_code none;
  const std::string program =
      std::filesystem::read_symlink("/proc/self/exe", none).replace_filename("vpe-vdb-reader").string();
  ::execv(program.c_str(), words);
}

objects::MeshStream read(const char* file, const objects::ModelFileOptions& options) {
  try {
    return objects::read_with_assimp(file, options);
  } catch (const objects::Refusal& refusal) {
    return refused(refusal.what(), refusal.advice());
  } catch (const std::bad_alloc&) {
    return refused("reading it takes too much memory, or it claims more than it has",
                   "allow more memory, simplify the model, or export it again");
  } catch (const std::exception& error) {
    return refused(error.what(), "the file may be damaged; export it again");
  }
}

}  // namespace

int main(int count, char** words) {
  objects::ModelFileOptions options;
  const auto up = count >= 4 ? up_of(words[3]) : std::nullopt;
  if (count >= 4) options.unit_m = objects::number_of(words[2]);
  if (count >= 6) {
    options.memory_gb = objects::number_of(words[4]);
    options.time_s = objects::number_of(words[5]);
  }
  options.allows_points = count == 7 && std::string_view(words[6]) == "points";
  if ((count != 4 && count != 6 && !options.allows_points) || !up || !(options.unit_m > 0) ||
      !(options.memory_gb > 0) || !(options.time_s >= 1 && options.time_s <= objects::kMostChildTime_s)) {
    std::fputs("usage: vpe-model-reader FILE UNIT_M auto|y|z [MEMORY_GB TIME_S [points]]\n", stderr);
    return 2;
  }
  options.up = *up;
  objects::limit_this_process(options.memory_gb, options.time_s);

  if (is_vdb(words[1])) become_vdb_reader(words);
  const objects::MeshStream stream = is_vdb(words[1]) ? refused("this program was built without OpenVDB",
                                                                "install libopenvdb-dev and build it again")
                                                      : read(words[1], options);
  bool is_sent = true;
  objects::write_mesh_stream(
      stream, [&](std::span<const std::uint8_t> bytes) { is_sent = is_sent && objects::send_output(bytes); });
  return stream.error.empty() && is_sent ? 0 : 1;
}
