#include "objects/files/level_program.h"

#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "objects/files/child_process.h"
#include "objects/files/level_stream.h"
#include "objects/files/mesh_stream.h"

namespace objects {

namespace {

// Returns the bytes of a mesh without its textures, which the program does not need.
std::vector<std::uint8_t> bytes_without_textures(Mesh& mesh) {
  std::vector<Texture> textures = std::exchange(mesh.textures, {});
  std::vector<Material> materials = mesh.material_table;
  for (Material& m : mesh.material_table) m.texture = -1;
  MeshStream stream;
  stream.mesh = std::move(mesh);
  std::vector<std::uint8_t> bytes;
  write_mesh_stream(stream, [&](std::span<const std::uint8_t> piece) {
    bytes.insert(bytes.end(), piece.begin(), piece.end());
  });
  mesh = std::move(stream.mesh);
  mesh.textures = std::move(textures);
  mesh.material_table = std::move(materials);
  return bytes;
}

}  // namespace

std::string model_levels_program() { return child_program("vpe-model-levels", "VPE_MODEL_LEVELS"); }

std::vector<MeshLevel> make_levels_apart(Mesh&& mesh, const LevelProgramOptions& options) {
  if (!(options.memory_gb >= 0.25 && options.memory_gb <= 1024))
    throw std::invalid_argument("the memory of the program that simplifies models must be 0.25 to 1024 GB");
  if (!(options.time_s >= 1 && options.time_s <= 1e6))
    throw std::invalid_argument("the time of the program that simplifies models must be 1 to 1e6 s");
  const std::string program = model_levels_program();
  if (program.empty()) throw std::runtime_error("the program vpe-model-levels is missing");
  ChildOutput output;
  try {
    output = run_child({program, number_text(options.memory_gb), number_text(std::floor(options.time_s))},
                       bytes_without_textures(mesh), static_cast<std::size_t>(options.memory_gb * 1e9));
  } catch (const std::system_error& error) {
    throw std::runtime_error(error.what());
  }
  if (output.was_too_long) throw std::runtime_error("its levels take too much memory");
  if (WIFSIGNALED(output.status)) {
    const int number = WTERMSIG(output.status);
    if (number == SIGXCPU || number == SIGALRM)
      throw std::runtime_error("to simplify it took more than " + number_text(options.time_s) + " s");
    throw std::runtime_error("vpe-model-levels ended by signal " + signal_text(number));
  }
  if (WEXITSTATUS(output.status) != 0)
    throw std::runtime_error("vpe-model-levels ended with status " +
                             std::to_string(WEXITSTATUS(output.status)) +
                             (WEXITSTATUS(output.status) == 1 ? ": it needs more memory than it may use" : ""));
  return read_level_stream(output.bytes, std::move(mesh));
}

}  // namespace objects
