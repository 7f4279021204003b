#include "vpe/app/scene/model_ball.h"

#include <memory>
#include <utility>

#include "objects/files/model_file.h"
#include "objects/files/volume_model_file.h"
#include "objects/scene/model.h"
#include "objects/sticks/stick_file.h"

namespace vpe::app {

objects::Ball model_ball(const objects::ModelEntry& model) {
  const auto of_volume = [&](objects::VolumeModel volume) {
    return objects::Model(model.name, std::make_shared<const objects::VolumeModel>(std::move(volume))).ball();
  };
  if (model.formula) return of_volume(objects::volume_by_formula(*model.formula));
  if (objects::is_volume_path(model.file))
    return of_volume(objects::read_volume_model(model.file, {.unit_m = model.unit_m, .up = model.up}));
  if (model.file.extension() == ".sticks") {
    auto sticks = std::make_shared<const objects::StickModel>(objects::read_stick_file(model.file));
    return objects::Model(model.name, std::move(sticks)).ball();
  }
  return objects::bounding_ball(
      objects::read_model_file(model.file, {.unit_m = model.unit_m, .up = model.up}).mesh);
}

}  // namespace vpe::app
