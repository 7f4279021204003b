// The rows of vector files and of image layers as a panel shows them, and the settings that they make.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vpe/core/appearance/image_layers.h"
#include "vpe/core/appearance/layer_list.h"
#include "vpe/explore/layers/switched_list.h"

namespace vpe::explore {

using FileRows = SwitchedList<core::LayerFile>;
using ImageRows = SwitchedList<core::ImageLayerLook>;

// Returns the value of the setting overlay.layers that shows rows. Pure.
std::string setting_of(const FileRows& rows);

// Returns rows that show a value of overlay.layers: the former ones if they do, else those with what the value names on and all
// others off. Files that a wrong value names are left out. Pure.
FileRows rows_of(const FileRows& former, const std::string& setting);

// Adds a file above all others, and switches one on that is there. Returns "", or why the setting cannot hold its path. Pure.
std::string add_file(FileRows& rows, const std::string& path);

// Returns the value of the setting image.layers that shows rows. When all are off, it is the lowest row at opacity 0, because an
// empty value stands for the imagery as the planet was built. Pure.
std::string setting_of(const ImageRows& rows);

// Returns rows for the image layers that a planet has, the lowest first, by a value of image.layers: the former ones if they show
// it. An empty value gives all of them, on, in the planet's order. Layers that the value does not name are off; names that the
// planet does not have are left out. Pure.
ImageRows rows_of(const ImageRows& former, const std::string& setting, std::span<const std::string> names);

}  // namespace vpe::explore
