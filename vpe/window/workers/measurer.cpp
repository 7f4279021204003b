#include "vpe/window/workers/measurer.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace vpe::window {

namespace {

bool are_same(const std::vector<mars::LonLat>& a, const std::vector<mars::LonLat>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](mars::LonLat p, mars::LonLat q) {
    return p.lon_deg == q.lon_deg && p.lat_deg == q.lat_deg;
  });
}

}  // namespace

Measurer::Measurer(std::shared_ptr<const paging::Surface> surface, std::function<void()> notify,
                   explore::OpenScene open_scene)
    : surface_(std::move(surface)),
      open_scene_(std::move(open_scene)),
      worker_(
          [this](const std::pair<std::uint64_t, MeasureRequest>& next) {
            return measure(next.first, next.second);
          },
          std::move(notify)) {}

std::uint64_t Measurer::request(MeasureRequest request) {
  worker_.request({++requested_, std::move(request)});
  return requested_;
}

Measured Measurer::measure(std::uint64_t number, const MeasureRequest& request) {
  Measured out;
  out.number = number;
  out.request = request;
  try {
    if (last_.profile != nullptr && are_same(last_.request.places, request.places)) {
      out.profile = last_.profile;
      out.ground = last_.ground;
    } else {
      out.profile = std::make_shared<const explore::Profile>(explore::make_profile(*surface_, request.places));
      out.ground = explore::ground_of_profile(*surface_, out.profile->points);
    }
    explore::SceneSight objects;
    if (open_scene_ && !request.scene.file.empty()) objects = open_scene_(request.scene);
    out.moves = objects.moves;
    out.sight = explore::line_of_sight(*surface_, {request.places.front(), request.from_height_m},
                                       {request.places.back(), request.to_height_m}, objects.first_object);
  } catch (const std::exception& e) {
    out.error = e.what();
  }
  last_ = out;
  return out;
}

}  // namespace vpe::window
