// Auxiliary layers: what lies under a pixel of the panorama, as range, place and height. No DOM.
//
// layers is {step, tile_px, width, height, bands}. Column c of the layers holds the values of the image's column
// c * step + floor(step / 2), rows likewise. Tile (column, row) begins at c = column * tile_px. A band of a tile is
// {bytes, offset, scale, log, data}: whole numbers of `bytes` bytes, little end first, row by row, in base64. 0 is
// no value; n > 0 is offset + scale * (n - 1), or with log exp() of that. bytes 0: no pixel of the tile has a value.
(function (vpe) {
  'use strict';

  const {clamp} = vpe.projection;

  // Returns the bytes of a base64 text.
  function bytesOf(base64) {
    const text = atob(base64);
    const bytes = new Uint8Array(text.length);
    for (let n = 0; n < text.length; ++n) bytes[n] = text.charCodeAt(n);
    return bytes;
  }

  // Returns a band whose numbers are unpacked to bytes.
  function unpack(band) {
    return {...band, data: band.bytes > 0 ? bytesOf(band.data) : null};
  }

  // Returns the value of a pixel of an unpacked band, or null.
  function valueAt(band, index) {
    if (band.bytes === 0) return null;
    let number = 0;
    for (let n = band.bytes - 1; n >= 0; --n) number = number * 256 + band.data[index * band.bytes + n];
    if (number === 0) return null;
    const value = band.offset + band.scale * (number - 1);
    return band.log ? Math.exp(value) : value;
  }

  // Returns where the layers hold the values of a place in the image: the tile's name, and the pixel's index in it.
  function layerPlace(layers, map, x, y) {
    const column = clamp(Math.floor(x), 0, map.width_px - 1);
    const row = clamp(Math.floor(y), 0, map.height_px - 1);
    const c = Math.min(Math.floor(column / layers.step), layers.width - 1);
    const r = Math.min(Math.floor(row / layers.step), layers.height - 1);
    const tileColumn = Math.floor(c / layers.tile_px);
    const tileRow = Math.floor(r / layers.tile_px);
    const width = Math.min(layers.tile_px, layers.width - tileColumn * layers.tile_px);
    return {
      name: `${tileColumn}_${tileRow}`,
      index: (r - tileRow * layers.tile_px) * width + (c - tileColumn * layers.tile_px),
    };
  }

  // Returns {name: value or null} of all bands at a place, from an unpacked tile.
  function valuesAt(layers, tile, index) {
    const values = {};
    for (const {name} of layers.bands) values[name] = tile[name] === undefined ? null : valueAt(tile[name], index);
    return values;
  }

  vpe.planes = {bytesOf, unpack, valueAt, layerPlace, valuesAt};
})((globalThis.vpe = globalThis.vpe || {}));
