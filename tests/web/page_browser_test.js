// The web page in headless Chromium, from file:// and from a folder with blanks and letters beyond ASCII.
// CHROMIUM names the program; page_browser_test.sh finds it. An argument names a page that vpe wrote.
'use strict';

const assert = require('node:assert');
const path = require('node:path');
const test = require('node:test');
const {pathToFileURL} = require('node:url');
const {Chromium} = require('./chromium.js');
const {describe, writePage, encodePng, decodePng} = require('./sample_page.js');

// Colours that tell a pixel's place: red and green are the lower bytes of column and row, blue the higher ones.
const kWidth = 3000;
const kHeight = 900;
const colourAt = (x, y) => [x & 255, y & 255, (x >> 8) * 16 + (y >> 8)];
function tileOf(eye, level, column, row, width, height) {
  const side = 2 ** level;
  return encodePng(width + 2, height + 2, (i, j) => {
    const x = (((column * 512 + i - 1) * side + (side >> 1)) % kWidth + kWidth) % kWidth;
    const y = Math.min(Math.max((row * 512 + j - 1) * side + (side >> 1), 0), kHeight - 1);
    return eye === 'right' ? [255, 255, 0] : colourAt(x, y);
  });
}
const bare = {names: [], hotspots: []};
const grey = encodePng(514, 514, () => [120, 120, 120]);
const kSettled = 'vpe.current && vpe.current.frame === 0 && vpe.current.moving === null && ' +
  'vpe.current.loader.decoding.size === 0 && vpe.current.loader.queue.running.size === 0 && ' +
  'vpe.current.loader.queue.waiting.length === 0';

let browser;
async function open(folder, hash = '') {
  browser.problems.length = 0;
  browser.requests.length = 0;
  await browser.send('Page.navigate', {url: 'about:blank'});
  await browser.send('Page.navigate', {url: `${pathToFileURL(path.join(folder, 'index.html'))}${hash}`});
  await browser.until(kSettled);
}
function expectClean() {
  assert.deepStrictEqual(browser.problems, []);
  assert.ok(browser.requests.every((url) => /^(file:|data:|blob:|about:)/.test(url)), browser.requests.join('\n'));
}
const view = () => browser.evaluate('({yaw: vpe.current.view.yaw, pitch: vpe.current.view.pitch, fov: vpe.current.view.fov})');

test.before(async () => {
  browser = new Chromium(process.env.CHROMIUM);
  await browser.open();
  await browser.resize(1280, 720);
});
test.after(async () => { await browser.close(); });

const sample = writePage(describe(kWidth, kHeight, bare), tileOf);

test('the right pixel under 20 directions', async () => {
  await open(sample);
  assert.ok(await browser.evaluate('vpe.current.hasWebGl'), 'no WebGL in this browser');
  for (let n = 0; n < 20; ++n) {
    const [x, y] = [20 + ((n * 149) % (kWidth - 40)), 160 + ((n * 67) % (kHeight - 320))];
    // Columns at which a byte turns over cannot be told after interpolation.
    const place = [x + 0.5, y + 0.5].map((v) => v + ((v & 255) < 4 ? 4 : 0) - ((v & 255) > 251 ? 4 : 0));
    await browser.evaluate(`(() => { const p = vpe.current, d = vpe.projection.toDirection(p.map, ${place});
      p.view.setFov(5); p.view.lookAt(d.azimuth, d.elevation); p.view.hold(d, 400.5, 250.5); p.changed(); })()`);
    await browser.until(kSettled);
    const expected = await browser.evaluate('vpe.projection.toPixel(vpe.current.map, vpe.current.view.direction(400.5, 250.5))');
    const [r, g, b] = decodePng(await browser.screenshot()).at(400, 250);
    const seen = [(b >> 4) * 256 + r + 0.5, (b & 15) * 256 + g + 0.5];
    assert.ok(Math.abs(seen[0] - expected.x) < 1 && Math.abs(seen[1] - expected.y) < 1, `${seen} is not ${expected.x},${expected.y}`);
  }
  expectClean();
});

test('the read-out is that of the planes', async () => {
  await open(sample, '#view=180,0,20');
  await browser.mouse('mouseMoved', 300, 200);
  await browser.until('document.getElementById("readout").textContent.includes("Range")');
  const {pixel, values} = await browser.evaluate('vpe.current.readOutAt({x: 300, y: 200}, false)');
  assert.strictEqual(values.range_m, 1000 + 50 * Math.floor(pixel.x / 256));
  assert.strictEqual(values.elevation_m, -100 * Math.floor(pixel.y / 256) || 0);
  expectClean();
});

