#include "objects/files/model_references.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include "objects/files/uri.h"
#include "vpe/base/file.h"

namespace objects {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 30;

// Collects files of a folder and below it.
class FoundFiles {
 public:
  explicit FoundFiles(const fs::path& model) : folder_(model.parent_path()) {}

  // Returns the path of a file that a model or its materials name; empty if there is none.
  fs::path add(const std::string& name) {
    const fs::path relative = fs::path(name).lexically_normal();
    if (name.empty() || relative.is_absolute() || *relative.begin() == "..") return {};
    const fs::path file = folder_ / relative;
    std::error_code none;
    if (!fs::is_regular_file(file, none)) return {};
    files_.insert(file);
    return file;
  }
  std::vector<fs::path> files() const { return {files_.begin(), files_.end()}; }

 private:
  fs::path folder_;
  std::set<fs::path> files_;
};

std::vector<std::uint8_t> bytes_of(const fs::path& file) {
  try {
    return vpe::base::read_file(file, kMostBytes);
  } catch (const std::runtime_error&) {
    return {};
  }
}

void add_of_gltf(const fs::path& model, FoundFiles& found) {
  const nlohmann::json document = nlohmann::json::parse(bytes_of(model), nullptr, false);
  if (!document.is_object()) return;
  for (const char* list : {"buffers", "images"}) {
    const auto entries = document.find(list);
    if (entries == document.end() || !entries->is_array()) continue;
    for (const nlohmann::json& entry : *entries) {
      const auto uri = entry.is_object() ? entry.find("uri") : entry.end();
      if (!entry.is_object() || uri == entry.end() || !uri->is_string()) continue;
      const std::string name = decoded_uri(uri->get<std::string>());
      if (!name.starts_with("data:")) found.add(name);
    }
  }
}

// Calls take(key, rest) for each line of words.
template <class Take>
void each_line(const std::vector<std::uint8_t>& bytes, const Take& take) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  constexpr std::string_view kBlanks = " \t\r";
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    const std::size_t blank = line.find_first_of(kBlanks);
    if (blank == std::string_view::npos) continue;
    std::string_view rest = line.substr(blank);
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
    rest = rest.substr(0, rest.find_last_not_of(kBlanks) + 1);
    take(line.substr(0, blank), rest);
  }
}

void add_of_obj(const fs::path& model, FoundFiles& found) {
  std::set<fs::path> materials;
  each_line(bytes_of(model), [&](std::string_view key, std::string_view rest) {
    if (key == "mtllib") materials.insert(found.add(std::string(rest)));
  });
  for (const fs::path& file : materials) {
    if (file.empty()) continue;
    each_line(bytes_of(file), [&](std::string_view key, std::string_view rest) {
      if (!key.starts_with("map_")) return;
      // Options stand before the name, which may have blanks.
      if (!found.add(std::string(rest)).empty()) return;
      const std::size_t blank = rest.find_last_of(" \t");
      if (blank != std::string_view::npos) found.add(std::string(rest.substr(blank + 1)));
    });
  }
}

}  // namespace

std::vector<fs::path> model_references(const fs::path& model) {
  std::string extension = model.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  FoundFiles found(model);
  if (extension == ".gltf") add_of_gltf(model, found);
  if (extension == ".obj") add_of_obj(model, found);
  return found.files();
}

}  // namespace objects
