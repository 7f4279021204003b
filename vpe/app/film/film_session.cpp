#include "vpe/app/film/film_session.h"

#include <algorithm>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/output.h"

namespace vpe::app {

namespace fs = std::filesystem;

FilmSession::FilmSession(FilmRequest request) : request_(std::move(request)) {
  if (!request_.is_video) {
    target_ = std::make_unique<FilmFolder>(request_.output, request_.remake);
    return;
  }
  auto video = std::make_unique<FilmVideo>(
      request_.output, manifest_of_video(request_.output, {}, {}), request_.format,
      request_.shard.is_all() ? FolderLock::Use::kAlone : FolderLock::Use::kShared, request_.remake);
  video_ = video.get();
  target_ = std::move(video);
}

void FilmSession::find_stored(const FilmPlan& plan, int threads) {
  const std::int64_t all = request_.range.count();
  const std::int64_t size = target_->group_size();
  first_ = std::min(all, request_.shard.begin(groups()) * size);
  frames_ = plan.frames(request_.range, first_, std::min(all, request_.shard.end(groups()) * size));
  base::ThreadPool pool(threads);
  target_->keep(frames_, {first_, all}, pool);
}

std::int64_t FilmSession::groups() const {
  const std::int64_t size = target_->group_size();
  return (request_.range.count() + size - 1) / size;
}

std::string FilmSession::missing_from_parts() const {
  const FilmCount n = count(frames_);
  if (!request_.shard.is_all() || request_.remake || n.done() == n.all) return {};
  const auto parts = parts_begun(request_.is_video ? parts_folder(request_.output) : request_.output,
                                 request_.is_video ? "" : request_.frames);
  return parts ? missing_text(kind(), frames_, parts) : std::string();
}

void FilmSession::make(const FilmPlan& plan, FilmReports& reports, const RenderOptions& options,
                       const FilmMaker::Makers& makers, FrameOverlays& overlays, bool quiet) {
  try {
    ProgressLine line(quiet);
    FilmMaker(plan, *target_, frames_, first_, options, makers, overlays).run(reports, line);
  } catch (const Interrupted& e) {
    throw Interrupted(e.signal(), std::string(e.what()) + ": " + progress_text(kind(), frames_));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    throw std::runtime_error(std::string(e.what()) + "; " + progress_text(kind(), frames_));
  }
}

void FilmSession::finish(const ManifestHead& head) {
  const FilmCount n = count(frames_);
  const bool is_whole = request_.shard.of == 1 && n.done() == n.all;
  if (video_ == nullptr) {
    make_folder(request_.output);
    manifest_ = manifest_of_folder(request_.output, request_.frames, request_.shard);
    write_manifest(manifest_, head, target_->describe(), frames_);
    return;
  }
  if (is_whole) {
    const bool was_complete = video_->is_complete();
    video_->set_comment(head.synthetic);
    video_->finish(frames_);
    manifest_ = manifest_of_video(request_.output, {}, {});
    if (!was_complete) write_manifest(manifest_, head, target_->describe(), frames_);
    video_->remove_parts();
    return;
  }
  if (video_->is_complete()) return;  // one shard of a film that is complete
  // The film's own manifest stays as long as the old film does.
  const fs::path parts = parts_folder(request_.output);
  make_folder(parts);
  manifest_ = manifest_of_folder(parts, "", request_.shard);
  write_manifest(manifest_, head, target_->describe(), frames_);
}

}  // namespace vpe::app
