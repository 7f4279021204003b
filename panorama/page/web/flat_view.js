// The view of browsers without WebGL: the picture itself, unrolled, moved and enlarged but not bent. It has the
// members of View, so that everything else works with both. No DOM.
(function (vpe) {
  'use strict';

  const {clamp, remainder, toDirection, place, isClosed, columnsPerRadian} = vpe.projection;
  const {levelSize, tileAt, kBorderPx} = vpe.pyramid;

  class FlatView extends vpe.view.View {
    // Returns screen pixels for each pixel of the image.
    scale() {
      return this.focal() / columnsPerRadian(this.map);
    }

    // Returns the place in the image of the middle of the screen.
    middle() {
      return place(this.map, {azimuth: this.yaw, elevation: clamp(this.pitch, -89.999, 89.999)}) ||
        {x: 0.5 * this.map.width_px, y: this.map.horizon_px};
    }

    pitchRange() {
      const map = this.map;
      const half = (0.5 * this.height) / this.scale();
      const x = place(map, {azimuth: this.yaw, elevation: 0});
      const column = x === null ? 0 : x.x;
      if (2 * half >= map.height_px) {
        const pitch = toDirection(map, column, 0.5 * map.height_px).elevation;
        return {low: pitch, high: pitch};
      }
      return {
        low: toDirection(map, column, map.height_px - half).elevation,
        high: toDirection(map, column, half).elevation,
      };
    }

    direction(x, y) {
      const middle = this.middle();
      return toDirection(this.map, middle.x + (x - 0.5 * this.width) / this.scale(),
        middle.y + (y - 0.5 * this.height) / this.scale());
    }

    screen(direction) {
      if (Math.abs(direction.elevation) >= 90) return null;
      const at = place(this.map, direction);
      if (at === null) return null;
      const middle = this.middle();
      const across = this.map.kind === 'plane' ? at.x - middle.x : remainder(at.x - middle.x, this.map.turn_px);
      return {
        x: 0.5 * this.width + across * this.scale(),
        y: 0.5 * this.height + (at.y - middle.y) * this.scale(),
      };
    }

    hold(direction, x, y) {
      const now = this.screen(direction);
      if (now === null || !Number.isFinite(x + y)) return;
      const middle = this.middle();
      const to = toDirection(this.map, middle.x + (now.x - x) / this.scale(), middle.y + (now.y - y) / this.scale());
      this.lookAt(this.yaw + remainder(to.azimuth - this.yaw, 360), to.elevation);
    }

    // Returns the level whose pixels are nearest to those of the screen.
    level(pyramid) {
      const level = Math.floor(Math.log2(1 / (this.scale() * this.density)) + 0.25);
      return clamp(level, 0, pyramid.levels - 1);
    }

    // Returns the tiles of a level that the screen shows: {tile, left, top, width, height} in CSS pixels, of the
    // part without border; tiles of a closed image may come more than once.
    tiles(pyramid, level) {
      const map = this.map;
      const scale = this.scale();
      const middle = this.middle();
      const size = levelSize(pyramid, level);
      const side = 2 ** level;
      const step = pyramid.tile_px * side;
      const left = middle.x - (0.5 * this.width) / scale;
      const right = middle.x + (0.5 * this.width) / scale;
      const top = middle.y - (0.5 * this.height) / scale;
      const bottom = middle.y + (0.5 * this.height) / scale;
      const turn = isClosed(map) ? map.turn_px : Infinity;
      const firstCopy = Number.isFinite(turn) ? Math.floor(left / turn) : 0;
      const lastCopy = Number.isFinite(turn) ? Math.floor(right / turn) : 0;
      const found = [];
      for (let copy = firstCopy; copy <= lastCopy; ++copy) {
        const shift = copy === 0 ? 0 : copy * turn;
        const from = Math.max(Math.floor((left - shift) / step), 0);
        const to = Math.min(Math.floor((right - shift) / step), size.columns - 1);
        for (let column = from; column <= to; ++column) {
          const lowest = Math.min(Math.floor(bottom / step), size.rows - 1);
          for (let row = Math.max(Math.floor(top / step), 0); row <= lowest; ++row) {
            const tile = tileAt(pyramid, map, level, column, row);
            found.push({
              tile,
              id: `${tile.name}+${copy}`,
              left: (tile.x0 + shift - left) * scale,
              top: (tile.y0 - top) * scale,
              width: (tile.x1 - tile.x0) * scale,
              height: (tile.y1 - tile.y0) * scale,
              // Of the whole picture of the tile, which begins with the border.
              border: kBorderPx * side * scale,
              pictureWidth: tile.width * side * scale,
              pictureHeight: tile.height * side * scale,
            });
          }
        }
      }
      return found;
    }
  }

  vpe.flatView = {FlatView};
})((globalThis.vpe = globalThis.vpe || {}));
