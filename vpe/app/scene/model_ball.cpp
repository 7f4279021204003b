#include "vpe/app/scene/model_ball.h"

#include <memory>

#include "objects/files/model_file.h"
#include "objects/scene/model.h"
#include "objects/sticks/stick_file.h"

namespace vpe::app {

objects::Ball model_ball(const objects::ModelEntry& model) {
  if (model.file.extension() == ".sticks") {
    auto sticks = std::make_shared<const objects::StickModel>(objects::read_stick_file(model.file));
    return objects::Model(model.name, std::move(sticks)).ball();
  }
  return objects::bounding_ball(
      objects::read_model_file(model.file, {.unit_m = model.unit_m, .up = model.up}).mesh);
}

}  // namespace vpe::app
