#include "vpe/explore/layers/layer_rows.h"

#include <algorithm>
#include <stdexcept>

namespace vpe::explore {
namespace {

// Returns nothing for a value that is wrong.
template <class Item>
std::vector<Item> items_of(const std::string& setting, std::vector<Item> (*parse)(std::string_view)) {
  try {
    return parse(setting);
  } catch (const std::invalid_argument&) {
    return {};
  }
}

}  // namespace

std::string setting_of(const FileRows& rows) { return core::layer_list_text(items_on(rows)); }

FileRows rows_of(const FileRows& former, const std::string& setting) {
  if (setting_of(former) == setting) return former;
  return with_on(former, items_of(setting, core::parse_layer_list), &core::LayerFile::path);
}

std::string add_file(FileRows& rows, const std::string& path) {
  const std::vector<core::LayerFile> alone{{path, 1}};
  if (path.empty() || items_of(core::layer_list_text(alone), core::parse_layer_list) != alone) {
    return "'" + path +
           "' cannot be a layer: a path must not be empty, hold ';' or end with '@' and a number; rename the file";
  }
  const auto found = std::ranges::find_if(rows, [&](const auto& row) { return row.item.path == path; });
  if (found != rows.end())
    found->is_on = true;
  else
    rows.push_back({alone.front(), true});
  return {};
}

std::string setting_of(const ImageRows& rows) {
  std::vector<core::ImageLayerLook> on = items_on(rows);
  if (on.empty() && !rows.empty()) {
    on.push_back({});
    on.front().name = rows.front().item.name;
    on.front().opacity = 0;
  }
  return core::image_layers_text(on);
}

ImageRows rows_of(const ImageRows& former, const std::string& setting, std::span<const std::string> names) {
  const auto is_known = [&](const std::string& name) { return std::ranges::find(names, name) != names.end(); };
  const bool has_all = former.size() == names.size() &&
                       std::ranges::all_of(former, [&](const auto& row) { return is_known(row.item.name); });
  if (has_all && setting_of(former) == setting) return former;
  ImageRows all;
  for (const std::string& name : names) {
    const auto known = std::ranges::find_if(former, [&](const auto& row) { return row.item.name == name; });
    core::ImageLayerLook look;
    look.name = name;
    all.push_back({known != former.end() ? known->item : look, true});
  }
  if (setting.empty()) {
    for (auto& row : all) row.item = {row.item.name, 1, 0, 255, 1};
    return all;
  }
  // Known rows keep the order that the panel gave them.
  if (has_all) all = former;
  std::vector<core::ImageLayerLook> on = items_of(setting, core::parse_image_layers);
  std::erase_if(on, [&](const core::ImageLayerLook& look) { return !is_known(look.name); });
  return with_on(all, on, &core::ImageLayerLook::name);
}

}  // namespace vpe::explore
