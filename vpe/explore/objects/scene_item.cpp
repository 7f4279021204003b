#include "vpe/explore/objects/scene_item.h"

#include <algorithm>

namespace vpe::explore {

using objects::ObjectEntry;
using objects::PathEntry;
using objects::ScatterEntry;

namespace {

std::string model_name(const std::vector<objects::ModelEntry>& models, std::size_t model) {
  return model < models.size() ? models[model].name : "?";
}

}  // namespace

const std::string& item_name(const SceneItem& item) {
  return std::visit([](const auto& entry) -> const std::string& { return entry.name; }, item.entry);
}

const objects::Placing* single_placing(const SceneItem& item) {
  const auto* object = std::get_if<ObjectEntry>(&item.entry);
  return object != nullptr && object->places.size() == 1 ? &object->places.front() : nullptr;
}

std::string item_title(const SceneItem& item, const std::vector<objects::ModelEntry>& models) {
  const std::string& name = item_name(item);
  return name.empty() ? "(" + item_kind(item, models) + ")" : name;
}

std::string item_kind(const SceneItem& item, const std::vector<objects::ModelEntry>& models) {
  if (const auto* object = std::get_if<ObjectEntry>(&item.entry)) {
    const std::string model = model_name(models, object->model);
    return object->places.size() == 1 ? model : std::to_string(object->places.size()) + " of " + model;
  }
  if (const auto* path = std::get_if<PathEntry>(&item.entry))
    return "path of " + model_name(models, path->model);
  return "rocks";
}

std::string called(const SceneItem& item) {
  if (!item_name(item).empty()) return "'" + item_name(item) + "'";
  if (std::holds_alternative<ObjectEntry>(item.entry)) return "the object";
  return std::holds_alternative<PathEntry>(item.entry) ? "the path" : "the rocks";
}

TimeRange time_range(const std::vector<SharedItem>& items) {
  TimeRange range;
  for (const SharedItem& item : items) {
    const auto* path = std::get_if<PathEntry>(&item->entry);
    if (path == nullptr || path->points.empty()) continue;
    range.begin_s = std::min(range.begin_s, path->points.front().time_s);
    range.end_s = std::max(range.end_s, path->points.back().time_s);
  }
  return range;
}

}  // namespace vpe::explore
