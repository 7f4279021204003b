#include "vpe/window/workers/planet_opener.h"

#include <chrono>

namespace vpe::window {

namespace {

template <class T>
bool is_ready(const std::future<T>& result) {
  return result.valid() && result.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

std::string PlanetOpener::start(const std::string& file) {
  if (!open_) return "another planet cannot be opened here";
  if (opening_.valid()) return "wait until " + file_ + " is open";
  file_ = file;
  opening_ = std::async(std::launch::async, [open = open_, notify = notify_, file] {
    auto planet = open(file);
    notify();
    return planet;
  });
  return {};
}

std::shared_ptr<const paging::PlanetFile> PlanetOpener::take() {
  return is_ready(opening_) ? opening_.get() : nullptr;
}

void PlanetMaker::begin() {
  if (!make_) return;
  making_ = std::async(std::launch::async, [make = std::exchange(make_, {}), notify = notify_,
                                            fraction = fraction_, stop = stop_.get_token()] {
    auto planet = make(stop, [&fraction](double share) { *fraction = share; });
    notify();
    return planet;
  });
}

std::optional<ShownPlanet> PlanetMaker::take() { return is_ready(making_) ? making_.get() : std::nullopt; }

}  // namespace vpe::window
