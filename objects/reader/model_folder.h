// The folder of a model, outside of which no file is opened.
//
// Typical usage:
//   const ModelFolder folder("models/rover.gltf");
//   const std::filesystem::path image = folder.find("textures/wheel.png", "texture");
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace objects {

class ModelFolder {
 public:
  static constexpr std::uintmax_t kMostBytes = std::uintmax_t{2} << 30;  // of a file

  // Takes the folder of the file that `model` leads to, through symbolic links. Throws Refusal if there is no such file.
  explicit ModelFolder(const std::filesystem::path& model);

  const std::filesystem::path& model() const { return model_; }

  // Returns the path, without links, of a file that a model names relative to its folder. `kind` says what it is, as in
  // "texture". Throws Refusal, with the name, for an absolute path, an address of the network, a path that leads out
  // of the folder (also through links), no regular file, and more than kMostBytes.
  std::filesystem::path find(const std::string& name, const std::string& kind) const;

  // Returns whether a path without links lies in the folder or below it.
  bool holds(const std::filesystem::path& canonical) const;

 private:
  std::filesystem::path model_;
  std::filesystem::path folder_;
};

// Throws Refusal for a name that is absolute or an address of the network.
void check_relative(const std::string& name, const std::string& kind);

}  // namespace objects
