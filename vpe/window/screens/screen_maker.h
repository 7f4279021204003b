// Draws the images of all screens for one place of the head, on a thread of its own.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vpe/base/latest_worker.h"
#include "vpe/core/image/image.h"
#include "vpe/core/view.h"
#include "vpe/explore/screens/placed_screen.h"
#include "vpe/window/workers/painter.h"

namespace vpe::window {

// Asks for the image of one eye of one screen.
struct ScreenOrder {
  std::size_t screen = 0;          // its number in the set
  int side = 0;                    // of the eye, as explore::side_of() has it
  std::optional<core::View> view;  // nullopt: the eye does not see the screen, which stays black
};

// Asks for a round: images that are shown together.
struct ScreenRound {
  ImageRequest base;  // everything but the view
  std::vector<ScreenOrder> orders;
};

struct ScreenImage {
  ScreenOrder order;
  core::RgbImage image;  // without pixels where there is no view
};

struct ScreenImages {
  std::vector<ScreenImage> images;  // in the order of the round
  bool is_settled = true;           // all of them
  double seconds = 0;
  std::string error;  // why there are no images; empty: there are
};

// Draws rounds one after the other with one painter, so that all screens share its tiles and its memory. Images behind a
// lens are returned as the screen must show them. A waiting round is replaced by a later one. For one calling thread.
class ScreenMaker {
 public:
  // Creates the painter on the maker's thread, at the first round. Calls `notify` on that thread after each round.
  ScreenMaker(explore::ScreenSet set, MakePainter make_painter, std::function<void()> notify);

  void request(ScreenRound round) { worker_.request(std::move(round)); }
  // Returns true if no round waits or runs, and none can be taken.
  bool is_idle() const { return worker_.is_idle(); }
  // Returns the round finished last, once. Waits for at most `wait_s` seconds.
  std::optional<ScreenImages> take(double wait_s = 0) { return worker_.take(wait_s); }

 private:
  base::LatestWorker<ScreenRound, ScreenImages> worker_;
};

}  // namespace vpe::window
