// Which tiles the viewer takes, where it draws their pixels, and how views are dragged.
// Run: node tests/web/tiles_test.js
'use strict';

const assert = require('node:assert');
const test = require('node:test');
const {near, generator, cylinder, sphere, facets, maps, pyramidOf} = require('./helpers.js');

const {vpe} = globalThis;
const {toPixel, isClosed, remainder} = vpe.projection;

test('a drag of 360 degrees has no jump', () => {
  for (const map of maps.slice(0, 3)) {
    for (const View of [vpe.view.View, vpe.flatView.FlatView]) {
      const view = new View(map, 800, 500);
      const start = view.yaw;
      let last = view.yaw;
      for (let turn = 0; turn < 40; ++turn) {
        const held = view.direction(700, 250);
        for (let x = 700; x >= 100; x -= 10) {
          view.hold(held, x, 250);
          assert.ok(view.yaw >= last - 1e-9 && view.yaw - last < 3, `${map.kind}: from ${last} to ${view.yaw}`);
          last = view.yaw;
        }
      }
      assert.ok(view.yaw - start > 720);
    }
  }
});

test('what is held stays under the pointer', () => {
  const random = generator(11);
  for (const map of maps) {
    for (const View of [vpe.view.View, vpe.flatView.FlatView]) {
      const view = new View(map, 1000, 600);
      view.setFov(15);
      for (let n = 0; n < 100; ++n) {
        const held = view.direction(500 + 100 * (random() - 0.5), 300 + 60 * (random() - 0.5));
        view.hold(held, 500 + 40 * (random() - 0.5), 300);
        const range = view.pitchRange();
        if (view.pitch <= range.low + 1e-9 || view.pitch >= range.high - 1e-9 || map.kind === 'plane') continue;
        const now = view.screen(held);
        assert.ok(Math.abs(now.y - 300) < 1e-6 * 600 || View === vpe.flatView.FlatView);
      }
    }
  }
});

test('tiles of a view hold every pixel that it shows', () => {
  const random = generator(3);
  for (const map of maps) {
    const pyramid = pyramidOf(map, 128);
    const finder = new vpe.pyramid.TileFinder(pyramid, map);
    for (let n = 0; n < 60; ++n) {
      const view = new vpe.view.View(map, 300 + 900 * random(), 300 + 500 * random());
      view.setFov(2 + 110 * random());
      view.lookAt(360 * random(), 180 * random() - 90);
      const level = vpe.pyramid.wantedLevel(pyramid, map, view);
      const names = new Set(finder.visible(view, level).map((tile) => tile.name));
      for (let k = 0; k < 200; ++k) {
        const at = toPixel(map, view.direction(view.width * random(), view.height * random()));
        if (at === null) continue;
        const side = 128 * 2 ** level;
        const column = Math.min(Math.floor(at.x / side), vpe.pyramid.levelSize(pyramid, level).columns - 1);
        const row = Math.min(Math.floor(at.y / side), vpe.pyramid.levelSize(pyramid, level).rows - 1);
        assert.ok(names.has(`${level}/${column}_${row}`), `${map.kind} ${level}/${column}_${row}`);
      }
    }
  }
});

test('a gigapixel needs few tiles', () => {
  const map = cylinder(60000, 17196);
  const finder = new vpe.pyramid.TileFinder(pyramidOf(map), map);
  for (const [width, height, density] of [[360, 640, 3], [1280, 720, 1], [3840, 2160, 1]]) {
    for (const fov of [1, 10, 60, 100]) {
      const view = new vpe.view.View(map, width, height, density);
      view.setFov(fov);
      view.lookAt(123, -5);
      const {want, draw} = finder.select(view, () => false);
      assert.strictEqual(draw.length, 0);
      assert.ok(want.length <= 160 && want.length > 0, `${width}x${height}, ${fov} degrees: ${want.length}`);
      assert.strictEqual(want[0].level, finder.pyramid.levels - 1);
    }
  }
});

test('missing tiles give way to coarser ones', () => {
  const map = cylinder(8192, 2048);
  const finder = new vpe.pyramid.TileFinder(pyramidOf(map), map);
  const view = new vpe.view.View(map, 1280, 720);
  view.setFov(20);
  const all = finder.select(view, () => true);
  assert.strictEqual(all.want.length, 0);
  assert.ok(all.wanted.every((tile) => all.draw.includes(tile)));
  const coarse = finder.select(view, (name) => name.startsWith('2/') || name === '4/0_0');
  assert.ok(coarse.draw.every((tile) => tile.level === 2) && coarse.want.every((tile) => tile.level < 2));
  // Nothing is drawn twice: the coarsest tile only where all others are missing.
  assert.ok(all.draw.every((tile) => tile.level === all.level));
  const hidden = all.wanted[0].name;
  const holed = finder.select(view, (name) => name !== hidden && (name.startsWith(`${all.level}/`) || name === '4/0_0'));
  assert.ok(holed.draw[0].level === 4 && holed.draw.length === all.draw.length);
});

