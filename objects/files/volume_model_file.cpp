#include "objects/files/volume_model_file.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "objects/files/mesh_stream.h"
#include "objects/volumes/volume_file.h"
#include "vpe/base/file.h"

namespace objects {

namespace {

bool has_extension(const std::filesystem::path& path, std::string_view wanted) {
  const std::string extension = path.extension().string();
  return std::equal(extension.begin(), extension.end(), wanted.begin(), wanted.end(), [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  });
}

}  // namespace

bool is_volume_path(const std::filesystem::path& path) {
  return has_extension(path, ".volume") || has_extension(path, ".vdb");
}

VolumeModel read_volume_model(const std::filesystem::path& path, const ModelFileOptions& options) {
  if (!has_extension(path, ".vdb")) return read_volume_file(path);
  const std::vector<std::uint8_t> bytes = output_of_model_reader(path, options);
  if (is_volume_file(bytes)) return volume_of_bytes(bytes, path);
  MeshStream stream;
  try {
    stream = read_mesh_stream(bytes);
  } catch (const std::runtime_error& error) {
    stream.error = error.what();
    stream.advice = "the file may be damaged; export it again";
  }
  if (stream.error.empty()) stream.error = "the reader of models found no volume in it";
  throw vpe::base::file_error("read the model", path, stream.error, stream.advice);
}

}  // namespace objects
