// Fetching of tiles and layers. Pages from disk may not read files, so every tile is a script that registers its
// data: vpeTile(name, type, base64) and vpeLayers(name, bands).
(function (vpe) {
  'use strict';

  const kAtOnce = 6;

  // Runs scripts, the most urgent ones first, a few at a time.
  class ScriptQueue {
    // failed(url) is called for a script that cannot be read.
    constructor(failed) {
      this.failed = failed;
      this.running = new Map();
      this.waiting = [];
      this.broken = new Set();
    }

    // Replaces the list of wanted scripts by [{url, done}], most urgent first. Those that have begun go on.
    want(requests) {
      this.waiting = requests.filter(({url}) => !this.running.has(url) && !this.broken.has(url));
      this.start();
    }

    start() {
      while (this.running.size < kAtOnce && this.waiting.length > 0) {
        const {url, done} = this.waiting.shift();
        if (this.running.has(url)) continue;
        const script = document.createElement('script');
        this.running.set(url, script);
        const end = (isDone) => {
          script.remove();
          this.running.delete(url);
          if (isDone) {
            done();
          } else {
            this.broken.add(url);
            this.failed(url);
          }
          this.start();
        };
        script.onload = () => end(true);
        script.onerror = () => end(false);
        script.async = true;
        script.src = url;
        document.head.appendChild(script);
      }
    }
  }

  // What the scripts registered, until it is taken.
  const registered = new Map();
  globalThis.vpeTile = (name, type, base64) => {
    registered.set(`tile ${name}`, {type, base64});
  };
  globalThis.vpeLayers = (name, bands) => {
    registered.set(`layers ${name}`, bands);
  };
  function take(key) {
    const value = registered.get(key);
    registered.delete(key);
    return value;
  }

  const dataUrl = ({type, base64}) => `data:${type};base64,${base64}`;

  function elementOf(picture) {
    return new Promise((resolve, reject) => {
      const image = new Image();
      image.onload = () => resolve(image);
      image.onerror = () => reject(new Error('a tile cannot be decoded'));
      image.src = dataUrl(picture);
    });
  }

  // Returns a promise of a decoded picture. Bitmaps are decoded beside the page's own work where browsers can.
  function decode(picture) {
    if (typeof createImageBitmap !== 'function' || typeof Blob !== 'function') return elementOf(picture);
    const blob = new Blob([vpe.planes.bytesOf(picture.base64)], {type: picture.type});
    return createImageBitmap(blob).catch(() => elementOf(picture));
  }

  // Fetches and decodes the tiles of both eyes. Names are EYE/LEVEL/COLUMN_ROW.
  class TileLoader {
    // arrived(name, picture) gets each tile; with `asUrls` the picture is a data: address, else a decoded one.
    constructor({arrived, failed, asUrls}) {
      this.arrived = arrived;
      this.failed = failed;
      this.asUrls = asUrls;
      this.decoding = new Set();
      this.queue = new ScriptQueue(failed);
    }

    want(names) {
      const wanted = names.filter((name) => !this.decoding.has(name));
      this.queue.want(wanted.map((name) => ({url: `tiles/${name}.js`, done: () => this.take(name)})));
    }

    // Takes a tile whose script has run. Returns false when there is none of that name.
    take(name) {
      const picture = take(`tile ${name}`);
      if (picture === undefined) return false;
      if (this.asUrls) {
        this.arrived(name, dataUrl(picture));
        return true;
      }
      this.decoding.add(name);
      decode(picture).then((decoded) => {
        this.decoding.delete(name);
        this.arrived(name, decoded);
      }, () => {
        this.decoding.delete(name);
        this.queue.broken.add(`tiles/${name}.js`);
        this.failed(name);
      });
      return true;
    }
  }

  // Fetches tiles of auxiliary layers and keeps the last ones.
  class LayerLoader {
    constructor(layers, {arrived, failed}) {
      this.layers = layers;
      this.arrived = arrived;
      this.queue = new ScriptQueue(failed);
      this.tiles = new vpe.pyramid.RecentlyUsed(24, () => {});
    }

    // Returns the values at a place in the image, or null while they are not there; with `fetch` they are then
    // fetched.
    valuesAt(map, x, y, fetch) {
      const place = vpe.planes.layerPlace(this.layers, map, x, y);
      const tile = this.tiles.get(place.name);
      if (tile !== undefined) return vpe.planes.valuesAt(this.layers, tile, place.index);
      if (fetch) this.queue.want([{url: `layers/${place.name}.js`, done: () => this.take(place.name)}]);
      return null;
    }

    take(name) {
      const bands = take(`layers ${name}`);
      if (bands === undefined) return;
      const tile = {};
      for (const [key, band] of Object.entries(bands)) tile[key] = vpe.planes.unpack(band);
      this.tiles.set(name, tile);
      this.arrived();
    }
  }

  vpe.loader = {ScriptQueue, TileLoader, LayerLoader};
})((globalThis.vpe = globalThis.vpe || {}));
