// Records the session of a window as a flight (vpe/explore/files/session_log.h).
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "panorama/viewer/viewer.h"
#include "vpe/explore/files/hotspots.h"
#include "vpe/explore/files/session_log.h"
#include "vpe/explore/session.h"
#include "vpe/window/workers/painter.h"

namespace vpe::window {

// Writes one log at a time. All functions but start() do nothing while nothing is recorded. They return what
// went wrong, or ""; after an error the recording has ended, and what was written before it is a valid flight.
// `now_s` is the time of one clock. For one thread at a time.
//
// Typical usage:
//   if (const std::string error = recorder.start(file, session, stereo, now_s); !error.empty()) show(error);
//   (void)recorder.record_image(request, as_drawn(request), session, now_s);   // for each image that is requested
//   (void)recorder.stop(now_s);
class SessionRecorder {
 public:
  // `stereo` says which eyes are shown. The size of a log is that of the images of both eyes together, as in films.
  [[nodiscard]] std::string start(const std::filesystem::path& file, const explore::Session& session,
                                  std::optional<core::StereoLayout> stereo, double now_s);
  [[nodiscard]] std::string stop(double now_s);
  bool is_recording() const { return log_ != nullptr; }
  // Returns the file that is or was written last.
  const std::filesystem::path& file() const { return file_; }

  // Records pose, settings, field of view, size, backend and eyes of a request, and sets its logged_s. `drawn` is the
  // request as its painter draws it at full quality (ExploreSetup::as_drawn): its backend and its mode of rays are
  // recorded.
  [[nodiscard]] std::string record_image(ImageRequest& request, const ImageRequest& drawn,
                                         const explore::Session& session, double now_s);

  // Record entering, looking around in and leaving a panorama. In the flight the camera stands at the hotspot
  // and the head has the direction of the panorama's view.
  [[nodiscard]] std::string enter_overlook(const explore::Hotspot& hotspot, double now_s);
  [[nodiscard]] std::string record_overlook(const panorama::Viewer& viewer, const glm::dvec3& camera_m,
                                            explore::Session& session, double now_s);
  [[nodiscard]] std::string leave_overlook(double now_s);

 private:
  template <class Write>
  std::string write(const Write& write);

  std::unique_ptr<explore::SessionLog> log_;
  std::filesystem::path file_;
  double begun_s_ = 0;
  std::pair<double, double> overlook_deg_{0, 0};  // yaw and pitch in a panorama, written last
};

}  // namespace vpe::window
