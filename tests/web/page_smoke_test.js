// The whole viewer in a fake browser: what it loads, draws and says. VPE_PAGE=FOLDER takes a page that vpe wrote.
// Run: node tests/web/page_smoke_test.js
'use strict';

const assert = require('node:assert');
const fs = require('node:fs');
const path = require('node:path');
const test = require('node:test');
const {FakeBrowser} = require('./fake_browser.js');
const {describe, writePage} = require('./sample_page.js');

const writeSample = () => writePage(describe(3000, 900), () => Buffer.from('AAAA', 'base64'));
const folder = process.env.VPE_PAGE || writeSample();
const isOurs = !process.env.VPE_PAGE;

test('opens, draws and reads out, without errors', async () => {
  const browser = new FakeBrowser(folder);
  const page = browser.start();
  await browser.settle();
  assert.deepStrictEqual(browser.errors, []);
  assert.ok(browser.calls.some(([name]) => name === 'drawElements'));
  assert.strictEqual(browser.ids.get('notice').textContent, '');
  assert.ok(browser.ids.get('spoken').textContent.startsWith('Azimuth '));
  assert.match(browser.context.location.hash, /^#view=/);
  assert.ok(browser.loaded.filter((name) => name.startsWith('tiles/')).length <= 40);
  if (!isOurs) return;
  assert.match(browser.ids.get('readout').textContent, /Range 1\.25 km/);
  assert.match(browser.ids.get('scale-text').textContent, /at 1\.25 km/);
  assert.strictEqual(page.readOutAt(null, false).values.elevation_m, -100);
  assert.strictEqual(browser.ids.get('labels').children.length, 1);
  assert.strictEqual(browser.ids.get('hotspots').children[0].hidden, false);
});

test('a hotspot leads to a page with the heading of the view', {skip: !isOurs}, () => {
  const browser = new FakeBrowser(folder);
  const page = browser.start();
  const headingOf = (address) => Number(/#view=([^,]+),/.exec(address)[1]);
  const link = browser.ids.get('hotspots').children[0];
  assert.strictEqual(link.href, '../rim/index.html');
  for (const yaw of [170, 200]) {
    page.view.lookAt(yaw, 0);
    link.fire('pointerdown');
    assert.ok(link.href.startsWith('../rim/index.html#view='), link.href);
    assert.ok(Math.abs(headingOf(link.href) - yaw) < 0.01, link.href);
  }
  const inList = browser.ids.get('place-list').children[0].children.at(-1);
  page.view.lookAt(185, 0);
  inList.fire('click');
  assert.ok(Math.abs(headingOf(inList.href) - 185) < 0.01, inList.href);
});

test('a drag turns, the wheel and the keys zoom, all by keyboard', async () => {
  const browser = new FakeBrowser(folder, {isCalm: true});
  const page = browser.start();
  const {yaw, fov} = page.view;
  browser.pointer('down', 600, 300);
  browser.pointer('move', 500, 300);
  browser.pointer('up', 500, 300);
  assert.ok(page.view.yaw > yaw + 1);
  browser.ids.get('stage').fire('wheel', {deltaY: -100, deltaMode: 0, clientX: 640, clientY: 360});
  assert.ok(page.view.fov < fov);
  const before = page.view.yaw;
  browser.key('ArrowRight');
  assert.ok(page.view.yaw > before);
  browser.key('-');
  browser.key('?');
  assert.ok(browser.ids.get('help').open);
  browser.key('ArrowRight');  // the dialog has the keys
  browser.ids.get('help').close();
  for (const key of ['c', 'l', 'p', 'n', 'g', 'Home', 'u', 'f', 'm']) {
    browser.key(key);
    for (const id of ['places', 'link', 'help']) browser.ids.get(id).close();
    await browser.settle();
  }
  await browser.settle();
  assert.ok(Math.abs(page.view.pitch) < 40);
  assert.match(browser.ids.get('address').value, /#view=/);
  assert.deepStrictEqual(browser.errors, []);
});

test('two fingers zoom and hold', async () => {
  const browser = new FakeBrowser(folder, {width: 360, height: 640, density: 3});
  const page = browser.start();
  const touch = (id) => ({pointerType: 'touch', pointerId: id});
  const fov = page.view.fov;
  browser.pointer('down', 100, 300, touch(1));
  browser.pointer('down', 200, 300, touch(2));
  const held = page.view.direction(150, 300);
  browser.pointer('move', 50, 300, touch(1));
  browser.pointer('move', 250, 300, touch(2));
  assert.ok(page.view.fov < 0.7 * fov);
  const now = page.view.screen(held);
  assert.ok(Math.abs(now.x - 150) < 1);
  browser.pointer('up', 50, 300, touch(1));
  browser.pointer('up', 250, 300, touch(2));
  await browser.settle();
  assert.deepStrictEqual(browser.errors, []);
});

test('large screens, stereo, and a link to a view', {skip: !isOurs}, async () => {
  const browser = new FakeBrowser(folder, {width: 3840, height: 2160, hash: '#view=90,3,20&stereo=side'});
  const page = browser.start();
  assert.ok(Math.abs(page.view.yaw - 90) < 1e-9 && Math.abs(page.view.fov - 20) < 1e-9);
  assert.strictEqual(page.view.width, 1920);
  await browser.settle();
  const parts = browser.calls.filter(([name]) => name === 'viewport').map(([, x, , width]) => `${x}+${width}`);
  assert.ok(parts.includes('0+1920') && parts.includes('1920+1920'));
  assert.ok(browser.loaded.some((name) => name.startsWith('tiles/right/0/')));
  browser.key('s');
  browser.key('s');
  browser.calls.length = 0;
  await browser.settle();
  const masks = browser.calls.filter(([name]) => name === 'colorMask').map((call) => call.slice(1, 4).join());
  assert.ok(masks.includes('true,false,false') && masks.includes('false,true,true'));
  assert.match(browser.context.location.hash, /stereo=anaglyph/);
  assert.deepStrictEqual(browser.errors, []);
});

test('a gigapixel: only tiles in view are read, each once', {skip: !isOurs}, async () => {
  const giant = writePage(describe(60000, 17196, {layers: null, eyes: ['left']}), () => Buffer.from('AAAA', 'base64'));
  for (const [width, height, density] of [[3840, 2160, 1], [360, 640, 3]]) {
    const browser = new FakeBrowser(giant, {width, height, density, hash: '#view=123,-5,20'});
    const page = browser.start();
    await browser.settle();
    const tiles = browser.loaded.filter((name) => name.startsWith('tiles/'));
    assert.ok(tiles.length > 5 && tiles.length <= 170, `${width}: ${tiles.length}`);
    assert.strictEqual(new Set(tiles).size, tiles.length);
    assert.strictEqual(page.finder.select(page.view, (name) => page.renderer.has(`left/${name}`)).want.length, 0);
    // Textures of views that are gone are given back.
    for (let n = 0; n < 6; ++n) {
      page.view.lookAt(60 * n, -10);
      page.changed();
      await browser.settle();
    }
    assert.ok(browser.textures <= Math.max(64, 2 * page.finder.select(page.view, () => false).wanted.length + 16));
    assert.deepStrictEqual(browser.errors, []);
  }
});

test('without WebGL the picture is shown flat', async () => {
  const browser = new FakeBrowser(folder, {hasWebGl: false});
  const page = browser.start();
  await browser.settle();
  assert.deepStrictEqual(browser.errors, []);
  assert.ok(browser.ids.get('picture').hidden && !browser.ids.get('flat').hidden);
  assert.ok(browser.ids.get('flat').children.length >= 2);
  const {yaw} = page.view;
  browser.pointer('down', 600, 300);
  browser.pointer('move', 500, 300);
  assert.ok(page.view.yaw > yaw);
});

test('a missing tile is told, and asked for once', {skip: !isOurs}, async () => {
  const broken = writeSample();
  fs.rmSync(path.join(broken, 'tiles/left/1'), {recursive: true});
  fs.rmSync(path.join(broken, 'tiles/left/0'), {recursive: true});
  const browser = new FakeBrowser(broken);
  browser.start();
  await browser.settle();
  browser.key('ArrowRight');
  await browser.settle();
  assert.match(browser.ids.get('notice').textContent, /cannot be read/);
  assert.deepStrictEqual(browser.errors, []);
  assert.ok(browser.calls.some(([name]) => name === 'drawElements'));
});

test('a lost context comes back', async () => {
  const browser = new FakeBrowser(folder);
  browser.start();
  await browser.settle();
  browser.ids.get('picture').fire('webglcontextlost');
  browser.calls.length = 0;
  browser.ids.get('picture').fire('webglcontextrestored');
  await browser.settle();
  assert.ok(browser.calls.some(([name]) => name === 'drawElements'));
  assert.deepStrictEqual(browser.errors, []);
});