test('the keyboard alone suffices', async () => {
  await open(sample);
  const start = await view();
  await browser.key('ArrowRight');
  await browser.key('ArrowUp');
  await browser.key('+');
  const turned = await view();
  assert.ok(turned.yaw > start.yaw && turned.fov < start.fov);
  await browser.key('?');
  assert.ok(await browser.evaluate('document.getElementById("help").open'));
  await browser.key('Escape');
  await browser.until('!document.getElementById("help").open');
  await browser.key('Home');
  await browser.until(kSettled);
  assert.ok(Math.abs((await view()).fov - start.fov) < 1e-6);
  // Every button is reached by Tab.
  const reached = new Set();
  for (let n = 0; n < 30; ++n) {
    await browser.key('Tab');
    reached.add(await browser.evaluate('(document.activeElement.dataset || {}).command || document.activeElement.id'));
  }
  for (const name of ['zoomIn', 'zoomOut', 'home', 'link', 'help', 'download']) assert.ok(reached.has(name), name);
  expectClean();
});

test('a drag of 360 degrees has no jump', async () => {
  await open(sample);
  let last = (await view()).yaw;
  const start = last;
  while (last - start < 365) {
    await browser.mouse('mousePressed', 1000, 300, {button: 'left', buttons: 1, clickCount: 1});
    for (let x = 1000; x >= 200; x -= 40) {
      await browser.mouse('mouseMoved', x, 300, {button: 'left', buttons: 1});
      const {yaw} = await view();
      assert.ok(yaw >= last - 1e-9 && yaw - last < 10, `from ${last} to ${yaw}`);
      last = yaw;
    }
    await browser.mouse('mouseReleased', 200, 300, {button: 'left', clickCount: 1});
  }
  // The picture goes on across the seam: no row of the screen is empty.
  const image = decodePng(await browser.screenshot());
  for (let x = 0; x < image.width; x += 5) assert.notDeepStrictEqual(image.at(x, 300), [38, 40, 46]);
  expectClean();
});

test('fingers turn and zoom, and the device turns', async () => {
  await browser.send('Emulation.setTouchEmulationEnabled', {enabled: true, maxTouchPoints: 2});
  await browser.send('DeviceOrientation.setDeviceOrientationOverride', {alpha: 90, beta: 90, gamma: 0});
  try {
    await open(sample, '#view=180,0,40');
    const touch = (type, ...places) => browser.send('Input.dispatchTouchEvent',
      {type, touchPoints: places.map(([x, y], id) => ({x, y, id}))});
    const at = (x, y) => browser.evaluate(`vpe.current.view.direction(${x}, ${y})`);
    // The browser hands on motions with its next frame.
    const isAt = (x, y, {azimuth, elevation}) => browser.until(`(() => { const d = vpe.current.view.direction(${x}, ${y});
      return Math.hypot(d.azimuth - ${azimuth}, d.elevation - ${elevation}) < 1e-3; })()`, 10);
    const held = await at(500, 300);
    await touch('touchStart', [500, 300]);
    await touch('touchMove', [400, 300]);
    await touch('touchMove', [300, 320]);
    await isAt(300, 320, held);
    await touch('touchEnd');

    const before = await view();
    const middle = await at(500, 300);
    await touch('touchStart', [400, 300], [600, 300]);
    await touch('touchMove', [350, 300], [650, 300]);
    await touch('touchMove', [300, 300], [700, 300]);
    // The same ground is under the fingers, which are twice as far apart.
    const zoomed = (Math.atan(Math.tan((before.fov * Math.PI) / 360) / 2) * 360) / Math.PI;
    await browser.until(`Math.abs(vpe.current.view.fov - ${zoomed}) < 1e-3`, 10);
    await isAt(500, 300, middle);
    await touch('touchEnd');

    // The view goes on from where it is, and turns by as much as the device.
    await browser.key('m');
    await browser.until('vpe.current.motion.isOn && vpe.current.motion.offset !== null');
    const upright = await view();
    await browser.send('DeviceOrientation.setDeviceOrientationOverride', {alpha: 60, beta: 100, gamma: 0});
    await browser.until(`Math.abs(vpe.current.view.yaw - ${upright.yaw}) > 1`);
    const turned = await view();
    assert.ok(Math.abs(turned.yaw - upright.yaw - 30) < 0.1, `${upright.yaw} to ${turned.yaw}`);
    assert.ok(Math.abs(turned.pitch - 10) < 0.1, `${turned.pitch}`);
    expectClean();
  } finally {
    await browser.send('DeviceOrientation.clearDeviceOrientationOverride');
    await browser.send('Emulation.setTouchEmulationEnabled', {enabled: false});
  }
});

