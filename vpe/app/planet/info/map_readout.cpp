#include "vpe/app/planet/info/map_readout.h"

#include <algorithm>
#include <cmath>

#include "paging/surface/surface.h"
#include "vpe/app/planet/info/polar_map.h"
#include "vpe/base/number.h"
#include "vpe/report/page.h"

namespace vpe::app {

ElevationGrid elevation_grid(const std::shared_ptr<const paging::PlanetFile>& planet, std::size_t budget_bytes,
                             base::ThreadPool& pool) {
  const paging::PlanetMeta& meta = planet->meta();
  const paging::Surface surface(planet, budget_bytes);
  ElevationGrid grid;
  grid.width = static_cast<int>(std::lround(360 / kReadoutStep_deg));
  grid.height = grid.width / 2;
  grid.low_m = meta.lowest_radius_m - meta.radius_m;
  grid.step_m = std::max(meta.highest_radius_m - meta.lowest_radius_m, 1e-3) / (kReadoutNodata - 1);
  const auto columns = static_cast<std::size_t>(grid.width);
  grid.values.resize(columns * static_cast<std::size_t>(grid.height));
  pool.run(static_cast<std::size_t>(grid.height), [&](std::size_t y) {
    for (std::size_t x = 0; x < columns; ++x) {
      const paging::SurfacePoint at =
          surface.at(mars::direction({(static_cast<double>(x) + 0.5) * kReadoutStep_deg - 180,
                                      90 - (static_cast<double>(y) + 0.5) * kReadoutStep_deg}));
      const double value = std::round((at.height_m - grid.low_m) / grid.step_m);
      grid.values[y * columns + x] =
          at.nodata ? kReadoutNodata
                    : static_cast<std::uint16_t>(std::clamp(value, 0.0, double{kReadoutNodata - 1}));
    }
  });
  return grid;
}

std::string readout_markup(const ElevationGrid& grid) {
  std::vector<std::uint8_t> bytes;
  for (const std::uint16_t value : grid.values) {
    bytes.push_back(static_cast<std::uint8_t>(value & 0xFFU));
    bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
  }
  const std::string uri = report::data_uri(bytes);
  return "<div id=\"elevations\" hidden=\"hidden\" data-width=\"" + std::to_string(grid.width) +
         "\" data-height=\"" + std::to_string(grid.height) + "\" data-low=\"" +
         base::format_number(grid.low_m) + "\" data-step=\"" + base::format_number(grid.step_m) +
         "\" data-pole=\"" + base::format_number(kPolarLat_deg) + "\" data-values=\"" +
         uri.substr(uri.find("base64,")) + "\"></div>";
}

std::string readout_script() {
  return R"JS(
(function () {
  'use strict';
  var data = document.getElementById('elevations').dataset;
  var width = Number(data.width), height = Number(data.height);
  var low = Number(data.low), step = Number(data.step);
  var bytes = atob(data.values.slice(7));
  var degree = Math.PI / 180;
  var edge = Math.tan((90 - Number(data.pole)) / 2 * degree);
  function value(x, y) {
    var row = Math.max(0, Math.min(height - 1, y));
    var at = 2 * (row * width + (x % width + width) % width);
    var number = bytes.charCodeAt(at) + 256 * bytes.charCodeAt(at + 1);
    return number === 65535 ? NaN : low + step * number;
  }
  function elevation(lon, lat) {
    var x = (lon + 180) / 360 * width - 0.5, y = (90 - lat) / 180 * height - 0.5;
    var x0 = Math.floor(x), y0 = Math.floor(y), u = x - x0, v = y - y0;
    return (1 - v) * ((1 - u) * value(x0, y0) + u * value(x0 + 1, y0)) +
      v * ((1 - u) * value(x0, y0 + 1) + u * value(x0 + 1, y0 + 1));
  }
  function place(kind, x, y) {
    if (kind === 'plain') return [360 * x - 180, 90 - 180 * y];
    var right = 2 * x - 1, down = (2 * y - 1) * (kind === 'north' ? 1 : -1);
    var distance = Math.hypot(right, down);
    if (distance > 1) return null;
    var lat = 90 - 2 * Math.atan(distance * edge) / degree;
    return [Math.atan2(right, down) / degree, kind === 'north' ? lat : -lat];
  }
  function text(at) {
    var height = elevation(at[0], at[1]);
    return Math.abs(at[0]).toFixed(1) + '° ' + (0 > at[0] ? 'W' : 'E') + ', ' +
      Math.abs(at[1]).toFixed(1) + '° ' + (0 > at[1] ? 'S' : 'N') + ', ' +
      (isNaN(height) ? 'no data' : 'about ' + Math.round(height) + ' m');
  }
  document.querySelectorAll('[data-map]').forEach(function (map) {
    var line = document.createElement('p');
    line.className = 'readout';
    line.hidden = true;
    map.appendChild(line);
    map.addEventListener('pointermove', function (event) {
      var box = map.getBoundingClientRect();
      var at = place(map.dataset.map, (event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
      line.hidden = at === null;
      if (at !== null) line.textContent = text(at);
    });
    map.addEventListener('pointerleave', function () { line.hidden = true; });
  });
})();
)JS";
}

std::string readout_style() {
  return R"(
.readout { position: absolute; left: 0; bottom: 0; margin: 0; padding: .1rem .4rem; font-size: 13px; pointer-events: none;
  color: #fff; background: rgba(0, 0, 0, .75); font-variant-numeric: tabular-nums; }
@media print { .readout { display: none; } }
)";
}

}  // namespace vpe::app
