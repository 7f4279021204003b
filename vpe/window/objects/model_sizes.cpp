#include "vpe/window/objects/model_sizes.h"

#include <exception>

namespace vpe::window {

ModelSizes::ModelSizes(explore::ModelBall measure, std::function<void()> notify) {
  if (!measure) return;
  worker_ = std::make_unique<base::LatestWorker<objects::ModelEntry, Measured>>(
      [measure = std::move(measure)](const objects::ModelEntry& model) {
        Measured measured{model, {{0, 0, 0}, kUnknownRadius_m}, ""};
        try {
          measured.ball = measure(model);
        } catch (const std::exception& e) {
          measured.error = e.what();
        }
        return measured;
      },
      std::move(notify));
}

objects::Ball ModelSizes::ball(const objects::ModelEntry& model) {
  const auto [known, is_new] =
      known_.try_emplace(key_of(model), Measured{model, {{0, 0, 0}, kUnknownRadius_m}, ""});
  if (is_new && worker_ != nullptr) {
    waiting_.push_back(model);
    request_next();
  }
  return known->second.ball;
}

std::string ModelSizes::error(const objects::ModelEntry& model) const {
  const auto known = known_.find(key_of(model));
  return known == known_.end() ? "" : known->second.error;
}

// The worker would replace a request that waits.
void ModelSizes::request_next() {
  if (is_measuring_ || waiting_.empty()) return;
  is_measuring_ = true;
  worker_->request(std::move(waiting_.front()));
  waiting_.pop_front();
}

bool ModelSizes::update() {
  if (worker_ == nullptr) return false;
  auto measured = worker_->take();
  if (!measured) return false;
  is_measuring_ = false;
  const Key key = key_of(measured->model);
  known_.insert_or_assign(key, std::move(*measured));
  ++revision_;
  request_next();
  return true;
}

}  // namespace vpe::window
