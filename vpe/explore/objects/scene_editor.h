// Editing of a scene of objects: place, move, turn, rename, delete, with undo.
//
// The scene can always be written: every number is in its range, names can stand in a file, and each object has a model.
// An edit that would violate this changes nothing and returns the reason. Objects with one place are edited; lists of
// replicas, paths and scatters are kept as they were read, and can be renamed and deleted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "objects/files/scene_file.h"
#include "vpe/explore/drawing/edited_state.h"
#include "vpe/explore/objects/scene_item.h"

namespace vpe::explore {

struct SceneEditorLimits {
  static constexpr std::size_t kUndoBytes = std::size_t{64} << 20;  // kept for undo; oldest go first
};

// Holds what an editor changes of a scene.
struct SceneState {
  std::shared_ptr<const std::vector<objects::ModelEntry>> models;
  std::vector<SharedItem> items;
};

// Edits one scene, empty at first. For one thread at a time.
//
// Typical usage:
//   SceneEditor editor;
//   editor.load(objects::read_scene_file("gale.scene.toml"));
//   if (std::string problem = editor.move(id, place); !problem.empty()) show(problem);
//   objects::write_scene_file(editor.scene(), "gale.scene.toml");
class SceneEditor : public EditedState<SceneState> {
 public:
  // Empty, or what is wrong with an edit.
  using Problem = std::string;
  using Models = std::vector<objects::ModelEntry>;
  using Items = std::vector<SharedItem>;

  SceneEditor() : EditedState(SceneEditorLimits::kUndoBytes) { load({}); }

  // Replaces the scene, which counts as saved. Ends all steps of undo. Ids of items are new ones.
  void load(objects::SceneFile scene);
  // Returns the scene as edited: items in their order, and all else as it was loaded.
  objects::SceneFile scene() const;

  // Returns objects, then paths, then scatters, each in the order of the file.
  const Items& items() const { return state().items; }
  const Models& models() const { return *state().models; }
  // Returns null for an id that is not there.
  SharedItem find(std::uint64_t id) const;
  // Returns the id of the item that was added last; 0 if none was.
  std::uint64_t newest() const { return newest_; }

  // Adds an object of a model, which becomes one of the scene's models unless the same file with the same unit and axis is.
  // Gives it a name that no item has: "Rover 2".
  [[nodiscard]] Problem add(const objects::ModelEntry& model, const objects::Placing& placing);
  // Moves an object to another place; all else stays. `continues` joins the edit with the former one of the same kind and
  // item to one step of undo, as during one drag; so in replace().
  [[nodiscard]] Problem move(std::uint64_t id, mars::LonLat place, bool continues = false);
  // Replaces where and how an object stands. `what` names the edit: "turn".
  [[nodiscard]] Problem replace(std::uint64_t id, const objects::Placing& placing, const std::string& what,
                                bool continues = false);
  // Renames any item; "": it has no name.
  [[nodiscard]] Problem rename(std::uint64_t id, const std::string& name);
  // Deletes any item. Its model stays.
  [[nodiscard]] Problem remove(std::uint64_t id);

 private:
  Problem put(SceneItem item, const std::string& what, bool continues);
  std::string free_name(const std::string& model) const;  // expects a name
  std::size_t instances() const;

  objects::SceneFile rest_;  // without models, objects, paths and scatters
  std::uint64_t last_id_ = 0;
  std::uint64_t newest_ = 0;
};

}  // namespace vpe::explore
