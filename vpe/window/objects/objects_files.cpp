// Files of the panel "Objects": the scene that the session shows, its copy, and models.
#include <algorithm>
#include <chrono>
#include <exception>

#include "objects/files/model_file.h"
#include "objects/files/scene_writer.h"
#include "objects/files/volume_model_file.h"
#include "vpe/explore/objects/scene_saving.h"
#include "vpe/window/objects/objects_panel.h"
#include "vpe/window/panels/file_names.h"
#include "vpe/window/panels/flight_panel.h"

namespace vpe::window {

namespace fs = std::filesystem;

namespace {

constexpr const char* kUnsavedScene = "the present scene has unsaved changes; save it, or undo them";

fs::path whole_file(const fs::path& file) { return fs::absolute(file).lexically_normal(); }

// Returns the file with the extension of a scene that can be written.
fs::path as_scene_file(const fs::path& file) {
  if (file.extension() == ".toml") return file;
  fs::path named = file;
  const bool is_json = file.extension() == ".geojson" || file.extension() == ".json";
  named.replace_extension();
  return (is_json ? named : file).string() + ".scene.toml";
}

}  // namespace

// Takes over the scene that the session shows, when it is another, or when its file was edited by somebody else.
void ObjectsPanel::follow_setting(const explore::Session& session) {
  const std::string& setting = session.settings().values().scene;
  if (setting_ == setting) {
    refused_setting_.clear();
    if (editor_.is_changed() || setting.empty() || now_s_ - looked_s_ < ObjectsPanelLimits::kLookAgain_s)
      return;
    looked_s_ = now_s_;
    if (base::file_stamp(setting) == stamp_) return;
  } else if (editor_.is_changed()) {
    if (std::exchange(refused_setting_, setting) != setting)
      tell("the panel Objects keeps a scene with unsaved changes, which is not the one that is shown");
    return;
  }
  load(setting);
}

void ObjectsPanel::load(const std::string& setting) {
  objects::SceneFile scene;
  setting_ = setting;
  stamp_ = setting.empty() ? std::nullopt : base::file_stamp(setting);
  looked_s_ = now_s_;
  file_ = setting;
  if (!setting.empty()) {
    try {
      scene = objects::read_scene_file(whole_file(setting));
    } catch (const std::exception& e) {
      report(e.what());
      scene = {};
      file_.clear();
    }
  }
  editor_.load(std::move(scene));
  selected_ = 0;
  model_ = 0;
  held_.reset();
  follow_.reset();
  turning_.reset();
  is_placing_ = false;
}

fs::path ObjectsPanel::typed_file() const {
  fs::path path = in_home(file_);
  if (!path.empty() && path.is_relative() && path != fs::path(setting_.value_or(""))) path = folder_ / path;
  return path;
}

void ObjectsPanel::open(const fs::path& file, explore::Session& session) {
  if (editor_.is_changed()) return report(kUnsavedScene);
  try {
    if (!file.empty()) (void)objects::read_scene_file(file);
    report(session.set("scene", file.string()));
    load(session.settings().values().scene);
    if (!file.empty()) tell("scene: " + file.string());
  } catch (const std::exception& e) {
    report(e.what());
  }
}

void ObjectsPanel::save(explore::Session& session) {
  const fs::path file =
      file_.empty() ? new_file(folder_, "objects-", ".scene.toml") : as_scene_file(typed_file());
  try {
    const bool is_others = setting_ == file.string() && base::file_stamp(file) != stamp_;
    const bool is_other = setting_ != file.string();
    const auto kept = explore::save_scene(editor_.scene(), whole_file(file), is_others || is_other);
    editor_.mark_saved();
    report(session.set("scene", file.string()));
    setting_ = session.settings().values().scene;
    stamp_ = base::file_stamp(file);
    file_ = file.string();
    tell("scene: " + file.string() + (kept ? "; the former file is " + kept->filename().string() : ""));
  } catch (const std::exception& e) {
    report(e.what());
  }
}

void ObjectsPanel::restore(const fs::path& copy, const explore::Session& session) {
  try {
    editor_.load(objects::read_scene_file(copy));
    editor_.mark_unsaved();
    setting_ = session.settings().values().scene;
    copy_.adopt(copy);
    tell("the unsaved scene is open");
  } catch (const std::exception& e) {
    report(e.what());
  }
  abandoned_ = copy_.abandoned();
}

void ObjectsPanel::take_model(const std::string& text) {
  if (text.empty()) return;
  fs::path file = in_home(text);
  if (file.is_relative()) file = folder_ / file;
  file = whole_file(file);
  std::error_code unknown;
  if (!fs::exists(file, unknown)) return report(text + ": there is no such file");
  if (file.extension() != ".sticks" && !objects::is_model_path(file) && !objects::is_volume_path(file))
    return report(text + ": expected a model: .glb, .gltf, .obj, .ply, .stl, .sticks, .volume or .vdb");
  const auto is_it = [&](const objects::ModelEntry& model) { return model.file == file; };
  const auto& models = editor_.models();
  const auto known = std::find_if(models.begin(), models.end(), is_it);
  model_text_.clear();
  if (known != models.end()) {
    model_ = static_cast<int>(known - models.begin());
    return;
  }
  auto typed = std::find_if(typed_models_.begin(), typed_models_.end(), is_it);
  if (typed == typed_models_.end()) typed = typed_models_.insert(typed, {file.stem().string(), file});
  model_ = static_cast<int>(models.size()) + static_cast<int>(typed - typed_models_.begin());
  (void)sizes_.ball(*typed);
}

bool ObjectsPanel::update(double now_s, bool draws) {
  now_s_ = now_s;
  const bool is_measured = sizes_.update();
  if (is_measured) {
    for (const objects::ModelEntry& model : typed_models_) report(sizes_.error(model));
  }
  const bool is_changed = editor_.is_changed();
  is_due_ = is_changed ? copied_ != editor_.revision() : copied_ != 0;
  if (!is_due_ || (is_changed && now_s < next_copy_s_)) return is_measured;
  // An image that is being drawn may still read the copy.
  if (!is_changed && draws) return is_measured;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begun = Clock::now();
  const std::string problem = copy_.update({editor_.revision(), editor_.saves(), 0}, is_changed, [this] {
    return objects::to_toml(editor_.scene(), whole_file(copy_.file()));
  });
  const double took_s = std::chrono::duration<double>(Clock::now() - begun).count();
  next_copy_s_ = now_s + std::max(ObjectsPanelLimits::kShortestCopy_s, took_s / ObjectsPanelLimits::kCopyShare);
  copied_ = is_changed ? editor_.revision() : 0;
  has_copy_ = is_changed && problem.empty();
  ++copies_;
  is_due_ = false;
  report(problem);
  return true;
}

std::string ObjectsPanel::shown_file(const explore::Session& session) const {
  const std::string& setting = session.settings().values().scene;
  return editor_.is_changed() && has_copy_ && setting_ == setting ? copy_.file().string() : setting;
}

std::string ObjectsPanel::exit_message() {
  if (!editor_.is_changed()) return {};
  const fs::path file = new_file(folder_, "unsaved-", ".scene.toml");
  try {
    objects::write_scene_file(editor_.scene(), whole_file(file));
    editor_.mark_saved();
    (void)copy_.update({editor_.revision(), editor_.saves(), 0}, false, {});
    return "the scene was not saved; a copy is in " + file.string();
  } catch (const std::exception& e) {
    return std::string("the scene was not saved: ") + e.what();
  }
}

}  // namespace vpe::window
