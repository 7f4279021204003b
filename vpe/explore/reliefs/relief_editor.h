// Editing of reliefs: add, move, change, order, delete, with undo.
//
// The reliefs can always be written and placed: each has all that its kind needs, within the limits, and names are unique. An
// edit that would violate this changes nothing and returns the reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "relief/spec.h"
#include "vpe/explore/drawing/edited_state.h"

namespace vpe::explore {

struct ReliefEditorLimits {
  static constexpr std::size_t kUndoBytes = std::size_t{16} << 20;  // kept for undo; oldest go first
};

struct ReliefItem {
  std::uint64_t id = 0;
  relief::ReliefSpec relief;
};
using SharedRelief = std::shared_ptr<const ReliefItem>;

// Returns the name of a relief in lists: its own, or that of its kind, "Crater".
std::string relief_title(const relief::ReliefSpec& relief);

// Edits the reliefs of one planet, none at first. For one thread at a time.
//
// Typical usage:
//   ReliefEditor editor(radius_m);
//   editor.load(relief::read_relief_file("works.relief.toml"));
//   if (std::string problem = editor.move(id, place); !problem.empty()) show(problem);
//   relief::write_relief_file(editor.reliefs(), "works.relief.toml");
class ReliefEditor : public EditedState<std::vector<SharedRelief>> {
 public:
  // Empty, or what is wrong with an edit.
  using Problem = std::string;
  using Items = std::vector<SharedRelief>;

  explicit ReliefEditor(double radius_m) : EditedState(ReliefEditorLimits::kUndoBytes), radius_m_(radius_m) {}

  // Replaces all reliefs, which count as saved. Ends all steps of undo. Ids of items are new ones. Returns what is wrong with
  // them on this planet, and changes nothing then.
  [[nodiscard]] Problem load(std::vector<relief::ReliefSpec> reliefs);
  // Returns the reliefs in the order in which they change the ground.
  std::vector<relief::ReliefSpec> reliefs() const;

  const Items& items() const { return state(); }
  // Returns null for an id that is not there.
  SharedRelief find(std::uint64_t id) const;
  // Returns the id of the item that was added last; 0 if none was.
  std::uint64_t newest() const { return newest_; }

  // Adds a relief after all others. One without a name gets one that no other has: "Crater 2".
  [[nodiscard]] Problem add(relief::ReliefSpec relief);
  // Moves a relief, and the corners of its polygon as far and in the same direction. `continues` joins the edit with the former
  // one of the same kind and item to one step of undo, as during one drag; so in replace().
  [[nodiscard]] Problem move(std::uint64_t id, mars::LonLat place, bool continues = false);
  // Replaces a relief. `what` names the edit: "deepen".
  [[nodiscard]] Problem replace(std::uint64_t id, relief::ReliefSpec relief, const std::string& what,
                                bool continues = false);
  // Makes a relief change the ground one place earlier or later. At the end of the list nothing changes.
  [[nodiscard]] Problem shift(std::uint64_t id, bool later);
  [[nodiscard]] Problem remove(std::uint64_t id);

 private:
  Problem problem_of(const relief::ReliefSpec& relief, std::uint64_t id) const;
  std::string free_name(const std::string& name) const;

  double radius_m_;
  std::uint64_t last_id_ = 0;
  std::uint64_t newest_ = 0;
};

}  // namespace vpe::explore
