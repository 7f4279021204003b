// Writes pages as panorama/page/page_writer.cpp does, of pictures that are computed.
'use strict';

const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const zlib = require('node:zlib');
const {kFolder, kPure, kWithDom} = require('./viewer_files.js');

function chunk(kind, data) {
  const body = Buffer.concat([Buffer.from(kind, 'latin1'), data]);
  const out = Buffer.alloc(body.length + 8);
  out.writeUInt32BE(data.length, 0);
  body.copy(out, 4);
  out.writeUInt32BE(crc32(body), body.length + 4);
  return out;
}

const kCrc = Array.from({length: 256}, (_, n) => {
  let c = n;
  for (let k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
  return c >>> 0;
});
function crc32(bytes) {
  let c = 0xffffffff;
  for (const byte of bytes) c = kCrc[(c ^ byte) & 255] ^ (c >>> 8);
  return (c ^ 0xffffffff) >>> 0;
}

// Returns a PNG; colour(x, y) gives [red, green, blue].
function encodePng(width, height, colour) {
  const rows = Buffer.alloc(height * (3 * width + 1));
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) rows.set(colour(x, y), y * (3 * width + 1) + 1 + 3 * x);
  }
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, 2, 0, 0, 0], 8);
  return Buffer.concat([Buffer.from([0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10]), chunk('IHDR', head),
    chunk('IDAT', zlib.deflateSync(rows, {level: 1})), chunk('IEND', Buffer.alloc(0))]);
}

// Returns {width, height, at(x, y)} of a PNG of 8 bits, RGB or RGBA, not interlaced.
function decodePng(bytes) {
  const width = bytes.readUInt32BE(16);
  const height = bytes.readUInt32BE(20);
  const n = bytes[25] === 6 ? 4 : 3;
  const parts = [];
  for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at)) {
    if (bytes.toString('latin1', at + 4, at + 8) === 'IDAT') parts.push(bytes.subarray(at + 8, at + 8 + bytes.readUInt32BE(at)));
  }
  const raw = zlib.inflateSync(Buffer.concat(parts));
  const line = n * width;
  const out = Buffer.alloc(line * height);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (line + 1)];
    for (let x = 0; x < line; ++x) {
      const left = x < n ? 0 : out[y * line + x - n];
      const up = y === 0 ? 0 : out[(y - 1) * line + x];
      const corner = x < n || y === 0 ? 0 : out[(y - 1) * line + x - n];
      const p = left + up - corner;
      const [a, b, c] = [Math.abs(p - left), Math.abs(p - up), Math.abs(p - corner)];
      const paeth = a <= b && a <= c ? left : b <= c ? up : corner;
      const guess = [0, left, up, (left + up) >> 1, paeth][filter];
      out[y * line + x] = raw[y * (line + 1) + 1 + x] + guess;
    }
  }
  return {width, height, at: (x, y) => [...out.subarray(y * line + n * x, y * line + n * x + 3)]};
}

// Returns the description of a cylinder of a full circle for both eyes.
function describe(width, height, more = {}) {
  const levels = 1 + Math.max(0, Math.ceil(Math.log2(Math.max(width, height) / 512)));
  return {
    format: 1, title: 'A', has_north: true, picture: 'picture.png', eyes: ['left', 'right'],
    map: {kind: 'cylinder', width_px: width, height_px: height, turn_px: width, turn_azimuth_deg: 0, crop_left_px: 0,
      horizon_px: height / 2, focal_px: width / 2 / Math.PI, facets: 0},
    pyramid: {width_px: width, height_px: height, tile_px: 512, levels},
    layers: {step: 1, tile_px: 256, width, height, bands: [{name: 'range_m'}, {name: 'elevation_m'}]},
    names: [{text: 'Peak', azimuth_deg: 181, elevation_deg: 2, range_m: 12000}],
    hotspots: [{text: 'Rim', azimuth_deg: 185, elevation_deg: -1, range_m: 90, page: '../rim/index.html'}],
    ...more,
  };
}

// Writes a page and returns its folder, whose name has blanks and letters beyond ASCII. tileOf(eye, level, column, row,
// width, height) returns the PNG of a tile, whose size is that without border.
function writePage(data, tileOf) {
  const parent = fs.mkdtempSync(path.join(os.tmpdir(), 'vpe page ü '));
  process.on('exit', () => fs.rmSync(parent, {recursive: true, force: true}));
  const folder = path.join(parent, 'Gale – Süd');
  fs.mkdirSync(path.join(folder, 'viewer'), {recursive: true});
  for (const name of [...kPure, ...kWithDom, 'style.css']) {
    fs.copyFileSync(path.join(kFolder, name), path.join(folder, 'viewer', name));
  }
  const last = data.pyramid.levels - 1;
  const scripts = [...[...kPure, ...kWithDom.slice(0, -1)].map((name) => `viewer/${name}`), 'data.js',
    ...data.eyes.map((eye) => `tiles/${eye}/${last}/0_0.js`), 'viewer/main.js'];
  const html = fs.readFileSync(path.join(kFolder, 'template.html'), 'utf8')
    .replace('{{scripts}}', scripts.map((name) => `<script src="${name}"></script>`).join('\n'));
  fs.writeFileSync(path.join(folder, 'index.html'), html);
  fs.writeFileSync(path.join(folder, 'data.js'), `globalThis.vpeData = ${JSON.stringify(data)};\n`);
  for (const eye of data.eyes) {
    for (let level = 0; level <= last; ++level) {
      fs.mkdirSync(path.join(folder, 'tiles', eye, String(level)), {recursive: true});
      const width = Math.ceil(data.pyramid.width_px / 2 ** level);
      const height = Math.ceil(data.pyramid.height_px / 2 ** level);
      for (let x = 0; 512 * x < width; ++x) {
        for (let y = 0; 512 * y < height; ++y) {
          const name = `${eye}/${level}/${x}_${y}`;
          const png = tileOf(eye, level, x, y, Math.min(512, width - 512 * x), Math.min(512, height - 512 * y));
          fs.writeFileSync(path.join(folder, 'tiles', `${name}.js`), `vpeTile("${name}","image/png","${png.toString('base64')}");\n`);
        }
      }
    }
  }
  if (data.layers) writeLayers(folder, data.layers);
  return folder;
}

// Writes layers: range_m is 1000 + 50 times the column of the tile, elevation_m -100 times its row.
function writeLayers(folder, layers) {
  fs.mkdirSync(path.join(folder, 'layers'));
  for (let x = 0; 256 * x < layers.width; ++x) {
    for (let y = 0; 256 * y < layers.height; ++y) {
      const cells = Math.min(256, layers.width - x * 256) * Math.min(256, layers.height - y * 256);
      const band = (offset) => ({bytes: 1, offset, scale: 1, log: false, data: Buffer.alloc(cells, 1).toString('base64')});
      fs.writeFileSync(path.join(folder, 'layers', `${x}_${y}.js`),
        `vpeLayers("${x}_${y}",${JSON.stringify({range_m: band(1000 + 50 * x), elevation_m: band(-100 * y)})});\n`);
    }
  }
}

module.exports = {describe, writePage, encodePng, decodePng};
