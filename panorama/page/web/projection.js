// Maps between the pixels of a panorama and directions: the equations of panorama/projection.h.
//
// A map is an object with the fields of panorama::PanoramaMap: kind ('cylinder', 'equirectangular', 'facets'),
// width_px, height_px, turn_px, turn_azimuth_deg, crop_left_px, horizon_px, focal_px, facets. A single level
// picture has the kind 'plane' and middle_azimuth_deg, middle_px (column of that azimuth), horizon_px, focal_px.
// Directions are {azimuth, elevation} in degrees, clockwise from north and up. No DOM: node can test all of it.
(function (vpe) {
  'use strict';

  const kDeg = Math.PI / 180;
  // Bounds the distance by which rounding may push a place over an edge.
  const kEdgePx = 1e-8;

  // Returns a value in [0, period).
  function wrap(value, period) {
    let rest = value % period;
    if (rest < 0) rest += period;
    return rest < period ? rest : 0;
  }

  // Returns the equivalent of `value` nearest to 0.
  function remainder(value, period) {
    return value - period * Math.round(value / period);
  }

  function clamp(value, low, high) {
    return Math.min(Math.max(value, low), high);
  }

  function facetPx(map) {
    return map.turn_px / map.facets;
  }

  // Returns whether the left edge follows the right one, within a pixel, or overlaps it.
  function isClosed(map) {
    return map.kind !== 'plane' && map.width_px > map.turn_px - 1;
  }

  // Returns the width of the drawn part: at most one full circle. It ends at the seam when the map is closed.
  function shownWidth(map) {
    return isClosed(map) ? map.turn_px : map.width_px;
  }

  // Returns columns for each radian of azimuth on the horizon; of facets and planes in their middles.
  function columnsPerRadian(map) {
    return map.kind === 'facets' || map.kind === 'plane' ? map.focal_px : map.turn_px / (2 * Math.PI);
  }

  // Returns the direction of a place, azimuth in [0, 360). x and y may lie outside the image.
  function toDirection(map, x, y) {
    const rise = map.horizon_px - y;
    if (map.kind === 'plane') {
      const across = x - map.middle_px;
      return {
        azimuth: wrap(map.middle_azimuth_deg + Math.atan(across / map.focal_px) / kDeg, 360),
        elevation: Math.atan2(rise, Math.hypot(across, map.focal_px)) / kDeg,
      };
    }
    const column = wrap(x + map.crop_left_px, map.turn_px);
    if (map.kind === 'facets') {
      const facet = Math.min(Math.floor(column / facetPx(map)), map.facets - 1);
      const across = column - (facet + 0.5) * facetPx(map);
      return {
        azimuth: wrap(map.turn_azimuth_deg + ((facet + 0.5) * 360) / map.facets +
          Math.atan(across / map.focal_px) / kDeg, 360),
        elevation: Math.atan2(rise, Math.hypot(across, map.focal_px)) / kDeg,
      };
    }
    const elevation = map.kind === 'cylinder' ? Math.atan2(rise, map.focal_px) : rise / map.focal_px;
    return {
      azimuth: wrap(map.turn_azimuth_deg + (column * 360) / map.turn_px, 360),
      elevation: clamp(elevation / kDeg, -90, 90),
    };
  }

  // Returns {x, y} on an image without edges, x in [-crop_left_px, turn_px - crop_left_px); null for directions
  // beside or behind a plane.
  function place(map, direction) {
    const elevation = direction.elevation * kDeg;
    if (map.kind === 'plane') {
      const aside = remainder(direction.azimuth - map.middle_azimuth_deg, 360);
      if (Math.abs(aside) >= 90) return null;
      const across = map.focal_px * Math.tan(aside * kDeg);
      return {
        x: map.middle_px + across,
        y: map.horizon_px - Math.tan(elevation) * Math.hypot(across, map.focal_px),
      };
    }
    const fromStart = wrap((direction.azimuth % 360) - map.turn_azimuth_deg, 360);
    if (map.kind === 'facets') {
      const facetDeg = 360 / map.facets;
      const facet = Math.min(Math.floor(fromStart / facetDeg), map.facets - 1);
      const half = 0.5 * facetPx(map);
      const across = clamp(map.focal_px * Math.tan((fromStart - (facet + 0.5) * facetDeg) * kDeg), -half, half);
      return {
        x: facet * facetPx(map) + half + across - map.crop_left_px,
        y: map.horizon_px - Math.tan(elevation) * Math.hypot(across, map.focal_px),
      };
    }
    const rise = map.kind === 'cylinder' ? Math.tan(elevation) : elevation;
    return {
      x: (fromStart * map.turn_px) / 360 - map.crop_left_px,
      y: map.horizon_px - map.focal_px * rise,
    };
  }

  // Returns {x, y} where the image shows a direction, the leftmost of several columns; null where it does not.
  // A closed image that is narrower than the circle by a part of a pixel has no gap.
  function toPixel(map, direction) {
    if (!Number.isFinite(direction.azimuth) || !(Math.abs(direction.elevation) <= 90)) return null;
    if (map.kind !== 'equirectangular' && Math.abs(direction.elevation) === 90) return null;
    const at = place(map, direction);
    if (at === null) return null;
    if (map.kind !== 'plane') {
      if (at.x < -kEdgePx) at.x += map.turn_px;
      if (at.x >= map.turn_px - kEdgePx) at.x -= map.turn_px;
    }
    const right = isClosed(map) ? Math.max(map.width_px, map.turn_px) : map.width_px;
    if (at.x < -kEdgePx || at.y < -kEdgePx || at.x > right + kEdgePx || at.y > map.height_px + kEdgePx) {
      return null;
    }
    return {x: clamp(at.x, 0, map.width_px), y: clamp(at.y, 0, map.height_px)};
  }

  // Returns a point of the surface that carries the image, as [east, north, up]: rows and columns between
  // neighbouring points are straight there for cylinders (rows: up), facets and planes. Its direction is that
  // of (x, y). An x on a seam between facets belongs to `facet` when that is given.
  function surfacePoint(map, x, y, facet) {
    const rise = (map.horizon_px - y) / map.focal_px;
    if (map.kind === 'plane' || map.kind === 'facets') {
      let middle = map.middle_azimuth_deg;
      let across = x - map.middle_px;
      if (map.kind === 'facets') {
        const column = x + map.crop_left_px;
        const k = facet === undefined ? Math.floor(column / facetPx(map)) : facet;
        middle = map.turn_azimuth_deg + ((k + 0.5) * 360) / map.facets;
        across = column - (k + 0.5) * facetPx(map);
      }
      const s = Math.sin(middle * kDeg);
      const c = Math.cos(middle * kDeg);
      const u = across / map.focal_px;
      return [s + c * u, c - s * u, rise];
    }
    const azimuth = (map.turn_azimuth_deg + ((x + map.crop_left_px) * 360) / map.turn_px) * kDeg;
    if (map.kind === 'cylinder') return [Math.sin(azimuth), Math.cos(azimuth), rise];
    const elevation = clamp(rise, -Math.PI / 2, Math.PI / 2);
    const level = Math.cos(elevation);
    return [level * Math.sin(azimuth), level * Math.cos(azimuth), Math.sin(elevation)];
  }

  // Returns {low, high}: the elevations that the image shows at every one of its azimuths.
  function elevationsOf(map) {
    const up = map.horizon_px;
    const down = map.horizon_px - map.height_px;
    if (map.kind !== 'facets' && map.kind !== 'plane') {
      return {
        low: toDirection(map, 0, map.height_px).elevation,
        high: toDirection(map, 0, 0).elevation,
      };
    }
    // Rows of a plane bend towards the horizon at its sides.
    const side = map.kind === 'facets' ? 0.5 * facetPx(map)
      : Math.max(Math.abs(map.middle_px), Math.abs(map.width_px - map.middle_px));
    const corner = Math.hypot(side, map.focal_px);
    return {
      low: Math.atan2(down, down < 0 ? corner : map.focal_px) / kDeg,
      high: Math.atan2(up, up > 0 ? corner : map.focal_px) / kDeg,
    };
  }

  // Convert between directions and unit vectors [east, north, up].
  function toVector(direction) {
    const azimuth = (direction.azimuth % 360) * kDeg;
    const elevation = direction.elevation * kDeg;
    const level = Math.cos(elevation);
    return [level * Math.sin(azimuth), level * Math.cos(azimuth), Math.sin(elevation)];
  }

  function fromVector(v) {
    let azimuth = Math.atan2(v[0], v[1]) / kDeg;
    if (azimuth < 0) azimuth += 360;
    if (azimuth >= 360) azimuth = 0;
    return {azimuth, elevation: Math.atan2(v[2], Math.hypot(v[0], v[1])) / kDeg};
  }

  vpe.projection = {
    kDeg, wrap, remainder, clamp, facetPx, isClosed, shownWidth, columnsPerRadian, toDirection, place, toPixel,
    surfacePoint, elevationsOf, toVector, fromVector,
  };
})((globalThis.vpe = globalThis.vpe || {}));
