// Files of the panel "Ground": reliefs, their copy, and flights in which they form.
#include <algorithm>
#include <exception>

#include "relief/files/relief_file.h"
#include "vpe/base/file.h"
#include "vpe/explore/reliefs/relief_flight.h"
#include "vpe/explore/reliefs/relief_saving.h"
#include "vpe/window/panels/file_names.h"
#include "vpe/window/panels/flight_panel.h"
#include "vpe/window/reliefs/reliefs_panel.h"

namespace vpe::window {

namespace fs = std::filesystem;

namespace {

// Returns the file with the extension of reliefs.
fs::path as_relief_file(const fs::path& file) {
  return relief::is_relief_path(file) ? file : fs::path(file.string() + ".relief.toml");
}

}  // namespace

fs::path ReliefsPanel::typed_file() const {
  fs::path path = in_home(file_);
  if (!path.empty() && path.is_relative()) path = folder_ / path;
  return path;
}

void ReliefsPanel::open(const fs::path& file) {
  if (editor_.is_changed()) return report("the present reliefs have unsaved changes; save them, or undo them");
  try {
    const std::string problem =
        editor_.load(file.empty() ? std::vector<relief::ReliefSpec>() : relief::read_relief_file(file));
    if (!problem.empty()) return report(file.string() + ": " + problem);
    open_ = file.empty() ? std::nullopt : std::optional(file);
    file_ = file.string();
    selected_ = editor_.items().empty() ? 0 : editor_.items().front()->id;
    held_.reset();
    if (!file.empty()) tell("reliefs: " + file.string());
  } catch (const std::exception& e) {
    report(e.what());
  }
}

void ReliefsPanel::save() {
  const fs::path file =
      file_.empty() ? new_file(folder_, "reliefs-", ".relief.toml") : as_relief_file(typed_file());
  try {
    const auto kept = explore::save_reliefs(editor_.reliefs(), file, open_ != file);
    editor_.mark_saved();
    open_ = file;
    file_ = file.string();
    tell("reliefs: " + file.string() + (kept ? "; the former file is " + kept->filename().string() : ""));
  } catch (const std::exception& e) {
    report(e.what());
  }
}

void ReliefsPanel::save_flight(const explore::Session& session) {
  const fs::path file = new_file(folder_, "reliefs-", ".flight");
  try {
    const explore::FlightEditor* flight = session.flights().editor();
    const scripts::Flight formed = explore::with_forming(
        flight != nullptr ? flight->flight()
                          : explore::flight_at(session.pose(), session.screen().fov_deg, forming_s_),
        editor_.reliefs(), 0, forming_s_);
    base::write_file(file, scripts::to_text(formed));
    tell("flight: " + file.string());
  } catch (const std::exception& e) {
    report(e.what());
  }
}

// Saves the reliefs, and asks for a planet with them.
void ReliefsPanel::patch() {
  if (editor_.is_changed() || !open_) save();
  if (editor_.is_changed() || !open_) return;
  actions_.patch = *open_;
}

void ReliefsPanel::restore(const fs::path& copy) {
  try {
    const std::string problem = editor_.load(relief::read_relief_file(copy));
    if (!problem.empty()) return report(copy.string() + ": " + problem);
    editor_.mark_unsaved();
    open_.reset();
    file_.clear();
    selected_ = editor_.items().empty() ? 0 : editor_.items().front()->id;
    copy_.adopt(copy);
    tell("the unsaved reliefs are open");
  } catch (const std::exception& e) {
    report(e.what());
  }
  abandoned_ = copy_.abandoned();
}

void ReliefsPanel::update(double now_s) {
  if (now_s < next_copy_s_) return;
  next_copy_s_ = now_s + ReliefsPanelLimits::kCopy_s;
  report(copy_.update({editor_.revision(), editor_.saves(), 0}, editor_.is_changed(),
                      [this] { return relief::to_toml(editor_.reliefs()); }));
}

std::string ReliefsPanel::exit_message() {
  if (!editor_.is_changed()) return {};
  const fs::path file = new_file(folder_, "unsaved-", ".relief.toml");
  try {
    relief::write_relief_file(editor_.reliefs(), file);
    editor_.mark_saved();
    (void)copy_.update({editor_.revision(), editor_.saves(), 0}, false, {});
    return "the reliefs were not saved; a copy is in " + file.string();
  } catch (const std::exception& e) {
    return std::string("the reliefs were not saved: ") + e.what();
  }
}

}  // namespace vpe::window
