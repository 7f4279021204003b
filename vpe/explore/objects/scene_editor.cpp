#include "vpe/explore/objects/scene_editor.h"

#include <algorithm>
#include <array>
#include <unordered_set>
#include <utility>

#include "objects/files/scene_limits.h"

namespace vpe::explore {

using objects::ModelEntry;
using objects::ObjectEntry;
using objects::PathEntry;
using objects::Placing;
using objects::ScatterEntry;

namespace {

std::string problem_of(const Placing& p) {
  struct Checked {
    const char* what;
    double value;
    const objects::NumberRange& range;
  };
  const std::array<Checked, 7> all{{{"longitude", p.place.lon_deg, objects::kLonRange_deg},
                                    {"latitude", p.place.lat_deg, objects::kLatRange_deg},
                                    {"height", p.height_m, objects::kHeightRange_m},
                                    {"heading", p.heading_deg, objects::kAngleRange_deg},
                                    {"pitch", p.pitch_deg, objects::kAngleRange_deg},
                                    {"roll", p.roll_deg, objects::kAngleRange_deg},
                                    {"scale", p.scale, objects::kScaleRange}}};
  for (const Checked& c : all)
    if (!objects::is_within(c.value, c.range))
      return std::string(c.what) + ": expected " + objects::range_text(c.range);
  return "";
}

std::size_t bytes_of(const SceneItem& item) {
  std::size_t bytes = sizeof item + item_name(item).size();
  if (const auto* object = std::get_if<ObjectEntry>(&item.entry))
    bytes += object->places.size() * sizeof(Placing);
  if (const auto* path = std::get_if<PathEntry>(&item.entry))
    bytes += path->points.size() * sizeof(objects::PathPoint);
  if (const auto* scatter = std::get_if<ScatterEntry>(&item.entry))
    bytes += scatter->polygon.size() * sizeof(mars::LonLat);
  return bytes;
}

// Returns what a list of items takes up beside them.
std::size_t sizes(const SceneEditor::Items& items) { return items.size() * sizeof(SharedItem); }

auto find_item(const SceneEditor::Items& items, std::uint64_t id) {
  return std::find_if(items.begin(), items.end(), [id](const SharedItem& item) { return item->id == id; });
}

// Returns the model of the scene that is this one, or the end. A model without a file is known by its name alone.
auto find_model(const SceneEditor::Models& models, const ModelEntry& model) {
  const auto is_same = [&model](const ModelEntry& m) {
    return m.file == model.file && m.unit_m == model.unit_m && m.up == model.up;
  };
  const auto exact = std::find_if(models.begin(), models.end(),
                                  [&](const ModelEntry& m) { return m.name == model.name && is_same(m); });
  if (exact != models.end() || model.file.empty()) return exact;
  return std::find_if(models.begin(), models.end(), is_same);
}

// Returns the name, or the name with a number that makes it free.
std::string free_among(const std::unordered_set<std::string>& taken, const std::string& name) {
  if (!taken.contains(name)) return name;
  for (std::size_t n = 2;; ++n) {
    std::string numbered = name + " " + std::to_string(n);
    if (!taken.contains(numbered)) return numbered;
  }
}

constexpr const char* kNoItem = "there is no such object";
constexpr const char* kNotSingle = "only an object with one place can be moved; edit the scene file for others";

}  // namespace

void SceneEditor::load(objects::SceneFile scene) {
  SceneState next;
  next.models = std::make_shared<const Models>(std::exchange(scene.models, {}));
  const auto take = [&](auto entries) {
    for (auto& entry : entries)
      next.items.push_back(std::make_shared<const SceneItem>(SceneItem{++last_id_, std::move(entry)}));
  };
  take(std::exchange(scene.objects, {}));
  take(std::exchange(scene.paths, {}));
  take(std::exchange(scene.scatters, {}));
  load_state(std::move(next));
  rest_ = std::move(scene);
  newest_ = 0;
}

objects::SceneFile SceneEditor::scene() const {
  objects::SceneFile scene = rest_;
  scene.models = models();
  for (const SharedItem& item : items()) {
    if (const auto* object = std::get_if<ObjectEntry>(&item->entry)) scene.objects.push_back(*object);
    if (const auto* path = std::get_if<PathEntry>(&item->entry)) scene.paths.push_back(*path);
    if (const auto* scatter = std::get_if<ScatterEntry>(&item->entry)) scene.scatters.push_back(*scatter);
  }
  return scene;
}

SharedItem SceneEditor::find(std::uint64_t id) const {
  const auto found = find_item(items(), id);
  return found == items().end() ? nullptr : *found;
}

std::size_t SceneEditor::instances() const {
  std::size_t sum = 0;
  for (const SharedItem& item : items()) {
    const auto* object = std::get_if<ObjectEntry>(&item->entry);
    sum += object != nullptr ? object->places.size() : std::holds_alternative<PathEntry>(item->entry) ? 1 : 0;
  }
  return sum;
}

std::string SceneEditor::free_name(const std::string& model) const {
  std::unordered_set<std::string> taken;
  for (const SharedItem& item : items()) taken.insert(item_name(*item));
  std::string name = model;
  if (name.front() >= 'a' && name.front() <= 'z') name.front() = static_cast<char>(name.front() - 'a' + 'A');
  return free_among(taken, name);
}

SceneEditor::Problem SceneEditor::add(const ModelEntry& model, const Placing& placing) {
  Placing placed = placing;
  placed.place.lon_deg = mars::normalize_lon_deg(placed.place.lon_deg);
  if (Problem problem = problem_of(placed); !problem.empty()) return problem;
  if (instances() >= objects::kMostInstances) return objects::too_many_instances();
  SceneState next = state();
  const auto known = find_model(models(), model);
  ObjectEntry object;
  object.model = static_cast<std::size_t>(known - models().begin());
  if (known == models().end()) {
    ModelEntry added = model;
    if (added.name.empty()) added.name = "model";
    if (Problem problem = objects::problem_of_name(added.name); !problem.empty()) return problem;
    std::unordered_set<std::string> taken;
    for (const ModelEntry& m : models()) taken.insert(m.name);
    added.name = free_among(taken, added.name);
    auto all = std::make_shared<Models>(models());
    all->push_back(std::move(added));
    next.models = std::move(all);
  }
  object.name = free_name((*next.models)[object.model].name);
  object.places.push_back(placed);
  const std::uint64_t id = ++last_id_;
  // After the last object.
  const auto end = std::find_if(next.items.begin(), next.items.end(), [](const SharedItem& item) {
    return !std::holds_alternative<ObjectEntry>(item->entry);
  });
  const std::string what = "place '" + object.name + "'";
  next.items.insert(end, std::make_shared<const SceneItem>(SceneItem{id, std::move(object)}));
  newest_ = id;
  edit(std::move(next), sizes(items()), what);
  return "";
}

SceneEditor::Problem SceneEditor::move(std::uint64_t id, mars::LonLat place, bool continues) {
  const SharedItem item = find(id);
  if (item == nullptr) return kNoItem;
  const Placing* old = single_placing(*item);
  if (old == nullptr) return kNotSingle;
  Placing placing = *old;
  placing.place = place;
  return replace(id, placing, "move", continues);
}

SceneEditor::Problem SceneEditor::replace(std::uint64_t id, const Placing& placing, const std::string& what,
                                          bool continues) {
  const SharedItem old = find(id);
  if (old == nullptr) return kNoItem;
  if (single_placing(*old) == nullptr) return kNotSingle;
  Placing placed = placing;
  placed.place.lon_deg = mars::normalize_lon_deg(placed.place.lon_deg);
  if (Problem problem = problem_of(placed); !problem.empty()) return problem;
  SceneItem item = *old;
  std::get<ObjectEntry>(item.entry).places.front() = placed;
  return put(std::move(item), what + " " + called(*old), continues);
}

SceneEditor::Problem SceneEditor::rename(std::uint64_t id, const std::string& name) {
  const SharedItem old = find(id);
  if (old == nullptr) return kNoItem;
  if (!name.empty()) {
    if (Problem problem = objects::problem_of_name(name); !problem.empty()) return "name: " + problem;
  }
  if (name == item_name(*old)) return "";
  SceneItem item = *old;
  std::visit([&](auto& entry) { entry.name = name; }, item.entry);
  return put(std::move(item), "rename " + called(*old), false);
}

SceneEditor::Problem SceneEditor::remove(std::uint64_t id) {
  const SharedItem old = find(id);
  if (old == nullptr) return kNoItem;
  SceneState next = state();
  next.items.erase(find_item(next.items, id));
  edit(std::move(next), bytes_of(*old) + sizes(items()), "delete " + called(*old));
  return "";
}

SceneEditor::Problem SceneEditor::put(SceneItem item, const std::string& what, bool continues) {
  SceneState next = state();
  const auto at = next.items.begin() + (find_item(next.items, item.id) - next.items.cbegin());
  const std::size_t bytes = bytes_of(**at);
  const std::string key = what + std::to_string(item.id);
  *at = std::make_shared<const SceneItem>(std::move(item));
  edit(std::move(next), bytes + sizes(items()), what, key, continues);
  return "";
}

}  // namespace vpe::explore
