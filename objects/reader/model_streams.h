// The files that assimp may open: those of the model's folder, for reading.
#pragma once

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#pragma GCC diagnostic pop

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "objects/reader/model_folder.h"
#include "objects/reader/refusal.h"

namespace objects {

// What assimp sees in place of the first bytes of the model's file.
struct Replacement {
  std::string head;                  // what comes in place of ...
  std::uint64_t replaced_bytes = 0;  // ... so many bytes
};

// Opens files for assimp. It swallows exceptions, so that refusals are kept here.
class ModelStreams : public Assimp::IOSystem {
 public:
  explicit ModelStreams(const ModelFolder& folder, std::optional<Replacement> model = {});

  bool Exists(const char* file) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  void Close(Assimp::IOStream* stream) override { delete stream; }

  const std::optional<Refusal>& refusal() const { return refusal_; }
  // Files beside the model that were opened, and those that do not exist.
  const std::vector<std::filesystem::path>& opened() const { return opened_; }
  const std::vector<std::string>& missing() const { return missing_; }

 private:
  std::optional<std::filesystem::path> allowed(const char* file) const;

  ModelFolder folder_;
  std::optional<Replacement> model_;
  mutable std::optional<Refusal> refusal_;
  std::vector<std::filesystem::path> opened_;
  std::vector<std::string> missing_;
};

}  // namespace objects
