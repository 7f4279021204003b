#include "vpe/explore/reliefs/relief_editor.h"

#include <algorithm>
#include <exception>
#include <set>
#include <utility>

#include "relief/placed.h"
#include "relief/relief.h"

namespace vpe::explore {

using relief::ReliefSpec;

namespace {

constexpr const char* kNoRelief = "there is no such relief";
constexpr const char* kNameIsTaken = "name: another relief has it";

auto find_relief(const ReliefEditor::Items& items, std::uint64_t id) {
  return std::find_if(items.begin(), items.end(), [id](const SharedRelief& item) { return item->id == id; });
}

std::size_t relief_bytes(const ReliefItem& item) {
  return sizeof item + item.relief.name.size() + item.relief.polygon.size() * sizeof(mars::LonLat);
}

// Returns what a list of items takes up beside them.
std::size_t list_bytes(const ReliefEditor::Items& items) { return items.size() * sizeof(SharedRelief); }

std::string quoted_title(const ReliefSpec& relief) { return "'" + relief_title(relief) + "'"; }

// Returns what is wrong with a relief on a sphere, or "".
std::string relief_problem(const ReliefSpec& relief, double radius_m) {
  if (std::string problem = relief::problem_of(relief); !problem.empty()) return problem;
  try {
    const relief::PlacedRelief placed(relief, radius_m);
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

}  // namespace

std::string relief_title(const ReliefSpec& relief) {
  if (!relief.name.empty()) return relief.name;
  std::string word(relief::kind_word(relief.kind));
  word.front() = static_cast<char>(word.front() - 'a' + 'A');
  return word;
}

ReliefEditor::Problem ReliefEditor::load(std::vector<ReliefSpec> reliefs) {
  if (reliefs.size() > relief::kMostReliefs)
    return "expected at most " + std::to_string(relief::kMostReliefs) + " reliefs";
  Items items;
  std::set<std::string> names;
  for (ReliefSpec& relief : reliefs) {
    Problem problem = relief_problem(relief, radius_m_);
    if (problem.empty() && !relief.name.empty() && !names.insert(relief.name).second) problem = kNameIsTaken;
    if (!problem.empty()) return relief::relief_title(relief, items.size() + 1) + ": " + problem;
    items.push_back(std::make_shared<const ReliefItem>(ReliefItem{++last_id_, std::move(relief)}));
  }
  load_state(std::move(items));
  newest_ = 0;
  return "";
}

std::vector<ReliefSpec> ReliefEditor::reliefs() const {
  std::vector<ReliefSpec> all;
  all.reserve(items().size());
  for (const SharedRelief& item : items()) all.push_back(item->relief);
  return all;
}

SharedRelief ReliefEditor::find(std::uint64_t id) const {
  const auto found = find_relief(items(), id);
  return found == items().end() ? nullptr : *found;
}

std::string ReliefEditor::free_name(const std::string& name) const {
  const auto is_taken = [this](const std::string& text) {
    return std::ranges::any_of(items(), [&](const SharedRelief& item) { return item->relief.name == text; });
  };
  if (!is_taken(name)) return name;
  for (std::size_t n = 2;; ++n) {
    std::string numbered = name + " " + std::to_string(n);
    if (!is_taken(numbered)) return numbered;
  }
}

// Returns what is wrong with a relief that takes the place of the one with this id, if there is one.
ReliefEditor::Problem ReliefEditor::problem_of(const ReliefSpec& relief, std::uint64_t id) const {
  if (Problem problem = relief_problem(relief, radius_m_); !problem.empty()) return problem;
  const bool is_taken = !relief.name.empty() && std::ranges::any_of(items(), [&](const SharedRelief& item) {
    return item->id != id && item->relief.name == relief.name;
  });
  return is_taken ? kNameIsTaken : "";
}

ReliefEditor::Problem ReliefEditor::add(ReliefSpec relief) {
  if (items().size() >= relief::kMostReliefs)
    return "expected at most " + std::to_string(relief::kMostReliefs) + " reliefs";
  if (relief.name.empty()) relief.name = free_name(relief_title(relief));
  relief.place.lon_deg = mars::normalize_lon_deg(relief.place.lon_deg);
  if (Problem problem = problem_of(relief, 0); !problem.empty()) return problem;
  const std::string what = "add " + quoted_title(relief);
  Items next = items();
  next.push_back(std::make_shared<const ReliefItem>(ReliefItem{++last_id_, std::move(relief)}));
  newest_ = last_id_;
  const std::size_t bytes = list_bytes(next);
  edit(std::move(next), bytes, what);
  return "";
}

ReliefEditor::Problem ReliefEditor::move(std::uint64_t id, mars::LonLat place, bool continues) {
  const SharedRelief item = find(id);
  if (item == nullptr) return kNoRelief;
  ReliefSpec relief = item->relief;
  for (mars::LonLat& corner : relief.polygon) {
    const double bearing_deg = mars::initial_bearing_deg(relief.place, corner);
    corner = mars::destination(place, bearing_deg, mars::distance_rad(relief.place, corner));
  }
  relief.place = place;
  return replace(id, std::move(relief), "move", continues);
}

ReliefEditor::Problem ReliefEditor::replace(std::uint64_t id, ReliefSpec relief, const std::string& what,
                                            bool continues) {
  const SharedRelief old = find(id);
  if (old == nullptr) return kNoRelief;
  relief.place.lon_deg = mars::normalize_lon_deg(relief.place.lon_deg);
  if (relief == old->relief) return "";
  if (Problem problem = problem_of(relief, id); !problem.empty()) return problem;
  Items next = items();
  next[static_cast<std::size_t>(find_relief(next, id) - next.cbegin())] =
      std::make_shared<const ReliefItem>(ReliefItem{id, std::move(relief)});
  edit(std::move(next), relief_bytes(*old) + list_bytes(items()), what + " " + quoted_title(old->relief),
       what + " " + std::to_string(id), continues);
  return "";
}

ReliefEditor::Problem ReliefEditor::shift(std::uint64_t id, bool later) {
  Items next = items();
  const auto at = static_cast<std::size_t>(find_relief(next, id) - next.cbegin());
  if (at == next.size()) return kNoRelief;
  if (later ? at + 1 == next.size() : at == 0) return "";
  std::swap(next[at], next[later ? at + 1 : at - 1]);
  edit(std::move(next), list_bytes(items()),
       (later ? "make later " : "make earlier ") + quoted_title(find(id)->relief));
  return "";
}

ReliefEditor::Problem ReliefEditor::remove(std::uint64_t id) {
  const SharedRelief old = find(id);
  if (old == nullptr) return kNoRelief;
  Items next = items();
  next.erase(find_relief(next, id));
  edit(std::move(next), relief_bytes(*old) + list_bytes(items()), "delete " + quoted_title(old->relief));
  return "";
}

}  // namespace vpe::explore
