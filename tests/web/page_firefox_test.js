// The web page in Firefox, from file:// and from a folder with blanks and letters beyond ASCII. With Xvfb it draws by WebGL,
// without it shows the picture flat. FIREFOX names the program; page_firefox_test.sh finds it. An argument names a page that
// vpe wrote.
'use strict';

const assert = require('node:assert');
const path = require('node:path');
const test = require('node:test');
const {pathToFileURL} = require('node:url');
const {Firefox, startDisplay} = require('./firefox.js');
const {describe, writePage, encodePng, decodePng} = require('./sample_page.js');

// Colours tell a pixel's place, in both eyes: red and green are the lower bytes of column and row, blue the higher ones.
const kWidth = 3000;
const kHeight = 900;
function tileOf(eye, level, column, row, width, height) {
  const side = 2 ** level;
  return encodePng(width + 2, height + 2, (i, j) => {
    const x = (((column * 512 + i - 1) * side + (side >> 1)) % kWidth + kWidth) % kWidth;
    const y = Math.min(Math.max((row * 512 + j - 1) * side + (side >> 1), 0), kHeight - 1);
    return eye === 'right' ? [255, 255, 0] : [x & 255, y & 255, (x >> 8) * 16 + (y >> 8)];
  });
}
const kSettled = 'vpe.current && vpe.current.frame === 0 && vpe.current.moving === null && ' +
  'vpe.current.loader.decoding.size === 0 && vpe.current.loader.queue.running.size === 0 && ' +
  'vpe.current.loader.queue.waiting.length === 0';

let browser;
let display;
async function open(folder, hash = '') {
  await browser.navigate('about:blank');
  browser.problems.length = 0;
  browser.requests.length = 0;
  await browser.navigate(`${pathToFileURL(path.join(folder, 'index.html'))}${hash}`);
  await browser.until(kSettled);
}
// Firefox warns of slow WebGL by software; that is not of the page.
function expectClean() {
  assert.deepStrictEqual(browser.problems.filter((text) => !/WebGL/.test(text)), []);
  assert.ok(browser.requests.every((url) => /^(file:|data:|blob:|about:)/.test(url)), browser.requests.join('\n'));
}
const view = () => browser.evaluate('({yaw: vpe.current.view.yaw, pitch: vpe.current.view.pitch, fov: vpe.current.view.fov})');

test.before(async () => {
  display = await startDisplay();
  browser = new Firefox(process.env.FIREFOX, display);
  await browser.open();
  await browser.resize(1280, 720);
});
test.after(async () => {
  if (browser) await browser.close();
  if (display) display.process.kill();
});

const sample = writePage(describe(kWidth, kHeight, {names: [], hotspots: []}), tileOf);

test('opens from disk, by WebGL where there is a display', async () => {
  await open(sample);
  assert.strictEqual(await browser.evaluate('vpe.current.hasWebGl'), display !== null);
  assert.strictEqual(await browser.evaluate('document.getElementById("notice").textContent'), '');
  expectClean();
});

test('the right pixel under 12 directions', async (t) => {
  if (display === null) return t.skip('no Xvfb, so no WebGL');
  await open(sample);
  for (let n = 0; n < 12; ++n) {
    const [x, y] = [20 + ((n * 249) % (kWidth - 40)), 160 + ((n * 67) % (kHeight - 320))];
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

test('the keyboard alone suffices', async () => {
  await open(sample);
  const start = await view();
  await browser.key('ArrowRight');
  await browser.key('ArrowUp');
  await browser.key('+');
  const turned = await view();
  assert.ok(turned.yaw !== start.yaw && turned.fov < start.fov, JSON.stringify({start, turned}));
  await browser.key('?');
  assert.ok(await browser.evaluate('document.getElementById("help").open'));
  await browser.key('Escape');
  await browser.until('!document.getElementById("help").open');
  await browser.key('Home');
  await browser.until(kSettled);
  assert.ok(Math.abs((await view()).fov - start.fov) < 1e-6);
  const reached = new Set();
  for (let n = 0; n < 30; ++n) {
    await browser.key('Tab');
    reached.add(await browser.evaluate('(document.activeElement.dataset || {}).command || document.activeElement.id'));
  }
  for (const name of ['zoomIn', 'zoomOut', 'home', 'link', 'help', 'download']) assert.ok(reached.has(name), name);
  expectClean();
});

test('the mouse turns, and the read-out is that of the planes', async () => {
  await open(sample, '#view=180,0,20');
  const held = await browser.evaluate('vpe.current.view.direction(700, 300)');
  await browser.drag([700, 300], [600, 300], [500, 300], [400, 310]);
  await browser.until(kSettled);
  const now = await browser.evaluate('vpe.current.view.direction(400, 310)');
  assert.ok(Math.abs(now.azimuth - held.azimuth) < 0.1 && Math.abs(now.elevation - held.elevation) < 0.1, JSON.stringify({held, now}));
  await browser.until('document.getElementById("readout").textContent.includes("Range")');
  const {pixel, values} = await browser.evaluate('vpe.current.readOutAt({x: 400, y: 310}, false)');
  assert.strictEqual(values.range_m, 1000 + 50 * Math.floor(pixel.x / 256));
  expectClean();
});

test('red-cyan glasses and side by side', async (t) => {
  if (display === null) return t.skip('no Xvfb, so no WebGL');
  await open(sample, '#view=90,2,30&stereo=side');
  let image = decodePng(await browser.screenshot());
  assert.deepStrictEqual(image.at(960, 300), [255, 255, 0]);
  assert.notDeepStrictEqual(image.at(320, 300), [255, 255, 0]);
  await open(sample, '#view=90,2,30&stereo=anaglyph');
  image = decodePng(await browser.screenshot());
  assert.deepStrictEqual(image.at(500, 300).slice(1), [255, 0]);
  expectClean();
});

test('a page that vpe wrote', {skip: process.argv.length < 3}, async () => {
  await open(path.resolve(process.argv[2]));
  await browser.key('ArrowRight');
  await browser.until(kSettled);
  expectClean();
});

test('without WebGL the picture is there', async () => {
  const plain = display === null ? browser : new Firefox(process.env.FIREFOX, null);
  try {
    if (plain !== browser) await plain.open();
    await plain.resize(1280, 720);
    await plain.navigate(`${pathToFileURL(path.join(sample, 'index.html'))}#view=90,0,30`);
    await plain.until(kSettled);
    assert.strictEqual(await plain.evaluate('vpe.current.hasWebGl'), false);
    assert.notDeepStrictEqual(decodePng(await plain.screenshot()).at(400, 300), [38, 40, 46]);
    assert.deepStrictEqual(plain.problems.filter((text) => !/WebGL/.test(text)), []);
  } finally {
    if (plain !== browser) await plain.close();
  }
});
