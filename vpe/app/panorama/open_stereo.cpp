#include "vpe/app/panorama/open_stereo.h"

#include "panorama/viewer/render_view.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/planet/planet_argument.h"

namespace vpe::app {

namespace {

// Of the budget, for the textures of each eye that is drawn by OpenGL.
constexpr std::size_t kTextureShare = 4;
// Of the budget, for the ranges that a moving head needs, beside it.
constexpr std::size_t kRangeShare = 4;

}  // namespace

StereoPanorama::StereoPanorama(const PanoramaFiles& files, std::size_t budget_bytes, int threads)
    : left_{panorama::describe(files.panorama, files.layout), nullptr, {}},
      budget_bytes_(budget_bytes / (files.right.empty() && !files.second ? 1 : 2)),
      threads_(threads) {
  if (!files.right.empty()) right_ = Panorama{panorama::describe(files.right, files.layout), nullptr, {}};
  if (files.second) second_ = std::make_unique<SecondLook>(left_.description, budget_bytes_, *files.second);
}

void StereoPanorama::set_context(std::shared_ptr<gl::Context> context) {
  left_.renderers = {};
  if (right_) right_->renderers = {};
  context_ = std::move(context);
}

core::RgbImage StereoPanorama::draw(const core::View& view, const std::optional<core::StereoLayout>& stereo,
                                    const CopyProgress& progress,
                                    const std::function<void(core::RgbImage&)>& finish) {
  const auto finished_eye = [&](Panorama& panorama, bool is_second) {
    core::RgbImage image = draw_eye(panorama, is_second, view, progress);
    if (finish) finish(image);
    return image;
  };
  is_complete_ = true;
  moved_m_ = 0;
  if (!stereo && view.camera.position_m != glm::dvec3(0) && head() != nullptr) {
    MovedView moved =
        head_->draw_moved(view, [&](const core::View& wide) { return draw_eye(left_, false, wide, progress); });
    moved_m_ = moved.moved_m;
    filled_share_ = moved.filled_share;
    if (finish) finish(moved.image);
    return std::move(moved.image);
  }
  if (stereo && second_) {
    EyePair eyes =
        second_->draw(view, [&](const core::View& wide) { return draw_eye(left_, false, wide, progress); });
    filled_share_ = eyes.filled_share;
    if (finish) {
      finish(eyes.left);
      finish(eyes.right);
    }
    return core::combine_stereo(eyes.left, eyes.right, *stereo);
  }
  core::RgbImage left = finished_eye(left_, false);
  if (!stereo) return left;
  const core::RgbImage right = right_ ? finished_eye(*right_, false) : finished_eye(left_, true);
  return core::combine_stereo(left, right, *stereo);
}

SecondLook* StereoPanorama::head() {
  if (!head_ && !has_no_ranges_) {
    has_no_ranges_ = !panorama::has_ranges(left_.description);
    if (!has_no_ranges_)
      head_ = std::make_unique<SecondLook>(left_.description, budget_bytes_ / kRangeShare,
                                           SecondLookOptions{.threads = threads_});
  }
  return head_.get();
}

core::RgbImage StereoPanorama::draw_eye(Panorama& panorama, bool is_second, const core::View& view,
                                        const CopyProgress& progress) {
  if (panorama.tiled_image == nullptr) open(panorama, progress);
  const panorama::PanoramaDescription& description = panorama.description;
  panorama::RenderViewOptions options;
  options.threads = threads_;
  if (is_second && description.pair == panorama::PairLayout::kSideBySide)
    options.origin.x_px = description.map.width_px;
  if (is_second && description.pair == panorama::PairLayout::kOverUnder)
    options.origin.y_px = description.map.height_px;
  if (context_ == nullptr) return panorama::render_view(*panorama.tiled_image, description.map, view, options);
  std::unique_ptr<overlook::OverlookRenderer>& renderer = panorama.renderers[is_second ? 1 : 0];
  if (renderer == nullptr) {
    overlook::OverlookOptions by_graphics;
    by_graphics.origin = options.origin;
    by_graphics.outside = options.outside;
    by_graphics.threads = threads_;
    by_graphics.budget_bytes = budget_bytes_ / kTextureShare;
    renderer = std::make_unique<overlook::OverlookRenderer>(context_, *panorama.tiled_image, description.map,
                                                            by_graphics);
  }
  overlook::OverlookRenderer::Drawn drawn = renderer->draw(view, most_new_);
  is_complete_ = is_complete_ && drawn.is_complete;
  return std::move(drawn.image);
}

void StereoPanorama::open(Panorama& panorama, const CopyProgress& progress) const {
  const panorama::PanoramaDescription& description = panorama.description;
  panorama::TiledImageOptions options;
  options.budget_bytes = context_ == nullptr ? budget_bytes_ : budget_bytes_ / 2;
  options.cache_folder = [] {
    const std::filesystem::path folder = cache_folder() / "pictures";
    make_folder(folder);
    return folder;
  };
  if (progress) {
    options.progress = [&](double fraction) {
      progress("copying " + description.image.filename().string() + " once, in tiles", fraction);
    };
  }
  panorama.tiled_image = panorama::open_tiled_image(description.image, description.format, options);
}

}  // namespace vpe::app
