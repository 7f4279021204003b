// The tiles of the picture: levels, their sizes, and which tiles a view needs. No DOM.
//
// A pyramid is {width_px, height_px, tile_px, levels}. A pixel of level k covers 2^k x 2^k pixels of the image;
// level k has ceil(width / 2^k) columns. Tile (column, row) of a level begins at column * tile_px. Its picture has
// one more pixel on every side, so that colours can be interpolated across its edges. The last level is one tile.
// A tile is named LEVEL/COLUMN_ROW.
(function (vpe) {
  'use strict';

  const {isClosed, shownWidth, columnsPerRadian, surfacePoint, facetPx, kDeg} = vpe.projection;

  // Pixels of a level that a device pixel may be wide in the middle of the view: wider ones would flicker.
  const kWidest = 1.7;
  const kBorderPx = 1;

  const tileName = (level, column, row) => `${level}/${column}_${row}`;

  function levelSize(pyramid, level) {
    const side = 2 ** level;
    const width = Math.ceil(pyramid.width_px / side);
    const height = Math.ceil(pyramid.height_px / side);
    return {
      width, height,
      columns: Math.ceil(width / pyramid.tile_px),
      rows: Math.ceil(height / pyramid.tile_px),
    };
  }

  // Returns a tile: its name and place, the part of the image that it shows (x0, y0, x1, y1 in image pixels) and
  // the size of its picture in pixels of the level, with the border.
  function tileAt(pyramid, map, level, column, row) {
    const side = 2 ** level;
    const size = levelSize(pyramid, level);
    const t = pyramid.tile_px;
    const isLast = column === size.columns - 1;
    return {
      name: tileName(level, column, row), level, column, row,
      x0: column * t * side,
      y0: row * t * side,
      x1: isLast ? Math.max(column * t * side, shownWidth(map)) : (column + 1) * t * side,
      y1: Math.min((row + 1) * t * side, pyramid.height_px),
      width: Math.min(t, size.width - column * t) + 2 * kBorderPx,
      height: Math.min(t, size.height - row * t) + 2 * kBorderPx,
    };
  }

  // Returns the place in a tile's picture, 0..1 from the upper left corner, of a place in the image.
  function placeInTile(pyramid, tile, x, y) {
    const side = 2 ** tile.level;
    return {
      u: (kBorderPx + x / side - tile.column * pyramid.tile_px) / tile.width,
      v: (kBorderPx + y / side - tile.row * pyramid.tile_px) / tile.height,
    };
  }

  // Returns the level whose pixels are nearest to device pixels in the middle of a view, so that one of them is
  // at most kWidest pixels of the level wide. `density` is the number of device pixels to a CSS pixel.
  function wantedLevel(pyramid, map, view, density = view.density) {
    const onHorizon = Math.max(columnsPerRadian(map), map.focal_px);
    const ratio = map.kind === 'equirectangular' ? onHorizon : onHorizon / Math.max(Math.cos(view.pitch * kDeg), 0.25);
    const level = Math.floor(Math.log2(ratio / (view.focal() * density)) + Math.log2(2 / kWidest));
    return Math.min(Math.max(level, 0), pyramid.levels - 1);
  }

  // Returns places in the image of lines of cells over a tile, {xs, ys}, so that straight cells are within
  // kCellPx of the picture; for facets with the seams among the columns.
  const kCellPx = 0.05;
  const kMostCells = 64;
  function cellsOf(map, tile) {
    const side = 2 ** tile.level;
    const lines = (from, to, count) =>
      Array.from({length: count + 1}, (_, n) => (n === count ? to : from + ((to - from) * n) / count));
    const count = (length, cell) => Math.min(Math.max(Math.ceil(length / side / cell), 1), kMostCells);
    if (map.kind === 'plane') return {xs: [tile.x0, tile.x1], ys: [tile.y0, tile.y1]};
    if (map.kind === 'facets') {
      const w = facetPx(map);
      const first = Math.floor((tile.x0 + map.crop_left_px) / w) + 1;
      const xs = [tile.x0];
      for (let k = first; k * w - map.crop_left_px < tile.x1; ++k) xs.push(k * w - map.crop_left_px);
      xs.push(tile.x1);
      return {xs, ys: [tile.y0, tile.y1]};
    }
    const focal = Math.min(map.focal_px, columnsPerRadian(map)) / side;
    if (map.kind === 'equirectangular') {
      const cell = Math.min(32, Math.sqrt(16 * focal * kCellPx));
      return {
        xs: lines(tile.x0, tile.x1, count(tile.x1 - tile.x0, cell)),
        ys: lines(tile.y0, tile.y1, count(tile.y1 - tile.y0, cell)),
      };
    }
    // A chord of w columns moves rows at tan(elevation) T by w^2 T / (8 focal) pixels.
    const steepest = Math.max(Math.abs(map.horizon_px - tile.y0), Math.abs(map.horizon_px - tile.y1)) / map.focal_px;
    const cell = Math.min(128, Math.sqrt((8 * focal * kCellPx) / Math.max(steepest, 0.02)));
    return {xs: lines(tile.x0, tile.x1, count(tile.x1 - tile.x0, cell)), ys: [tile.y0, tile.y1]};
  }

  // Returns a tile whose part of the image is half a pixel of its level wider on all sides where the image goes on.
  // Neighbours then overlap, so that rounding leaves no hole between them; the borders of their pictures make both
  // show the same there.
  function overlapping(pyramid, map, tile) {
    const half = 0.5 * kBorderPx * 2 ** tile.level;
    const goesOn = isClosed(map);
    return {
      ...tile,
      x0: tile.x0 - (goesOn || tile.x0 > 0 ? half : 0),
      x1: tile.x1 + (goesOn || tile.x1 < shownWidth(map) ? half : 0),
      y0: tile.y0 - (tile.y0 > 0 ? half : 0),
      y1: tile.y1 + (tile.y1 < pyramid.height_px ? half : 0),
    };
  }

  const normalised = (v) => {
    const length = Math.hypot(v[0], v[1], v[2]);
    return [v[0] / length, v[1] / length, v[2] / length];
  };

  // Returns {axis, radius}: a cone of directions, radius in radians, that holds all of a tile.
  function coneOf(map, tile) {
    const kSteps = 16;
    const at = (i, j) => normalised(surfacePoint(map, tile.x0 + ((tile.x1 - tile.x0) * i) / kSteps,
      tile.y0 + ((tile.y1 - tile.y0) * j) / kSteps));
    const axis = at(kSteps / 2, kSteps / 2);
    let radius = 0;
    const include = (v) => {
      const across = Math.hypot(axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2],
        axis[0] * v[1] - axis[1] * v[0]);
      radius = Math.max(radius, Math.atan2(across, axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2]));
    };
    for (let n = 0; n <= kSteps; ++n) {
      for (const edge of [0, kSteps]) {
        include(at(n, edge));
        include(at(edge, n));
      }
    }
    // Edges of wide tiles bend away between the steps.
    const isWide = map.kind !== 'plane' && tile.x1 - tile.x0 > map.turn_px / 4;
    return {axis, radius: isWide ? Math.PI : 1.05 * radius};
  }

  // Returns the inward normals of the four sides of a view and its forward axis.
  function sidesOf(view) {
    const {right, up, forward} = view.axes();
    const side = (axis, sign, half) =>
      normalised([0, 1, 2].map((n) => forward[n] * half + sign * axis[n]));
    const across = (0.5 * view.width) / view.focal();
    const down = (0.5 * view.height) / view.focal();
    return [side(right, 1, across), side(right, -1, across), side(up, 1, down), side(up, -1, down), forward];
  }

  function isSeen(sides, cone) {
    if (cone.radius >= Math.PI / 2) return true;
    const reach = -Math.sin(cone.radius);
    return sides.every((n) => n[0] * cone.axis[0] + n[1] * cone.axis[1] + n[2] * cone.axis[2] >= reach);
  }

  // Finds tiles. Keeps what it has computed of tiles; it belongs to one pyramid.
  class TileFinder {
    constructor(pyramid, map) {
      this.pyramid = pyramid;
      this.map = map;
      this.known = new Map();
    }

    // Returns a tile with its cone. What is kept is bounded.
    tile(level, column, row) {
      const name = tileName(level, column, row);
      let tile = this.known.get(name);
      if (tile === undefined) {
        if (this.known.size > 20000) this.known.clear();
        tile = tileAt(this.pyramid, this.map, level, column, row);
        tile.cone = coneOf(this.map, tile);
        this.known.set(name, tile);
      }
      return tile;
    }

    // Returns the tiles of a level of which a view may show a part, nearest to its middle first.
    visible(view, level) {
      const sides = sidesOf(view);
      let tiles = [this.tile(this.pyramid.levels - 1, 0, 0)].filter((tile) => isSeen(sides, tile.cone));
      for (let k = this.pyramid.levels - 2; k >= level; --k) {
        const size = levelSize(this.pyramid, k);
        const finer = [];
        for (const parent of tiles) {
          for (let n = 0; n < 4; ++n) {
            const column = 2 * parent.column + (n % 2);
            const row = 2 * parent.row + (n >> 1);
            if (column >= size.columns || row >= size.rows) continue;
            const tile = this.tile(k, column, row);
            if (isSeen(sides, tile.cone)) finer.push(tile);
          }
        }
        tiles = finer;
      }
      const forward = sides[4];
      const off = ({cone}) => -(cone.axis[0] * forward[0] + cone.axis[1] * forward[1] + cone.axis[2] * forward[2]);
      return tiles.sort((a, b) => off(a) - off(b));
    }

    // Returns {draw, want, wanted}: tiles to draw, coarse ones first, of those that has(name) says are there, and tiles to
    // fetch, most urgent first: the coarsest one, then some two levels coarser than those of the view that are
    // missing, then these; `wanted` are all of the view. A tile that is missing is replaced by the finest coarser one. A level of more than `most`
    // tiles gives way to the next coarser one.
    select(view, has, {most = 160, density = view.density} = {}) {
      const last = this.pyramid.levels - 1;
      let level = wantedLevel(this.pyramid, this.map, view, density);
      let wanted = this.visible(view, level);
      while (wanted.length > most && level < last) wanted = this.visible(view, ++level);
      const draw = new Map();
      const middle = Math.min(level + 2, last);
      const coarse = new Map();
      for (const tile of wanted) {
        let {level: k, column, row} = tile;
        if (middle > level && !has(tile.name)) {
          const above = this.tile(middle, column >> (middle - level), row >> (middle - level));
          coarse.set(above.name, above);
        }
        while (k < last && !has(tileName(k, column, row))) {
          ++k;
          column >>= 1;
          row >>= 1;
        }
        draw.set(tileName(k, column, row), this.tile(k, column, row));
      }
      const here = [...draw.values()].filter((tile) => has(tile.name)).sort((a, b) => b.level - a.level);
      const inOrder = new Set([this.tile(last, 0, 0), ...coarse.values(), ...wanted]);
      return {level, draw: here, want: [...inOrder].filter((tile) => !has(tile.name)), wanted};
    }

    // Returns select() for a drawing of which the screen has `divisor` times as many pixels a side. It takes tiles
    // that suit its pixels where all of them are there, else those of the screen. Both are fetched.
    selectFor(view, has, divisor) {
      const full = this.select(view, has);
      if (divisor === 1) return full;
      const reduced = this.select(view, has, {density: view.density / divisor});
      const isWhole = reduced.wanted.every(({name}) => has(name));
      return {...full, draw: (isWhole ? reduced : full).draw, want: [...new Set([...reduced.want, ...full.want])]};
    }
  }

  // Keeps values by name and drops those that were used longest ago, beyond a number of them.
  class RecentlyUsed {
    constructor(capacity, dispose) {
      this.capacity = capacity;
      this.most = capacity;
      this.dispose = dispose;
      this.values = new Map();
    }

    has(name) {
      return this.values.has(name);
    }

    // Returns a value and counts it as used, or undefined.
    get(name) {
      const value = this.values.get(name);
      if (value !== undefined) {
        this.values.delete(name);
        this.values.set(name, value);
      }
      return value;
    }

    set(name, value) {
      this.values.set(name, value);
      this.trim();
    }

    // Keeps at least `needed` values from now on: all that one view shows.
    keep(needed) {
      this.most = Math.max(this.capacity, needed);
      this.trim();
    }

    trim() {
      for (const [name, value] of this.values) {
        if (this.values.size <= this.most) return;
        this.values.delete(name);
        this.dispose(value);
      }
    }
  }

  vpe.pyramid = {
    kBorderPx, tileName, levelSize, tileAt, placeInTile, wantedLevel, cellsOf, overlapping, coneOf, TileFinder,
    RecentlyUsed, isClosed,
  };
})((globalThis.vpe = globalThis.vpe || {}));
