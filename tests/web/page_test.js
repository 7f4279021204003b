// The viewer's mathematics against closed forms and against values of the C++ projection and viewer
// (reference_directions.json, which tests/panorama/page/page_reference_test.cpp compares with C++).
// Run: node tests/web/page_test.js
'use strict';

const assert = require('node:assert');
const fs = require('node:fs');
const path = require('node:path');
const test = require('node:test');
const {near, nearAzimuth, generator, cylinder, sphere, plane, maps} = require('./helpers.js');
const {kFolder, kPure, kWithDom} = require('./viewer_files.js');

const {vpe} = globalThis;
const {toDirection, toPixel, place, surfacePoint, fromVector, elevationsOf, remainder} = vpe.projection;
const reference = JSON.parse(fs.readFileSync(path.join(__dirname, 'reference_directions.json'), 'utf8'));

test('pixels and directions are those of C++', () => {
  for (const {map, pixels, directions, elevations} of reference) {
    for (const {x, y, azimuth, elevation} of pixels) {
      const d = toDirection(map, x, y);
      nearAzimuth(d.azimuth, azimuth, 1e-10, map.kind);
      near(d.elevation, elevation, 1e-10, map.kind);
    }
    for (const {azimuth, elevation, pixel} of directions) {
      const at = toPixel(map, {azimuth, elevation});
      assert.strictEqual(at === null, pixel === null, `${map.kind} ${azimuth} ${elevation}`);
      if (at === null) continue;
      near(at.x, pixel[0], 1e-7, map.kind);
      near(at.y, pixel[1], 1e-7, map.kind);
    }
    const range = elevationsOf(map);
    near(range.low, elevations[0], 1e-10, 'low');
    near(range.high, elevations[1], 1e-10, 'high');
  }
});

test('views are those of C++', () => {
  for (const {map, views} of reference) {
    for (const v of views) {
      const view = new vpe.view.View(map, v.width, v.height);
      view.setFov(v.fov);
      view.lookAt(v.yaw, v.pitch);
      const is = (expected, what) => {
        near(view.yaw, expected[0], 1e-8, what);
        near(view.pitch, expected[1], 1e-8, what);
        near(view.fov, expected[2], 1e-10, what);
      };
      is(v.is, 'look');
      const d = view.direction(0.25 * v.width, 0.7 * v.height);
      nearAzimuth(d.azimuth, v.direction[0], 1e-9, 'direction');
      near(d.elevation, v.direction[1], 1e-9, 'direction');
      const at = view.screen({azimuth: v.yaw + 11, elevation: v.pitch - 4});
      assert.strictEqual(at === null, v.screen === undefined);
      if (at !== null) {
        near(at.x, v.screen[0], 1e-6 * (1 + Math.abs(at.x)), 'screen');
        near(at.y, v.screen[1], 1e-6 * (1 + Math.abs(at.y)), 'screen');
      }
      view.zoom(1.7, 0.8 * v.width, 0.3 * v.height);
      is(v.zoomed, 'zoom');
      view.hold({azimuth: v.yaw + 5, elevation: v.pitch + 2}, 0.1 * v.width, 0.9 * v.height);
      is(v.held, 'hold');
    }
  }
});

test('closed forms: cylinder, sphere, plane', () => {
  const round = cylinder(3600, 1000);
  assert.deepStrictEqual(toPixel(round, {azimuth: 90, elevation: 0}), {x: 900, y: 500});
  near(toPixel(round, {azimuth: 0, elevation: 40}).y, 500 - (3600 / 2 / Math.PI) * Math.tan(40 * Math.PI / 180), 1e-9, 'y');
  near(toPixel(sphere(3600), {azimuth: 12, elevation: -45}).y, 1350, 1e-9, 'y');
  near(place(plane, {azimuth: 20, elevation: 0}).x, 400 + 700 * Math.tan(Math.PI / 6), 1e-9, 'x');
  assert.strictEqual(place(plane, {azimuth: 170, elevation: 0}), null);
  assert.strictEqual(toPixel(plane, {azimuth: 60, elevation: 0}), null);
});

