#include "vpe/explore/drawing/drawings.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

namespace vpe::explore {

namespace {

std::string called(const Drawing& drawing) {
  return drawing.name.empty() ? "the " + std::string(to_string(drawing.kind)) : "'" + drawing.name + "'";
}

std::string vertex_of(std::size_t index, const Drawing& drawing) {
  return "vertex " + std::to_string(index + 1) + " of " + called(drawing);
}

std::string no_vertex(std::size_t index, const Drawing& drawing) {
  return "there is no " + vertex_of(index, drawing) + ": it has " + std::to_string(drawing.vertices.size());
}

mars::LonLat normal(mars::LonLat place) { return {mars::normalize_lon_deg(place.lon_deg), place.lat_deg}; }

// Counts what a former state holds alone.
std::size_t bytes_of(const std::vector<Drawings::Shared>& before, const std::vector<Drawings::Shared>& after) {
  std::size_t bytes = before.size() * sizeof(Drawings::Shared);
  const std::unordered_set<Drawings::Shared> kept(after.begin(), after.end());
  for (const Drawings::Shared& drawing : before) {
    if (!kept.contains(drawing))
      bytes += sizeof(Drawing) + drawing->name.size() + drawing->vertices.size() * sizeof(mars::LonLat);
  }
  return bytes;
}

}  // namespace

Drawings::Shared Drawings::find(std::uint64_t id) const {
  const auto found = std::find_if(all_.begin(), all_.end(), [id](const Shared& d) { return d->id == id; });
  return found == all_.end() ? nullptr : *found;
}

std::string Drawings::free_name(DrawingKind kind, const List& taken) const {
  std::string word(to_string(kind));
  word.front() = static_cast<char>(word.front() - 'a' + 'A');
  std::unordered_set<std::string> names;
  for (const Shared& drawing : taken) names.insert(drawing->name);
  for (std::size_t number = 1;; ++number) {
    std::string name = word + " " + std::to_string(number);
    if (!names.contains(name)) return name;
  }
}

// Appends checked drawings under new ids.
Drawings::Problem Drawings::take(std::vector<Drawing> drawings, List& into) {
  std::size_t vertices = 0;
  for (const Shared& drawing : into) vertices += drawing->vertices.size();
  for (Drawing& drawing : drawings) {
    if (Problem problem = problem_of(drawing); !problem.empty())
      return drawings.size() == 1 ? problem : called(drawing) + ": " + problem;
    vertices += drawing.vertices.size();
    if (into.size() >= DrawingLimits::kMostDrawings)
      return "there are at most " + std::to_string(DrawingLimits::kMostDrawings) +
             " drawings: delete some first";
    if (vertices > DrawingLimits::kMostVerticesOfAll)
      return "all drawings together have at most " + std::to_string(DrawingLimits::kMostVerticesOfAll) +
             " vertices: delete some first";
    for (mars::LonLat& place : drawing.vertices) place = normal(place);
    drawing.id = ++last_id_;
    if (drawing.name.empty()) drawing.name = free_name(drawing.kind, into);
    into.push_back(std::make_shared<const Drawing>(std::move(drawing)));
  }
  return "";
}

Drawings::Problem Drawings::change(List next, std::string what, bool merges) {
  drag_.clear();
  if (next == all_) return "";
  if (merges) {
    steps_.forget_redo();
    all_ = std::move(next);
  } else {
    const std::size_t bytes = bytes_of(all_, next);
    steps_.keep(std::exchange(all_, std::move(next)), bytes, std::move(what));
  }
  ++revision_;
  return "";
}

template <class Edit>
Drawings::Problem Drawings::edit(std::uint64_t id, const std::string& what, bool merges, Edit&& edit) {
  const auto found = std::find_if(all_.begin(), all_.end(), [id](const Shared& d) { return d->id == id; });
  if (found == all_.end()) return "the drawing is gone";
  Drawing drawing = **found;
  edit(drawing);
  if (same(drawing, **found)) return "";
  if (Problem problem = problem_of(drawing); !problem.empty()) return problem;
  List next = all_;
  next[static_cast<std::size_t>(found - all_.begin())] = std::make_shared<const Drawing>(std::move(drawing));
  return change(std::move(next), what, merges);
}

Drawings::Problem Drawings::add(Drawing drawing) {
  List next = all_;
  std::vector<Drawing> one;
  one.push_back(std::move(drawing));
  if (Problem problem = take(std::move(one), next); !problem.empty()) return problem;
  std::string what = "draw " + called(*next.back());
  return change(std::move(next), std::move(what), false);
}

Drawings::Problem Drawings::add_all(std::vector<Drawing> drawings, const std::string& what) {
  List next = all_;
  if (Problem problem = take(std::move(drawings), next); !problem.empty()) return problem;
  return change(std::move(next), what, false);
}

Drawings::Problem Drawings::load(std::vector<Drawing> drawings) {
  List next;
  if (Problem problem = take(std::move(drawings), next); !problem.empty()) return problem;
  all_ = std::move(next);
  steps_.clear();
  drag_.clear();
  ++revision_;
  mark_saved();
  return "";
}

Drawings::Problem Drawings::rename(std::uint64_t id, std::string name) {
  const Shared drawing = find(id);
  return edit(id, drawing ? "rename " + called(*drawing) : "", false,
              [&name](Drawing& d) { d.name = std::move(name); });
}

Drawings::Problem Drawings::recolour(std::uint64_t id, base::Rgb colour) {
  const Shared drawing = find(id);
  return edit(id, drawing ? "colour " + called(*drawing) : "", false,
              [colour](Drawing& d) { d.colour = colour; });
}

Drawings::Problem Drawings::show(std::uint64_t id, bool visible) {
  const Shared drawing = find(id);
  return edit(id, drawing ? (visible ? "show " : "hide ") + called(*drawing) : "", false,
              [visible](Drawing& d) { d.visible = visible; });
}

Drawings::Problem Drawings::insert_vertex(std::uint64_t id, std::size_t index, mars::LonLat place) {
  const Shared drawing = find(id);
  if (!drawing) return "the drawing is gone";
  if (index > drawing->vertices.size()) return no_vertex(index, *drawing);
  if (Problem problem = problem_of_place(place); !problem.empty()) return problem;
  std::size_t vertices = 1;
  for (const Shared& d : all_) vertices += d->vertices.size();
  if (vertices > DrawingLimits::kMostVerticesOfAll)
    return "all drawings together have at most " + std::to_string(DrawingLimits::kMostVerticesOfAll) +
           " vertices: delete some first";
  return edit(id, "insert " + vertex_of(index, *drawing), false, [&](Drawing& d) {
    d.vertices.insert(d.vertices.begin() + static_cast<std::ptrdiff_t>(index), normal(place));
  });
}

Drawings::Problem Drawings::move_vertex(std::uint64_t id, std::size_t index, mars::LonLat place,
                                        bool continues) {
  const Shared drawing = find(id);
  if (!drawing) return "the drawing is gone";
  if (index >= drawing->vertices.size()) return no_vertex(index, *drawing);
  if (Problem problem = problem_of_place(place); !problem.empty()) return problem;
  const std::string drag = std::to_string(id) + "/" + std::to_string(index);
  const bool merges = continues && drag_ == drag;
  const std::uint64_t before = revision_;
  Problem problem = edit(id, "move " + vertex_of(index, *drawing), merges,
                         [&](Drawing& d) { d.vertices[index] = normal(place); });
  if (revision_ != before || merges) drag_ = drag;
  return problem;
}

Drawings::Problem Drawings::remove_vertex(std::uint64_t id, std::size_t index) {
  const Shared drawing = find(id);
  if (!drawing) return "the drawing is gone";
  if (index >= drawing->vertices.size()) return no_vertex(index, *drawing);
  return edit(id, "delete " + vertex_of(index, *drawing), false, [index](Drawing& d) {
    d.vertices.erase(d.vertices.begin() + static_cast<std::ptrdiff_t>(index));
  });
}

Drawings::Problem Drawings::remove(std::uint64_t id) {
  const Shared drawing = find(id);
  if (!drawing) return "the drawing is gone";
  List next = all_;
  std::erase(next, drawing);
  return change(std::move(next), "delete " + called(*drawing), false);
}

Drawings::Problem Drawings::reorder(std::uint64_t id, std::size_t position) {
  const Shared drawing = find(id);
  if (!drawing) return "the drawing is gone";
  if (position >= all_.size())
    return "there is no position " + std::to_string(position + 1) + ": there are " +
           std::to_string(all_.size()) + " drawings";
  List next = all_;
  std::erase(next, drawing);
  next.insert(next.begin() + static_cast<std::ptrdiff_t>(position), drawing);
  return change(std::move(next), "reorder " + called(*drawing), false);
}

bool Drawings::undo() {
  if (!steps_.undo(all_)) return false;
  drag_.clear();
  ++revision_;
  return true;
}

bool Drawings::redo() {
  if (!steps_.redo(all_)) return false;
  drag_.clear();
  ++revision_;
  return true;
}

void Drawings::mark_saved() {
  saved_ = all_;
  ++saves_;
}

void Drawings::mark_unsaved() {
  saved_ = {nullptr};
  ++saves_;
}

}  // namespace vpe::explore
