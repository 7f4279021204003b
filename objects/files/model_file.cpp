#include "objects/files/model_file.h"

#include <sys/wait.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "objects/files/child_process.h"
#include "objects/files/mesh_stream.h"
#include "vpe/base/file.h"

namespace objects {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kOperation = "read the model";
constexpr const char* kProgram = "vpe-model-reader";
constexpr const char* kVariable = "VPE_MODEL_READER";
constexpr std::string_view kDamagedAdvice = "the file may be damaged; export it again, or try another format";

std::string extension_of(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

void check_options(const ModelFileOptions& options) {
  if (!(options.unit_m > 0 && options.unit_m <= MeshLimits::kMostExtent_m))
    throw std::invalid_argument("the unit of a model must be above 0 and at most 1e9 m");
  if (!(options.memory_gb >= 0.25 && options.memory_gb <= 1024))
    throw std::invalid_argument("the memory of the reader of models must be 0.25 to 1024 GB");
  if (!(options.time_s >= 1 && options.time_s <= 1e6))
    throw std::invalid_argument("the time of the reader of models must be 1 to 1e6 s");
}

}  // namespace

bool is_model_path(const fs::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".gltf" || extension == ".glb" || extension == ".obj" || extension == ".ply" ||
         extension == ".stl";
}

std::string model_reader_program() { return child_program(kProgram, kVariable); }

std::vector<std::uint8_t> output_of_model_reader(const fs::path& path, const ModelFileOptions& options) {
  check_options(options);
  const auto fail = [&](std::string_view reason, std::string_view advice) {
    return vpe::base::file_error(kOperation, path, reason, advice);
  };
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (!fs::exists(status))
    throw fail(failure ? failure.message() : "there is no such file", "check the name and the permissions");
  if (!fs::is_regular_file(status))
    throw fail(fs::is_directory(status) ? "it is a folder" : "it is a device or pipe",
               "give the name of a file");
  const std::string program = model_reader_program();
  if (program.empty()) {
    const char* chosen = std::getenv(kVariable);
    if (chosen != nullptr && *chosen != '\0')
      throw fail("$VPE_MODEL_READER names the program '" + std::string(chosen) + "', which does not exist",
                 "correct or unset the variable");
    throw fail("this program was built without assimp, so vpe-model-reader is missing",
               "install libassimp-dev and build it again, or set VPE_MODEL_READER");
  }

  ChildOutput output;
  const char* up = options.up == UpAxis::kAuto ? "auto" : options.up == UpAxis::kY ? "y" : "z";
  try {
    // An absolute path cannot be taken for an option.
    std::vector<std::string> words{
        program, fs::absolute(path).string(),    number_text(options.unit_m),
        up,      number_text(options.memory_gb), number_text(std::floor(options.time_s))};
    if (options.allows_points) words.emplace_back("points");
    output = run_child(std::move(words), {}, static_cast<std::size_t>(options.memory_gb * 1e9));
  } catch (const std::system_error& error) {
    throw fail(error.what(), "check the permissions of the program and the limits of processes");
  }
  if (output.was_too_long)
    throw fail("it takes more than " + number_text(options.memory_gb) + " GB",
               "allow more memory or simplify the model");
  if (WIFSIGNALED(output.status)) {
    const int number = WTERMSIG(output.status);
    if (number == SIGXCPU)
      throw fail("the reader of models took more than " + number_text(options.time_s) + " s of processor time",
                 "the file may be damaged, or simplify the model");
    if (number == SIGALRM)
      throw fail("the reader of models waited too long for the disk",
                 "copy the model to a disk of this computer");
    throw fail("the reader of models ended by signal " + signal_text(number), kDamagedAdvice);
  }
  if (output.bytes.empty())
    throw fail("the reader of models ended with status " + std::to_string(WEXITSTATUS(output.status)) +
                   " and without a model",
               kDamagedAdvice);
  return std::move(output.bytes);
}

ModelFile read_model_file(const fs::path& path, const ModelFileOptions& options) {
  const auto fail = [&](std::string_view reason, std::string_view advice) {
    return vpe::base::file_error(kOperation, path, reason, advice);
  };
  std::error_code none;
  if (fs::is_regular_file(path, none) && !is_model_path(path))
    throw fail("its extension is not .gltf, .glb, .obj, .ply or .stl",
               "export the model in one of these formats");
  const std::vector<std::uint8_t> bytes = output_of_model_reader(path, options);
  MeshStream stream;
  try {
    stream = read_mesh_stream(bytes, options.allows_points);
  } catch (const std::runtime_error& error) {
    throw fail(error.what(), kDamagedAdvice);
  }
  if (!stream.error.empty()) throw fail(stream.error, stream.advice);
  return {std::move(stream.mesh), std::move(stream.notes)};
}

}  // namespace objects
