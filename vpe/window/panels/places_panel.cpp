#include "vpe/window/panels/places_panel.h"

#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

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

PlacesActions PlacesPanel::draw(const explore::Session& session, Widgets& widgets) {
  PlacesActions actions;
  // Keys, and people, change the file too.
  if (ImGui::GetFrameCount() - last_frame_ > 1) is_read_ = false;
  last_frame_ = ImGui::GetFrameCount();
  if (!is_read_) read();
  ImGui::BeginChild("places");
  if (!bookmarks_) {
    coloured(kErrorColour, error_);
    ImGui::EndChild();
    return actions;
  }
  if (widgets.button("Keep this view", "Ctrl+1 ... Ctrl+9 keep it under a key, 1 ... 9 go there")) {
    const std::vector<explore::Bookmark> all = bookmarks_->all();
    std::string name;
    for (std::size_t n = all.size() + 1; name.empty() || bookmarks_->named(name); ++n)
      name = "view " + std::to_string(n);
    const std::string problem = bookmarks_->put({0, {session.pose(), session.screen().fov_deg}, name});
    if (problem.empty()) {
      save(actions);
    } else {
      actions.message = problem;
      actions.message_is_error = true;
    }
  }
  removed_.reset();
  const std::size_t count = bookmarks_->all().size();
  if (count == 0) ImGui::TextDisabled("No views are kept yet.");
  for (std::size_t n = 0; n < count; ++n) draw_row(n, actions, widgets);
  if (removed_ && bookmarks_->remove(*removed_)) save(actions);
  ImGui::EndChild();
  return actions;
}

void PlacesPanel::draw_row(std::size_t index, PlacesActions& actions, Widgets& widgets) {
  const explore::Bookmark bookmark = bookmarks_->all()[index];
  const std::string id = "##view " + std::to_string(index);
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", bookmark.key > 0 ? std::to_string(bookmark.key).c_str() : " ");
  ImGui::SameLine(ImGui::GetFontSize() * 1.2F);
  if (widgets.button(("Go" + id).c_str())) actions.go_to = bookmark.view;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 2);
  std::string name = bookmark.name;
  if (widgets.text(id.c_str(), name, "the view's name")) {
    if (const std::string problem = bookmarks_->rename(index, name); problem.empty()) {
      save(actions);
    } else {
      widgets.refuse(id.c_str(), name);
      actions.message = problem;
      actions.message_is_error = true;
    }
  }
  ImGui::SameLine();
  if (widgets.button(("x" + id).c_str(), "forget this view")) removed_ = index;
}

}  // namespace vpe::window
