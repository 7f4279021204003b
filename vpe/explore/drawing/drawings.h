// The drawings of a user: a list that is edited, with undo.
//
// All drawings are valid (problem_of() in drawing.h) and within DrawingLimits. An edit that would violate this
// changes nothing and returns the reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vpe/explore/drawing/drawing.h"
#include "vpe/explore/drawing/undo_steps.h"

namespace vpe::explore {

// Edits drawings. For one thread at a time; a shared drawing never changes, so any thread may read it.
//
// Typical usage:
//   Drawings drawings;
//   if (Drawings::Problem problem = drawings.add(drawing); !problem.empty()) show(problem);
//   const std::uint64_t id = drawings.all().back()->id;
//   problem = drawings.move_vertex(id, 2, place);
//   drawings.undo();
class Drawings : public UndoStore {
 public:
  static constexpr std::size_t kUndoBytes = std::size_t{64} << 20;  // of states kept for undo; oldest go first

  // Empty, or what is wrong with an edit and what to do.
  using Problem = std::string;
  using Shared = std::shared_ptr<const Drawing>;

  // Returns the drawings in their order. An edit replaces the pointers of the drawings that it changes.
  std::span<const Shared> all() const { return all_; }
  std::size_t size() const { return all_.size(); }
  // Returns a drawing, or null if there is none with this id.
  Shared find(std::uint64_t id) const;
  // Returns a number that changes whenever the drawings change.
  std::uint64_t revision() const { return revision_; }

  // Adds a drawing at the end under a new id. Without a name it is called "Line 3". Longitudes are brought to
  // (-180, 180].
  [[nodiscard]] Problem add(Drawing drawing);
  // Adds several as one step, for example those of a file. `what` names the edit for undo.
  [[nodiscard]] Problem add_all(std::vector<Drawing> drawings, const std::string& what);

  [[nodiscard]] Problem rename(std::uint64_t id, std::string name);
  [[nodiscard]] Problem recolour(std::uint64_t id, base::Rgb colour);
  [[nodiscard]] Problem show(std::uint64_t id, bool visible);
  // Inserts a vertex before the one at `index`; at the number of vertices, after the last.
  [[nodiscard]] Problem insert_vertex(std::uint64_t id, std::size_t index, mars::LonLat place);
  // Moves a vertex. `continues` joins the move with the previous move of the same vertex to one undo step, as
  // during one drag.
  [[nodiscard]] Problem move_vertex(std::uint64_t id, std::size_t index, mars::LonLat place,
                                    bool continues = false);
  [[nodiscard]] Problem remove_vertex(std::uint64_t id, std::size_t index);
  [[nodiscard]] Problem remove(std::uint64_t id);
  // Moves a drawing to a position of all(); later ones are drawn over earlier ones.
  [[nodiscard]] Problem reorder(std::uint64_t id, std::size_t position);

  // Replaces all drawings, without undo, as saved ones. Changes nothing and returns what is wrong if any is
  // bad.
  [[nodiscard]] Problem load(std::vector<Drawing> drawings);

  UndoState undo_state() const override { return steps_.state(); }
  std::string undo_text() const override { return steps_.undo_text(); }
  std::string redo_text() const override { return steps_.redo_text(); }
  bool undo() override;
  bool redo() override;
  void forget_redo() override { steps_.forget_redo(); }

  // Returns true if the drawings differ from those last loaded or marked as saved.
  bool is_changed() const { return all_ != saved_; }
  void mark_saved();
  void mark_unsaved();
  // Returns a number that changes whenever mark_saved() or mark_unsaved() is called.
  std::uint64_t saves() const { return saves_; }

 private:
  using List = std::vector<Shared>;
  template <class Edit>
  Problem edit(std::uint64_t id, const std::string& what, bool merges, Edit&& change);
  Problem take(std::vector<Drawing> drawings, List& into);
  Problem change(List next, std::string what, bool merges);
  std::string free_name(DrawingKind kind, const List& taken) const;

  List all_;
  List saved_;
  std::uint64_t revision_ = 1;
  std::uint64_t saves_ = 0;
  std::uint64_t last_id_ = 0;
  std::string drag_;  // of the vertex whose move may be continued
  UndoSteps<List> steps_{kUndoBytes};
};

}  // namespace vpe::explore