// What a graphics processor draws: the mesh's triangles in clip coordinates, rounded to float32 as there.
function textureAt(pyramid, map, view, tile, x, y) {
  const {middle, vertices, indices} = vpe.webgl.meshOf(pyramid, map, tile);
  const uniforms = vpe.webgl.uniformsOf(view);
  const base = uniforms.middle(middle).map(Math.fround);
  const corner = (n) => {
    const o = vertices.subarray(5 * n, 5 * n + 3);
    const p = [0, 1, 2].map((r) => Math.fround(base[r] + [0, 1, 2].reduce((s, c) => s + uniforms.axes[3 * c + r] * o[c], 0)));
    return {p, u: vertices[5 * n + 3], v: vertices[5 * n + 4]};
  };
  const [sx, sy] = [(2 * x) / view.width - 1, 1 - (2 * y) / view.height];
  for (let n = 0; n < indices.length; n += 3) {
    const t = [corner(indices[n]), corner(indices[n + 1]), corner(indices[n + 2])];
    // (sx, sy) = sum of b_i p_i.xy / sum of b_i p_i.w: two linear equations for homogeneous weights.
    const rows = t.map(({p}) => [p[0] - sx * p[2], p[1] - sy * p[2]]);
    const cross = (a, b) => a[0] * b[1] - a[1] * b[0];
    const b = [cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])];
    const sum = b[0] + b[1] + b[2];
    if (sum === 0 || b.some((w) => w / sum < -1e-7)) continue;
    const w = t.reduce((s, {p}, k) => s + (b[k] / sum) * p[2], 0);
    if (w <= 0) continue;
    return {u: t.reduce((s, {u}, k) => s + (b[k] / sum) * u, 0), v: t.reduce((s, {v}, k) => s + (b[k] / sum) * v, 0)};
  }
  return null;
}

test('meshes show the right pixel', () => {
  const random = generator(5);
  for (const map of [...maps, cylinder(60000, 17196), sphere(300), cylinder(256, 90), facets(3, 700, 900, 20)]) {
    const pyramid = pyramidOf(map);
    const finder = new vpe.pyramid.TileFinder(pyramid, map);
    for (let n = 0; n < 12; ++n) {
      const view = new vpe.view.View(map, 800, 600);
      view.setFov([70, 30, 5, 1][n % 4]);
      view.lookAt(360 * random(), 100 * random() - 50);
      const level = vpe.pyramid.wantedLevel(pyramid, map, view);
      const side = 2 ** level;
      for (let k = 0; k < 6; ++k) {
        const [x, y] = [800 * random(), 600 * random()];
        const at = toPixel(map, view.direction(x, y));
        if (at === null) continue;
        const size = vpe.pyramid.levelSize(pyramid, level);
        const tile = finder.tile(level, Math.min(Math.floor(at.x / side / 512), size.columns - 1),
          Math.min(Math.floor(at.y / side / 512), size.rows - 1));
        const {u, v} = vpe.pyramid.placeInTile(pyramid, tile, at.x, at.y);
        const drawn = textureAt(pyramid, map, view, tile, x, y);
        assert.ok(drawn !== null, `${map.kind} ${map.width_px}: a hole at ${x}, ${y} of ${tile.name}`);
        // A tile of all of the circle overlaps itself.
        const aside = (drawn.u - u) * tile.width;
        near(size.columns === 1 && isClosed(map) ? remainder(aside, map.turn_px / side) : aside, 0, 0.25, `${map.kind} ${map.width_px} column ${tile.name}`);
        near(drawn.v * tile.height, v * tile.height, 0.25, `${map.kind} ${map.width_px} row ${tile.name}`);
      }
    }
  }
});

test('the flat view fills the screen with tiles', () => {
  const map = cylinder(6000, 1910, -180);
  const pyramid = pyramidOf(map);
  const view = new vpe.flatView.FlatView(map, 900, 500);
  for (const [yaw, fov] of [[0, 60], [179, 30], [-179.9, 10], [720, 1]]) {
    view.setFov(fov);
    view.lookAt(yaw, 0);
    const tiles = view.tiles(pyramid, view.level(pyramid));
    for (let x = 1; x < 900; x += 7) {
      assert.ok(tiles.some((t) => t.left <= x && x <= t.left + t.width && t.top <= 250 && 250 <= t.top + t.height), `${yaw} ${x}`);
    }
  }
});
