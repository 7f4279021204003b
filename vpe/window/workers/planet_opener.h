// Planets that are opened or built while the window runs.
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "paging/planet/planet_file.h"
#include "paging/surface/surface.h"
#include "vpe/explore/measure/sight_scene.h"
#include "vpe/window/workers/painter.h"

namespace vpe::window {

// Opens a planet file, or builds one from a raster. Throws if this is not possible.
using OpenPlanet = std::function<std::shared_ptr<const paging::PlanetFile>(const std::string& file)>;

// Holds a planet as the window uses it.
struct ShownPlanet {
  std::shared_ptr<const paging::PlanetFile> planet;
  std::shared_ptr<const paging::Surface> surface;
  MakePainter make_painter;
  // Opens scenes of objects on the planet, for lines of sight; called on the thread that measures. Empty: objects do not
  // count.
  explore::OpenScene open_scene = {};
  // Returns the same for another surface of the planet, whose ground has changed.
  std::function<explore::OpenScene(std::shared_ptr<const paging::Surface>)> scenes_on = {};
};

// Makes a planet that takes time, and tells the share of the work that is done, from any thread. Returns nullopt once
// it was asked to stop. Throws if it cannot be made.
using TellProgress = std::function<void(double fraction)>;
using MakePlanet = std::function<std::optional<ShownPlanet>(std::stop_token, const TellProgress&)>;

// Opens a planet on a thread of its own. The destructor waits for it. For the window's thread.
class PlanetOpener {
 public:
  // `notify` is called on the other thread when the planet is open.
  PlanetOpener(OpenPlanet open, std::function<void()> notify)
      : open_(std::move(open)), notify_(std::move(notify)) {}

  // Starts opening a file. Returns why it cannot, or "".
  std::string start(const std::string& file);
  bool is_opening() const { return opening_.valid(); }
  // Returns the file that was started last.
  const std::string& file() const { return file_; }
  // Returns the planet once it is open, else null. Throws if it could not be opened.
  std::shared_ptr<const paging::PlanetFile> take();

 private:
  OpenPlanet open_;
  std::function<void()> notify_;
  std::string file_;
  std::future<std::shared_ptr<const paging::PlanetFile>> opening_;
};

// Makes a planet on a thread of its own. The destructor asks it to stop and waits for it. For the window's thread.
class PlanetMaker {
 public:
  // `notify` is called on the other thread when the planet is made. An empty `make` makes none.
  PlanetMaker(MakePlanet make, std::function<void()> notify)
      : make_(std::move(make)), notify_(std::move(notify)) {}
  ~PlanetMaker() { stop(); }

  // Begins once.
  void begin();
  // Returns true until the planet is taken, or its making has ended without one.
  bool is_making() const { return make_ || making_.valid(); }
  // Returns the share of the work that is done.
  double fraction() const { return *fraction_; }
  // Asks it to end as soon as it can, without a planet.
  void stop() { stop_.request_stop(); }
  bool is_stopped() const { return stop_.stop_requested(); }
  // Returns the planet once it is made, else nullopt. Throws if it could not be made.
  std::optional<ShownPlanet> take();

 private:
  MakePlanet make_;  // until it begins
  std::function<void()> notify_;
  std::shared_ptr<std::atomic<double>> fraction_ = std::make_shared<std::atomic<double>>(0.0);
  std::stop_source stop_;
  std::future<std::optional<ShownPlanet>> making_;
};

}  // namespace vpe::window
