// When the viewer draws a view that moves with fewer pixels, and how tiles are taken and overlap then.
// Run: node tests/web/pace_test.js
'use strict';

const assert = require('node:assert');
const test = require('node:test');
const {near, cylinder, sphere, facets, maps, pyramidOf} = require('./helpers.js');

const {vpe} = globalThis;
const {Pace, kRest_ms} = vpe.pace;

// Moves a view for some frames, whose times are spacing(divisor, number). Returns the divisors and the time afterwards.
function move(pace, frames, spacing, from = 0) {
  const divisors = [];
  let time = from;
  for (let n = 0; n < frames; ++n) {
    pace.begin(time, true);
    divisors.push(pace.divisor);
    pace.drawn(time);
    time += spacing(pace.divisor, n);
  }
  pace.begin(time, false);
  return {divisors, time};
}
const most = (divisors) => Math.max(...divisors);

test('quick frames stay at full size, also with single slow ones', () => {
  assert.strictEqual(most(move(new Pace(), 300, () => 16.7).divisors), 1);
  assert.strictEqual(most(move(new Pace(), 300, () => 24.9).divisors), 1);
  assert.strictEqual(most(move(new Pace(), 300, (d, n) => (n % 3 === 0 ? 90 : 16.7)).divisors), 1);
});

test('slow frames halve the sides, never more, and rest brings full size back', () => {
  const pace = new Pace();
  const {divisors, time} = move(pace, 200, (divisor) => 45 / divisor ** 2);
  assert.deepStrictEqual([...new Set(divisors)], [1, 2]);
  assert.strictEqual(divisors.indexOf(2), 6);
  assert.ok(divisors.slice(6).every((divisor) => divisor === 2));
  assert.strictEqual(pace.divisor, 2);
  pace.begin(time + kRest_ms, false);
  assert.strictEqual(pace.divisor, 1);
});

test('rest has full size after any motion', () => {
  for (let frames = 1; frames < 60; ++frames) {
    for (const ms of [5, 30, 300, 2000]) {
      const pace = new Pace();
      const {time} = move(pace, frames, () => ms);
      pace.begin(time + kRest_ms, false);
      assert.strictEqual(pace.divisor, 1, `${frames} frames of ${ms} ms`);
    }
  }
});

test('the next motion is reduced sooner, but its first frames are not', () => {
  const pace = new Pace();
  const cost = (divisor) => 45 / divisor ** 2;
  const {time} = move(pace, 40, cost);
  pace.begin(time + 200, false);
  assert.strictEqual(move(pace, 30, cost, time + 3000).divisors.indexOf(2), 2);
  pace.begin(time + 20000, false);
  assert.strictEqual(move(pace, 30, cost, time + 40000).divisors.indexOf(2), 6);
});

test('where half the size is not faster, full size comes back and stays', () => {
  const pace = new Pace();
  const {divisors, time} = move(pace, 600, () => 33.3);
  assert.strictEqual(divisors.filter((divisor) => divisor === 2).length, 12);
  assert.ok(time < 60000 && divisors[599] === 1);
});

test('pauses do not count', () => {
  assert.strictEqual(most(move(new Pace(), 100, () => 1500).divisors), 1);
});

test('reduced drawings take coarser tiles where all are there, and fetch those of the screen too', () => {
  const map = cylinder(8192, 2048);
  const finder = new vpe.pyramid.TileFinder(pyramidOf(map), map);
  const view = new vpe.view.View(map, 1280, 720);
  view.setFov(50);
  const full = finder.select(view, () => true);
  assert.deepStrictEqual(finder.selectFor(view, () => true, 1), full);
  const half = finder.selectFor(view, () => true, 2);
  assert.ok(half.draw.every((tile) => tile.level === full.level + 1) && half.draw.length < full.draw.length);
  assert.strictEqual(half.want.length, 0);
  const only = finder.selectFor(view, (name) => name.startsWith(`${full.level}/`), 2);
  assert.deepStrictEqual(only.draw, full.draw);
  const none = finder.selectFor(view, () => false, 2).want.map(({name}) => name);
  assert.strictEqual(new Set(none).size, none.length);
  for (const {name} of [...full.wanted, ...half.draw]) assert.ok(none.includes(name), name);
});

test('neighbouring tiles overlap by a pixel, and the image has its own edges', () => {
  const {overlapping} = vpe.pyramid;
  for (const map of [...maps, cylinder(6000, 1910), sphere(300), facets(3, 700, 900, 20), {...cylinder(3000, 700), turn_px: 9000}]) {
    const pyramid = pyramidOf(map);
    const isClosed = vpe.projection.isClosed(map);
    for (let level = 0; level < pyramid.levels; ++level) {
      const side = 2 ** level;
      const {columns, rows} = vpe.pyramid.levelSize(pyramid, level);
      for (let column = 0; column < columns; ++column) {
        for (let row = 0; row < rows; ++row) {
          const tile = vpe.pyramid.tileAt(pyramid, map, level, column, row);
          const wide = overlapping(pyramid, map, tile);
          const at = `${map.kind} ${tile.name}`;
          near(tile.x0 - wide.x0, isClosed || column > 0 ? side / 2 : 0, 1e-9, `${at} left`);
          near(wide.x1 - tile.x1, isClosed || column + 1 < columns ? side / 2 : 0, 1e-9, `${at} right`);
          near(tile.y0 - wide.y0, row > 0 ? side / 2 : 0, 1e-9, `${at} above`);
          near(wide.y1 - tile.y1, row + 1 < rows ? side / 2 : 0, 1e-9, `${at} below`);
          // What is drawn lies in the tile's picture: half of its border.
          const {vertices} = vpe.webgl.meshOf(pyramid, map, tile);
          for (let n = 0; n < vertices.length; n += 5) {
            const [u, v] = [vertices[n + 3] * tile.width, vertices[n + 4] * tile.height];
            assert.ok(u > 0.49 && u < tile.width - 0.49 && v > 0.49 && v < tile.height - 0.49, `${at}: ${u}, ${v}`);
          }
        }
      }
    }
  }
});
