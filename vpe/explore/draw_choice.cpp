#include "vpe/explore/draw_choice.h"

namespace vpe::explore {

const DrawChoice& DrawChooser::update(const DrawChoice& own, FlightPlayer* flight) {
  choice_ = own;
  if (flight != nullptr) {
    const DrawChoice before = own_.value_or(own);
    if (own.drawn_by != before.drawn_by) flight->keep_backend();
    if (own.stereo != before.stereo || own.eye_base_m != before.eye_base_m ||
        own.convergence_m != before.convergence_m)
      flight->keep_eyes();
    const scripts::ViewState view = flight->view();
    choice_.drawn_by = view.backend.value_or(own.drawn_by);
    if (view.eyes) choice_.stereo = view.eyes->layout;
    choice_.eye_base_m = view.eye_base_m.value_or(own.eye_base_m);
    choice_.convergence_m = view.convergence_m.value_or(own.convergence_m);
  }
  own_ = own;
  return choice_;
}

}  // namespace vpe::explore