test('places come back, and surface points lie in their directions', () => {
  const random = generator(7);
  for (const map of maps) {
    for (let n = 0; n < 500; ++n) {
      const [x, y] = [random() * map.width_px, random() * map.height_px];
      const d = toDirection(map, x, y);
      if (Math.abs(d.elevation) > 85) continue;
      const at = toPixel(map, d);
      near(at.x, x, 1e-7, map.kind);
      near(at.y, y, 1e-7, map.kind);
      const s = fromVector(surfacePoint(map, x, y));
      nearAzimuth(s.azimuth, d.azimuth, 1e-9, map.kind);
      near(s.elevation, d.elevation, 1e-9, map.kind);
    }
  }
});

test('layers come back within half a step', () => {
  const pack = (numbers, bytes) => Buffer.from(numbers.flatMap((n) =>
    Array.from({length: bytes}, (_, k) => Math.floor(n / 256 ** k) % 256))).toString('base64');
  const band = vpe.planes.unpack({bytes: 3, offset: -10, scale: 0.5, log: false, data: pack([0, 1, 70001], 3)});
  assert.deepStrictEqual([0, 1, 2].map((n) => vpe.planes.valueAt(band, n)), [null, -10, 34990]);
  const log = vpe.planes.unpack({bytes: 2, offset: Math.log(2), scale: 2e-4, log: true, data: pack([1, 5001], 2)});
  near(vpe.planes.valueAt(log, 1), 2 * Math.E, 1e-12, 'log');
  assert.strictEqual(vpe.planes.valueAt(vpe.planes.unpack({bytes: 0}), 3), null);
  const layers = {step: 2, tile_px: 256, width: 300, height: 100, bands: [{name: 'a'}]};
  const map = {width_px: 600, height_px: 200};
  assert.deepStrictEqual(vpe.planes.layerPlace(layers, map, 514.9, 3.2), {name: '1_0', index: 1 * 44 + 1});
  assert.deepStrictEqual(vpe.planes.layerPlace(layers, map, 600, 200), {name: '1_0', index: 99 * 44 + 43});
});

test('fragments come back', () => {
  const {formatFragment, parseFragment} = vpe.text;
  const random = generator(9);
  for (let n = 0; n < 300; ++n) {
    const view = {yaw: 2000 * random() - 1000, pitch: 180 * random() - 90, fov: 120 * random() ** 4 + 0.001, stereo: 'anaglyph'};
    const back = parseFragment(`#${formatFragment(view)}`);
    nearAzimuth(back.yaw, view.yaw, view.fov / 10000, 'yaw');
    near(back.pitch, view.pitch, view.fov / 10000, 'pitch');
    near(back.fov, view.fov, 1e-4 * view.fov, 'fov');
    assert.strictEqual(back.stereo, 'anaglyph');
  }
  for (const wrong of ['', '#', '#view=', '#view=1', '#view=a,b', '#view=1,95', '#view=1,2,-3', '#stereo=x', '#%%%', '#view=1,,3']) {
    const {fov, stereo} = parseFragment(wrong);
    assert.ok(fov === undefined && stereo === undefined, wrong);
  }
});

