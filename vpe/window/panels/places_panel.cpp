#include "vpe/window/panels/places_panel.h"

#include <algorithm>
#include <vector>

#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

explore::SavedView view_of(const explore::Session& session) {
  return {session.pose(), session.screen().fov_deg};
}

// Returns "view N" with the first N that is free from the number of bookmarks on.
std::string new_name(const std::vector<explore::Bookmark>& all) {
  for (std::size_t n = all.size() + 1;; ++n) {
    std::string name = "view " + std::to_string(n);
    if (std::ranges::none_of(all, [&](const explore::Bookmark& b) { return b.name == name; })) return name;
  }
}

void refuse(const std::string& problem, PlacesActions& actions) {
  if (problem.empty()) return;
  actions.message = problem;
  actions.message_is_error = true;
}

}  // namespace

void PlacesPanel::read() {
  is_read_ = true;
  bookmarks_.reset();
  error_.clear();
  if (file_.empty()) {
    error_ = "there is no folder for bookmarks: HOME is not set";
    return;
  }
  try {
    explore::ParsedBookmarks parsed = explore::load_bookmarks(file_);
    if (parsed.bookmarks)
      bookmarks_ = std::move(parsed.bookmarks);
    else
      error_ = scripts::to_string(parsed.errors.front());
  } catch (const std::exception& e) {
    error_ = e.what();
  }
}

void PlacesPanel::save(PlacesActions& actions) {
  try {
    explore::save_bookmarks(file_, *bookmarks_);
  } catch (const std::exception& e) {
    actions.message = e.what();
    actions.message_is_error = true;
    is_read_ = false;
  }
}

PlacesActions PlacesPanel::draw(const explore::Session& session, explore::BookmarkList* project,
                                Widgets& widgets) {
  PlacesActions actions;
  // Keys, and people, change the file too.
  if (ImGui::GetFrameCount() - last_frame_ > 1) is_read_ = false;
  last_frame_ = ImGui::GetFrameCount();
  if (!is_read_) read();
  begin_part("places");
  if (project != nullptr) {
    draw_project(session, *project, actions, widgets);
    ImGui::Separator();
  }
  if (bookmarks_)
    draw_file(session, actions, widgets);
  else
    coloured(kErrorColour, error_);
  ImGui::EndChild();
  return actions;
}

void PlacesPanel::draw_project(const explore::Session& session, explore::BookmarkList& project,
                               PlacesActions& actions, Widgets& widgets) {
  ImGui::TextUnformatted("Of the project");
  const std::vector<explore::Bookmark> all(project.all().begin(), project.all().end());
  if (widgets.button("Keep this view##project", "Ctrl+1 ... Ctrl+9 keep it under a key, 1 ... 9 go there"))
    refuse(project.put({0, view_of(session), new_name(all)}), actions);
  for (std::size_t n = 0; n < all.size(); ++n) {
    const std::string id = "##project view " + std::to_string(n);
    const RowActions row = draw_row(all[n], id, widgets);
    if (row.goes) actions.go_to = all[n].view;
    if (row.removes) {
      project.remove(n);
      break;
    }
    if (!row.name) continue;
    const std::string problem = project.rename(n, *row.name);
    if (!problem.empty()) widgets.refuse(id.c_str(), *row.name);
    refuse(problem, actions);
  }
  ImGui::Spacing();
  ImGui::TextUnformatted("Of all sessions");
}

void PlacesPanel::draw_file(const explore::Session& session, PlacesActions& actions, Widgets& widgets) {
  if (widgets.button("Keep this view", "Ctrl+1 ... Ctrl+9 keep it under a key, 1 ... 9 go there")) {
    const std::string problem = bookmarks_->put({0, view_of(session), new_name(bookmarks_->all())});
    if (problem.empty()) save(actions);
    refuse(problem, actions);
  }
  const std::vector<explore::Bookmark> all = bookmarks_->all();
  if (all.empty()) ImGui::TextDisabled("No views are kept yet.");
  for (std::size_t n = 0; n < all.size(); ++n) {
    const std::string id = "##view " + std::to_string(n);
    const RowActions row = draw_row(all[n], id, widgets);
    if (row.goes) actions.go_to = all[n].view;
    if (row.removes && bookmarks_->remove(n)) {
      save(actions);
      break;
    }
    if (!row.name) continue;
    const std::string problem = bookmarks_->rename(n, *row.name);
    if (problem.empty())
      save(actions);
    else
      widgets.refuse(id.c_str(), *row.name);
    refuse(problem, actions);
  }
}

PlacesPanel::RowActions PlacesPanel::draw_row(const explore::Bookmark& bookmark, const std::string& id,
                                              Widgets& widgets) {
  RowActions actions;
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", bookmark.key > 0 ? std::to_string(bookmark.key).c_str() : " ");
  ImGui::SameLine(ImGui::GetFontSize() * 1.2F);
  actions.goes = widgets.button(("Go" + id).c_str());
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 2);
  std::string name = bookmark.name;
  if (widgets.text(id.c_str(), name, "the view's name")) actions.name = name;
  ImGui::SameLine();
  actions.removes = widgets.button(("x" + id).c_str(), "forget this view");
  return actions;
}

}  // namespace vpe::window
