// Balls around models, found on a thread of its own, as reading a model may take seconds.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "vpe/base/latest_worker.h"
#include "vpe/explore/objects/item_balls.h"

namespace vpe::window {

// Keeps the balls of all models that were asked for. For one calling thread at a time.
//
// Typical usage:
//   const objects::Ball ball = sizes.ball(model);   // of a metre, until it is known
//   if (sizes.update()) draw_again();
class ModelSizes {
 public:
  static constexpr float kUnknownRadius_m = 1;

  // Calls `measure` on the thread, once for each model, and then `notify`, which must not throw. An empty `measure`
  // leaves all models unknown.
  ModelSizes(explore::ModelBall measure, std::function<void()> notify);

  // Returns the ball of a model; one of kUnknownRadius_m around its origin until it is measured, and where it cannot be.
  objects::Ball ball(const objects::ModelEntry& model);
  // Takes over what was measured. Returns true if there is anything new.
  bool update();
  // Returns a number that grows with each model that is measured.
  std::uint64_t revision() const { return revision_; }
  // Returns why a model cannot be read, or "".
  std::string error(const objects::ModelEntry& model) const;
  bool is_at_rest() const { return worker_ == nullptr || (waiting_.empty() && worker_->is_idle()); }

 private:
  using Key = std::tuple<std::filesystem::path, double, objects::UpAxis>;
  struct Measured {
    objects::ModelEntry model;
    objects::Ball ball;
    std::string error;
  };
  static Key key_of(const objects::ModelEntry& model) { return {model.file, model.unit_m, model.up}; }
  void request_next();

  std::map<Key, Measured> known_;
  std::deque<objects::ModelEntry> waiting_;
  bool is_measuring_ = false;
  std::uint64_t revision_ = 0;
  std::unique_ptr<base::LatestWorker<objects::ModelEntry, Measured>> worker_;
};

}  // namespace vpe::window