test('another panorama opens with the same heading', () => {
  const {pageInView, parseFragment} = vpe.text;
  const random = generator(10);
  for (let n = 0; n < 100; ++n) {
    const view = {yaw: 720 * random() - 360, pitch: 100 * random() - 50, fov: 100 * random() + 0.1, stereo: 'side'};
    const address = pageInView('../rim/index.html', view, true);
    assert.ok(address.startsWith('../rim/index.html#'));
    const there = parseFragment(address.replace(/^[^#]*/, ''));
    nearAzimuth(there.yaw, view.yaw, view.fov / 10000, 'yaw');
    near(there.pitch, view.pitch, view.fov / 10000, 'pitch');
    assert.strictEqual(there.stereo, undefined);  // the other one may be for one eye
  }
  assert.strictEqual(pageInView('a.html', {yaw: 5, pitch: 0, fov: 60}, false), 'a.html');
});

test('texts', () => {
  const {lengthText, azimuthText, placeText, readOut, niceStep} = vpe.text;
  assert.strictEqual(lengthText(3.456), '3.46 m');
  assert.strictEqual(lengthText(12345.6), '12.35 km');
  assert.strictEqual(azimuthText(359.99, 1, true), '0.0° N');
  assert.strictEqual(placeText(-59.2, -13.7), '13.700000° S, 59.200000° W');
  assert.deepStrictEqual([0.3, 1, 4.9, 5, 99].map(niceStep), [0.2, 1, 2, 5, 50]);
  const parts = readOut({azimuth: 10, elevation: -0.001}, {range_m: 1500, lon_deg: 1, lat_deg: 2, elevation_m: -4400.06},
    {decimals: 2, hasNorth: false});
  assert.deepStrictEqual(parts, [['Azimuth', '10.00°'], ['Elevation', '0.00°'],
    ['Place', '2.000000° N, 1.000000° E'], ['Range', '1.50 km'], ['Height', '\u22124400.1 m']]);
  assert.strictEqual(readOut({azimuth: 1, elevation: 2}, {range_m: null}, {decimals: 0, hasNorth: true})[2][0], 'Here');
});

test('marks of azimuth lie at their azimuths and do not crowd', () => {
  for (const fov of [100, 60, 20, 3, 0.2, 0.01]) {
    const view = new vpe.view.View(cylinder(800000, 200000), 1000, 600);
    view.setFov(fov);
    view.lookAt(-350.123, 3);
    const marks = vpe.text.compassMarks(view, true);
    assert.ok(marks.length >= 2 && marks.length <= 16, `${fov}: ${marks.length}`);
    for (let n = 1; n < marks.length; ++n) assert.ok(marks[n].x - marks[n - 1].x > 40);
    const number = marks.find(({text}) => text.endsWith('\u00b0'));
    if (number) nearAzimuth(view.direction(number.x, 300).azimuth, parseFloat(number.text), 1e-6, 'mark');
  }
});

test('the scale bar is as long as it says', () => {
  const view = new vpe.view.View(sphere(4096), 1000, 600);
  const {px, text} = vpe.text.scaleBar(view, 1000);
  const degrees = parseFloat(text);
  const a = view.direction(500 - px / 2, 300);
  const b = view.direction(500 + px / 2, 300);
  near(Math.abs(remainder(a.azimuth - b.azimuth, 360)), degrees, 1e-9, 'degrees');
  assert.ok(px <= 160 && text.includes('at 1.00 km'));
});

test('sensors: upright to the north, west, and up', () => {
  const {deviceDirection} = vpe.view;
  nearAzimuth(deviceDirection(0, 90, 0).azimuth, 0, 1e-9, 'north');
  nearAzimuth(deviceDirection(90, 90, 0).azimuth, 270, 1e-9, 'west');
  near(deviceDirection(30, 120, 0).elevation, 30, 1e-9, 'up');
  near(deviceDirection(0, 0, 0).elevation, -90, 1e-9, 'on a table');
});

test('labels do not overlap', () => {
  const random = generator(21);
  const labels = Array.from({length: 200}, () => ({x: 900 * random(), y: 500 * random(), width: 40 + 80 * random()}));
  const placed = vpe.text.layOutLabels(labels, {height: 500});
  assert.ok(placed.length > 20 && placed.length < 200);
  for (const a of placed) {
    for (const b of placed) {
      if (a === b) continue;
      assert.ok(Math.abs(a.x - b.x) >= (a.width + b.width) / 2 || Math.abs(a.top - b.top) >= 20);
    }
  }
});

test('the files need no network, are small, and have no other addresses', () => {
  const names = [...kPure, ...kWithDom, 'template.html', 'style.css'];
  let bytes = 0;
  for (const name of names) {
    const text = fs.readFileSync(path.join(kFolder, name), 'utf8');
    bytes += Buffer.byteLength(text);
    for (const word of ['http:', 'https:', 'fetch(', 'XMLHttpRequest', 'import ', 'require(', 'eval(', '@import', 'url(']) {
      assert.ok(!text.includes(word), `${name} has '${word}'`);
    }
    assert.ok(text.split('\n').length < 300, `${name} is long`);
  }
  assert.ok(bytes <= 150000, `${bytes} bytes`);
  assert.deepStrictEqual(fs.readdirSync(kFolder).sort(), names.sort());
});
