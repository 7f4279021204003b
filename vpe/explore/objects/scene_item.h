// The entries of a scene file as the window lists and edits them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "objects/files/scene_file.h"

namespace vpe::explore {

// Holds an entry of a scene file. The id stays the same while the entry is edited.
struct SceneItem {
  std::uint64_t id = 0;  // 0: none
  std::variant<objects::ObjectEntry, objects::PathEntry, objects::ScatterEntry> entry;
};

using SharedItem = std::shared_ptr<const SceneItem>;

// Returns the name of an entry, which may be "".
const std::string& item_name(const SceneItem& item);

// Returns the placing of an object with one place, which can be edited; null for all other items.
const objects::Placing* single_placing(const SceneItem& item);

// Returns how an item is called in a list: its name, or its model's in parentheses.
std::string item_title(const SceneItem& item, const std::vector<objects::ModelEntry>& models);

// Returns what an item is, for a list: "rover", "12 of rock", "path of rover", "rocks".
std::string item_kind(const SceneItem& item, const std::vector<objects::ModelEntry>& models);

// Returns how an item is called in the name of an edit: 'Rover', or "the object".
std::string called(const SceneItem& item);

struct TimeRange {
  double begin_s = 0;
  double end_s = 0;
};

// Returns the times from the first to the last point of all paths, and 0.
TimeRange time_range(const std::vector<SharedItem>& items);

}  // namespace vpe::explore