test('small and large screens', async () => {
  for (const [width, height, density] of [[360, 640, 3], [3840, 2160, 1]]) {
    await browser.resize(width, height, density);
    await open(sample, '#view=90,2,30');
    const boxes = await browser.evaluate(`[...document.querySelectorAll('#stage, #bar, #readout')].map((e) => {
      const b = e.getBoundingClientRect(); return {id: e.id, left: b.left, right: b.right, top: b.top, bottom: b.bottom}; })`);
    for (const box of boxes) {
      assert.ok(box.left >= 0 && box.right <= width + 0.5 && box.bottom <= height + 0.5 && box.bottom > box.top, JSON.stringify(box));
    }
    assert.ok(boxes[0].bottom - boxes[0].top > 0.6 * height);
    expectClean();
  }
  await browser.resize(1280, 720);
});

test('red-cyan glasses and side by side', async () => {
  await open(sample, '#view=90,2,30&stereo=side');
  let image = decodePng(await browser.screenshot());
  assert.deepStrictEqual(image.at(960, 300), [255, 255, 0]);
  assert.notDeepStrictEqual(image.at(320, 300), [255, 255, 0]);
  await open(sample, '#view=90,2,30&stereo=anaglyph');
  image = decodePng(await browser.screenshot());
  assert.deepStrictEqual(image.at(500, 300).slice(1), [255, 0]);
  expectClean();
});

test('slow frames are drawn with fewer pixels, and the view at rest with all', async () => {
  await open(sample, '#view=200,1,40');
  const sharp = await browser.screenshot();
  const widths = await browser.evaluate(`(async () => { const p = vpe.current, widths = [];
    for (let n = 0; n < 12; ++n) { p.view.lookAt(195 + n, 1); p.changed();
      for (const end = performance.now() + 40; performance.now() < end;);
      await new Promise(requestAnimationFrame); widths.push(p.canvas.width); }
    p.view.lookAt(200, 1); p.changed(); return widths; })()`);
  assert.deepStrictEqual([...new Set(widths)], [1280, 640]);
  await browser.until(kSettled);
  assert.strictEqual(await browser.evaluate('vpe.current.canvas.width'), 1280);
  const [before, now] = [sharp, await browser.screenshot()].map(decodePng);
  for (let y = 30; y < 600; y += 7) {
    for (let x = 0; x < 1280; x += 7) assert.deepStrictEqual(now.at(x, y), before.at(x, y), `${x}, ${y}`);
  }
  expectClean();
});

test('a gigapixel opens within a second', async () => {
  const giant = writePage(describe(60000, 17196, {...bare, layers: null, eyes: ['left'], picture: ''}), () => grey);
  let first = Infinity;
  // Other programs on the machine may slow down one opening or another.
  for (let n = 0; n < 10 && first >= 1000; ++n) {
    await browser.send('Page.navigate', {url: 'about:blank'});
    browser.problems.length = 0;
    const start = Date.now();
    await browser.send('Page.navigate', {url: `${pathToFileURL(path.join(giant, 'index.html'))}`});
    await browser.until('vpe.current && vpe.current.frame === 0 && vpe.current.renderer.tiles.values.size > 0');
    first = Date.now() - start;
    await browser.until(kSettled);
    console.log(`# a gigapixel: first picture after ${first} ms, all after ${Date.now() - start} ms`);
  }
  assert.ok(first < 1000, `${first} ms`);
  assert.ok(await browser.evaluate('vpe.current.renderer.tiles.values.size') < 100);
  expectClean();
});

test('a page that vpe wrote', {skip: process.argv.length < 3}, async () => {
  await open(path.resolve(process.argv[2]));
  await browser.key('ArrowRight');
  await browser.until(kSettled);
  expectClean();
});

test('without WebGL the picture is there', async () => {
  const plain = new Chromium(process.env.CHROMIUM, ['--disable-3d-apis']);
  await plain.open();
  await plain.resize(1280, 720);
  await plain.send('Page.navigate', {url: `${pathToFileURL(path.join(sample, 'index.html'))}#view=90,0,30`});
  await plain.until(kSettled);
  assert.strictEqual(await plain.evaluate('vpe.current.hasWebGl'), false);
  assert.notDeepStrictEqual(decodePng(await plain.screenshot()).at(400, 300), [38, 40, 46]);
  assert.deepStrictEqual(plain.problems.filter((text) => !/WebGL/.test(text)), []);
  await plain.close();
});
