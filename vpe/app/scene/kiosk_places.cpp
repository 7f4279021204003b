#include "vpe/app/scene/kiosk_places.h"

#include <stdexcept>

#include "mars/geodesy/sphere.h"
#include "vpe/explore/files/hotspots.h"

namespace vpe::app {

std::vector<KioskPlace> kiosk_places(const objects::SceneFile& scene, double planet_radius_m) {
  std::vector<KioskPlace> out;
  const auto add = [&](const std::string& name, const mars::LonLat& place, const objects::KioskEntry& kiosk) {
    objects::Placing placing;
    placing.place = place;
    placing.heading_deg = kiosk.heading_deg;
    placing.scale = kiosk.size_m;
    out.push_back({name, placing});
  };
  for (const objects::KioskEntry& kiosk : scene.kiosks) {
    if (kiosk.hotspots.empty()) {
      add(kiosk.name, kiosk.place, kiosk);
      continue;
    }
    const explore::ParsedHotspots parsed = explore::load_hotspots(kiosk.hotspots);
    if (!parsed.errors.empty()) {
      throw std::runtime_error(to_string(parsed.errors.front()));
    }
    for (const explore::Hotspot& hotspot : parsed.hotspots)
      add(hotspot.name, mars::destination(hotspot.place, 0, kiosk.beside_m / planet_radius_m), kiosk);
  }
  return out;
}

}  // namespace vpe::app
