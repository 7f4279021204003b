#include "vpe/core/appearance/layer_list.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "vpe/base/number.h"

namespace vpe::core {
namespace {

LayerFile parse_layer_file(std::string_view text) {
  LayerFile file{std::string(text), 1};
  const std::size_t at = text.rfind('@');
  const auto opacity = at == std::string_view::npos ? std::nullopt : base::parse_number(text.substr(at + 1));
  if (opacity) {
    if (!(*opacity >= 0 && *opacity <= 1))
      throw std::invalid_argument("the opacity in '" + std::string(text) + "' must lie within 0 to 1");
    file = {std::string(text.substr(0, at)), *opacity};
  }
  if (file.path.empty())
    throw std::invalid_argument("a path is empty; expected FILE or FILE@OPACITY, with ';' between them");
  return file;
}

}  // namespace

std::vector<LayerFile> parse_layer_list(std::string_view text) {
  std::vector<LayerFile> files;
  while (!text.empty()) {
    const std::size_t end = text.find(';');
    files.push_back(parse_layer_file(text.substr(0, end)));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
    if (text.empty()) throw std::invalid_argument("a path is empty: leave out the ';' at the end");
  }
  return files;
}

std::string layer_list_text(const std::vector<LayerFile>& files) {
  std::string text;
  for (const LayerFile& file : files) {
    text += (text.empty() ? "" : ";") + file.path;
    if (file.opacity != 1) text += "@" + base::format_number(file.opacity);
  }
  return text;
}

std::string layers_problem(const std::string& text) {
  try {
    for (const LayerFile& file : parse_layer_list(text)) {
      std::error_code error;
      if (std::filesystem::is_directory(file.path, error)) return "'" + file.path + "' is a folder";
      if (::access(file.path.c_str(), R_OK) != 0)
        return "'" + file.path + "' cannot be read: " + std::strerror(errno);
    }
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return {};
}

}  // namespace vpe::core
