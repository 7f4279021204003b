// Shows tiles without WebGL: images in boxes that the style sheet places.
(function (vpe) {
  'use strict';

  class FlatRenderer {
    constructor(box, pyramid, map) {
      this.box = box;
      this.pyramid = pyramid;
      this.map = map;
      this.tiles = new vpe.pyramid.RecentlyUsed(96, () => {});
      this.shown = new Map();
    }

    has(name) {
      return this.tiles.has(name);
    }

    add(name, tile, url) {
      this.tiles.set(name, url);
    }

    restore() {}

    // Returns names of the tiles that a view needs and that are not there, most urgent first.
    missing(view) {
      const levels = new Set([this.pyramid.levels - 1, view.level(this.pyramid)]);
      const names = new Set();
      for (const level of levels) {
        for (const {tile} of view.tiles(this.pyramid, level)) names.add(tile.name);
      }
      return [...names].filter((name) => !this.has(`left/${name}`));
    }

    draw(view) {
      const wanted = [...view.tiles(this.pyramid, this.pyramid.levels - 1),
        ...view.tiles(this.pyramid, view.level(this.pyramid))];
      this.tiles.keep(2 * wanted.length);
      const now = new Set();
      for (const place of wanted) {
        const url = this.tiles.get(`left/${place.tile.name}`);
        if (url === undefined) continue;
        now.add(place.id);
        this.put(place, url);
      }
      for (const [id, element] of this.shown) {
        if (now.has(id)) continue;
        element.remove();
        this.shown.delete(id);
      }
    }

    put(place, url) {
      let element = this.shown.get(place.id);
      if (element === undefined) {
        element = document.createElement('div');
        element.className = 'tile';
        const image = document.createElement('img');
        image.alt = '';
        image.draggable = false;
        image.src = url;
        element.appendChild(image);
        this.box.appendChild(element);
        this.shown.set(place.id, element);
      }
      const px = (value) => `${value.toFixed(2)}px`;
      Object.assign(element.style, {
        transform: `translate(${px(place.left)}, ${px(place.top)})`,
        width: px(place.width + 0.5),
        height: px(place.height + 0.5),
        zIndex: String(100 - place.tile.level),
      });
      Object.assign(element.firstChild.style, {
        left: px(-place.border),
        top: px(-place.border),
        width: px(place.pictureWidth),
        height: px(place.pictureHeight),
      });
    }
  }

  vpe.flatRenderer = {FlatRenderer};
})((globalThis.vpe = globalThis.vpe || {}));
