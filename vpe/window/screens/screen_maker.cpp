#include "vpe/window/screens/screen_maker.h"

#include <chrono>
#include <exception>
#include <map>
#include <memory>
#include <utility>

#include "vpe/explore/screens/lens_table.h"

namespace vpe::window {

namespace {

class RoundPainter {
 public:
  RoundPainter(explore::ScreenSet set, MakePainter make_painter)
      : set_(std::move(set)), make_painter_(std::move(make_painter)) {}

  ScreenImages operator()(ScreenRound round) {
    ScreenImages drawn;
    const auto begun = std::chrono::steady_clock::now();
    try {
      if (painter_ == nullptr) painter_ = make_painter_();
      for (const ScreenOrder& order : round.orders)
        drawn.images.push_back(image_of(round, order, drawn.is_settled));
    } catch (const std::exception& e) {
      drawn.images.clear();
      drawn.error = e.what();
    }
    drawn.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    return drawn;
  }

 private:
  ScreenImage image_of(const ScreenRound& round, const ScreenOrder& order, bool& is_settled) {
    ScreenImage screen_image{order, {}};
    if (!order.view) return screen_image;
    ImageRequest request = round.base;
    request.draw.view = *order.view;
    DrawnImage drawn = painter_->paint(request);
    is_settled = is_settled && drawn.result.settled;
    screen_image.image = std::move(drawn.image);
    if (const explore::LensTable* table = table_of(order))
      screen_image.image = explore::through_lens(screen_image.image, *table);
    return screen_image;
  }

  // Returns null for a screen without a lens.
  const explore::LensTable* table_of(const ScreenOrder& order) {
    const explore::PlacedScreen& screen = set_.screens[order.screen].screen;
    const auto* lens = std::get_if<explore::ScreenLens>(&screen.place);
    if (lens == nullptr) return nullptr;
    std::unique_ptr<explore::LensTable>& table = tables_[{order.screen, order.side}];
    if (table == nullptr)
      table = std::make_unique<explore::LensTable>(*lens, screen.width_px, screen.height_px, order.side);
    return table.get();
  }

  explore::ScreenSet set_;
  MakePainter make_painter_;
  std::unique_ptr<Painter> painter_;
  std::map<std::pair<std::size_t, int>, std::unique_ptr<explore::LensTable>> tables_;
};

}  // namespace

ScreenMaker::ScreenMaker(explore::ScreenSet set, MakePainter make_painter, std::function<void()> notify)
    : worker_(RoundPainter(std::move(set), std::move(make_painter)), std::move(notify)) {}

}  // namespace vpe::window
