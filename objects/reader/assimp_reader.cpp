#include "objects/reader/assimp_reader.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#pragma GCC diagnostic pop

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "objects/reader/gltf_file.h"
#include "objects/reader/material_table.h"
#include "objects/reader/model_frame.h"
#include "objects/reader/model_streams.h"
#include "objects/reader/ply_check.h"
#include "objects/reader/ply_points.h"
#include "objects/reader/refusal.h"
#include "objects/reader/scene_flattener.h"
#include "vpe/base/quote.h"

namespace objects {

namespace {

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension.empty() ? extension : extension.substr(1);
}

ModelFormat format_of(const std::string& extension) {
  if (extension == "gltf" || extension == "glb") return ModelFormat::kGltf;
  if (extension == "obj") return ModelFormat::kObj;
  if (extension == "ply") return ModelFormat::kPly;
  if (extension == "stl") return ModelFormat::kStl;
  throw Refusal("its extension is not .gltf, .glb, .obj, .ply or .stl",
                "export the model in one of these formats");
}

bool has_y_up(ModelFormat format, UpAxis up) {
  return up == UpAxis::kY ||
         (up == UpAxis::kAuto && (format == ModelFormat::kGltf || format == ModelFormat::kObj));
}

// Keeps warnings that data were lost.
class LossStream : public Assimp::LogStream {
 public:
  explicit LossStream(std::set<std::string>& lines) : lines_(lines) {}
  void write(const char* message) override {
    std::string line(message);
    if (line.find("dropped") == std::string::npos && line.find("out of range") == std::string::npos) return;
    if (const std::size_t colon = line.find(": "); colon != std::string::npos) line = line.substr(colon + 2);
    while (!line.empty() && line.back() == '\n') line.pop_back();
    if (lines_.size() < 10) lines_.insert(line);
  }

 private:
  std::set<std::string>& lines_;
};

// Leaves one importer: content that looks like another format is not tried.
void keep_importer(Assimp::Importer& importer, const std::string& extension) {
  const std::string name = extension == "glb" ? "gltf" : extension;
  std::vector<Assimp::BaseImporter*> others;
  std::size_t kept = 0;
  for (std::size_t n = 0; n < importer.GetImporterCount(); ++n) {
    const std::string title = importer.GetImporterInfo(n)->mName;
    std::istringstream extensions(importer.GetImporterInfo(n)->mFileExtensions);
    bool is_wanted = false;
    for (std::string word; extensions >> word;) is_wanted = is_wanted || word == name;
    // Two importers read glTF, of versions 1 and 2.
    if (is_wanted && (name != "gltf" || title.find("glTF2") != std::string::npos))
      ++kept;
    else
      others.push_back(importer.GetImporter(n));
  }
  if (kept == 0) throw Refusal("this assimp does not read ." + extension, "install an assimp with that format");
  for (Assimp::BaseImporter* other : others) importer.UnregisterLoader(other);
}

// One line, without the library's name of the file.
std::string shown(const std::string& words) {
  std::string line;
  for (const char c : words.substr(0, 300)) line += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  return line;
}

}  // namespace

MeshStream read_with_assimp(const std::filesystem::path& path, const ModelFileOptions& options) {
  const std::string extension = extension_of(path);
  const ModelFormat format = format_of(extension);
  const ModelFolder folder(path);
  if (extension_of(folder.model()) != extension)
    throw Refusal("it is a link to a file with another extension", "name the file itself");
  MeshStream result;
  std::optional<Replacement> replacement;
  std::vector<GltfTextureUse> uses;
  if (format == ModelFormat::kGltf) {
    GltfFile gltf = prepare_gltf(folder);
    replacement = std::move(gltf.replacement);
    uses = std::move(gltf.materials);
    result.notes = std::move(gltf.notes);
  }
  if (format == ModelFormat::kPly) {
    if (std::optional<MeshStream> points = read_ply_points(folder.model(), options)) return std::move(*points);
    check_ply(folder.model());
  }

  std::set<std::string> losses;
  Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
  Assimp::DefaultLogger::get()->attachStream(new LossStream(losses), Assimp::Logger::Warn);
  Assimp::Importer importer;
  keep_importer(importer, extension);
  auto* streams = new ModelStreams(folder, std::move(replacement));
  importer.SetIOHandler(streams);  // takes it
  const aiScene* scene = importer.ReadFile(folder.model().string(), 0);
  if (streams->refusal()) throw Refusal(*streams->refusal());
  if (scene == nullptr) throw Refusal("assimp says: " + shown(importer.GetErrorString()));
  if (scene->mNumMeshes == 0) throw Refusal("it has no triangle");
  check_indices(*scene);
  scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (scene == nullptr) throw Refusal("assimp says: " + shown(importer.GetErrorString()));

  MaterialTable materials(*scene, format, folder, uses, streams->opened());
  result.mesh = flatten(*scene, model_frame(has_y_up(format, options.up), options.unit_m), format, materials,
                        result.notes);
  materials.note_ignored(result.notes);
  if (format == ModelFormat::kObj && streams->opened().empty()) {
    for (const std::string& name : streams->missing())
      result.notes.push_back("the file of materials " + vpe::base::quote_text(name) + " does not exist");
  }
  for (const std::string& loss : losses) result.notes.push_back("assimp says: " + shown(loss));
  importer.FreeScene();
  if (const std::string reason = check(result.mesh); !reason.empty()) throw Refusal(reason);
  return result;
}

}  // namespace objects
