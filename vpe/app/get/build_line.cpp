#include "vpe/app/get/build_line.h"

#include <algorithm>

#include "vpe/app/cli/shell_word.h"

namespace vpe::app {

namespace {

// Returns the names by which `vpe build` opens a fetched file.
std::vector<std::string> raster_names(const RemoteFile& file, const std::filesystem::path& folder) {
  const std::string path = (folder / file.name).string();
  if (file.inside.empty()) return {path};
  std::vector<std::string> names;
  // GDAL: /vsizip/ and a relative path, or /vsizip// and an absolute one.
  for (const std::string& inner : file.inside) names.push_back("/vsizip/" + path + "/" + inner);
  return names;
}

std::string planet_name(const SelectedProduct& first) {
  return (first.choice.parameter.empty() ? first.product->name : first.choice.parameter) + ".vpe";
}

std::string line_for(const std::vector<const SelectedProduct*>& products, const std::filesystem::path& folder) {
  std::string elevation;
  std::string images;
  std::string datums;
  std::vector<std::string> kinds;  // the different datums
  for (const SelectedProduct* s : products) {
    for (const RemoteFile& file : s->files) {
      if (!file.is_input) continue;
      for (const std::string& name : raster_names(file, folder)) {
        (s->product->is_image ? images : elevation) +=
            (s->product->is_image ? " --image " : " ") + shell_word(name);
        if (!s->product->is_image) datums += " --datum " + shell_word(name + "=" + s->product->datum);
      }
    }
    if (!s->product->is_image && std::ranges::find(kinds, s->product->datum) == kinds.end())
      kinds.push_back(s->product->datum);
  }
  if (elevation.empty()) elevation = std::string(" ") + kNoElevation;
  if (kinds.size() == 1) datums = " --datum " + shell_word(kinds.front());
  return "vpe build" + elevation + images + datums + " --body " + products.front()->product->body + " -o " +
         shell_word(planet_name(*products.front()));
}

}  // namespace

std::vector<BuildLine> build_lines(const std::vector<SelectedProduct>& selected,
                                   const std::filesystem::path& folder) {
  std::vector<std::string> bodies;
  for (const SelectedProduct& s : selected) {
    if (std::ranges::find(bodies, s.product->body) == bodies.end()) bodies.push_back(s.product->body);
  }
  std::vector<BuildLine> lines;
  for (const std::string& body : bodies) {
    std::vector<const SelectedProduct*> products;
    for (const SelectedProduct& s : selected) {
      if (s.product->body == body) products.push_back(&s);
    }
    std::stable_partition(products.begin(), products.end(),
                          [](const SelectedProduct* s) { return !s->product->is_image; });
    lines.push_back({body, line_for(products, folder)});
  }
  return lines;
}

}  // namespace vpe::app
