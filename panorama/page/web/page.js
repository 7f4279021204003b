// The page: joins view, tiles, layers, marks and input. Runs when everything else is there.
(function (vpe) {
  'use strict';

  const {toPixel} = vpe.projection;
  const {kStereoModes, decimalsFor, readOut, parseFragment, formatFragment} = vpe.text;
  const {TileFinder} = vpe.pyramid;

  const kTurn_ms = 500;
  const kLayers_ms = 120;
  const kRest_ms = 500;
  const kMostPixels = 3840 * 2160 * 2;

  const byId = (id) => document.getElementById(id);

  class Page {
    constructor(data) {
      this.data = data;
      this.map = data.map;
      this.stereo = 'off';
      this.pointer = null;
      this.frame = 0;
      this.isStale = false;
      this.drawnView = '';
      this.pace = new vpe.pace.Pace();
      this.restTimer = 0;
      this.layerTimer = 0;
      this.moving = null;
      this.stage = byId('stage');
      this.canvas = byId('picture');
      this.notice = new vpe.panel.Notice(byId('notice'));
      this.out = new vpe.panel.ReadOut({readout: byId('readout'), spoken: byId('spoken')});
      this.makeRenderer();
      this.makeLoaders();
      this.marks = new vpe.marks.Marks(data, {
        compass: byId('compass'), labels: byId('labels'), hotspots: byId('hotspots'), scale: byId('scale'),
        scaleText: byId('scale-text'),
      }, {focused: (mark) => this.look(vpe.marks.directionOf(mark)), seen: () => this.view});
      this.motion = new vpe.input.MotionInput(this);
      this.home = {yaw: this.view.yaw, pitch: this.view.pitch, fov: null};
      this.openFragment(location.hash);
    }

    makeRenderer() {
      const {pyramid} = this.data;
      let View = vpe.view.View;
      try {
        this.renderer = new vpe.webgl.WebGlRenderer(this.canvas, pyramid, this.map);
        this.hasWebGl = true;
      } catch (error) {
        this.hasWebGl = false;
        this.canvas.hidden = true;
        byId('flat').hidden = false;
        this.renderer = new vpe.flatRenderer.FlatRenderer(byId('flat'), pyramid, this.map);
        View = vpe.flatView.FlatView;
      }
      const {width, height, density} = this.screen();
      this.view = new View(this.map, width, height, density);
      this.finder = new TileFinder(pyramid, this.map);
      this.canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
      this.canvas.addEventListener('webglcontextrestored', () => {
        this.renderer.restore();
        this.changed();
      });
    }

    makeLoaders() {
      const failed = (name) => this.notice.show(
        `A part of the picture cannot be read (${name}). Copy the whole folder again.`, 20);
      this.loader = new vpe.loader.TileLoader({
        asUrls: !this.hasWebGl,
        failed,
        arrived: (name, picture) => {
          const [, level, column, row] = /\/(\d+)\/(\d+)_(\d+)$/.exec(name).map(Number);
          this.renderer.add(name, this.finder.tile(level, column, row), picture);
          this.changed();
        },
      });
      this.layers = this.data.layers
        ? new vpe.loader.LayerLoader(this.data.layers, {arrived: () => this.changed(), failed}) : null;
    }

    // Returns the size of the view in CSS pixels (of one eye), and device pixels to one of them.
    screen() {
      const width = Math.max(this.stage.clientWidth, 1);
      const height = Math.max(this.stage.clientHeight, 1);
      const density = Math.min(globalThis.devicePixelRatio || 1, Math.sqrt(kMostPixels / (width * height)));
      return {width: this.stereo === 'side' ? Math.floor(width / 2) : width, height, density, all: width};
    }

    resize() {
      const {width, height, density} = this.screen();
      this.view.resize(width, height, density);
      this.changed();
    }

    // Returns the place in the view of a pointer event. Both halves of a pair show the same view.
    toView(event) {
      const box = this.stage.getBoundingClientRect();
      const x = event.clientX - box.left;
      return {x: this.stereo === 'side' ? x % this.view.width : x, y: event.clientY - box.top};
    }

    // Draws before the next refresh. `isByKey`: the middle is what counts.
    changed(isByKey) {
      if (isByKey) byId('cross').hidden = false;
      this.isStale = true;
      this.wake();
    }

    wake() {
      this.nextFrame();
      clearTimeout(this.restTimer);
      this.restTimer = setTimeout(() => this.rest(), kRest_ms);
    }

    nextFrame() {
      if (this.frame === 0) this.frame = requestAnimationFrame((time) => this.tick(time));
    }

    // Reads out at a place of the view; null: at the middle.
    point(place) {
      this.pointer = place;
      byId('cross').hidden = place !== null;
      this.wake();
    }

    // Does what a frame needs. Frames follow one another until the picture is there at full size.
    tick(time) {
      this.frame = 0;
      if (this.moving !== null) this.step(time);
      const {view, pace} = this;
      const shown = `${view.yaw} ${view.pitch} ${view.fov}`;
      const isMoved = this.hasWebGl && shown !== this.drawnView;
      const {divisor} = pace;
      pace.begin(time, isMoved);
      if (this.isStale || pace.divisor !== divisor) this.draw();
      this.drawnView = shown;
      if (isMoved) pace.drawn(time);
      if (isMoved || pace.divisor > 1) this.nextFrame();
      this.out.showSoon(time, () => this.readOutAt(this.pointer, false).parts);
      clearTimeout(this.layerTimer);
      if (this.layers !== null) this.layerTimer = setTimeout(() => this.fetchLayers(), kLayers_ms);
    }

    draw() {
      this.isStale = false;
      if (this.hasWebGl) {
        this.drawTiles(this.pace.divisor);
      } else {
        this.renderer.draw(this.view);
        this.loader.want(this.renderer.missing(this.view).map((name) => `left/${name}`));
      }
      const middle = this.valuesAt(this.view.direction(this.view.width / 2, this.view.height / 2), false);
      this.marks.draw(this.view, {
        density: this.view.density, isBare: this.stereo === 'side', range: middle && middle.range_m,
      });
    }

    // Draws into a canvas of the view's device pixels divided by `divisor` a side.
    drawTiles(divisor) {
      const screen = this.screen();
      this.renderer.resize((screen.all * screen.density) / divisor, (screen.height * screen.density) / divisor);
      const eyes = this.stereo === 'off' ? ['left'] : ['left', 'right'];
      const whole = {x: 0, y: 0, width: this.canvas.width, height: this.canvas.height};
      const half = Math.floor(this.canvas.width / 2);
      const wanted = [];
      let needed = 0;
      const jobs = eyes.map((eye, n) => {
        const chosen = this.finder.selectFor(this.view, (name) => this.renderer.has(`${eye}/${name}`), divisor);
        needed += chosen.wanted.length + 8;
        wanted.push(...chosen.want.map((tile) => `${eye}/${tile.name}`));
        // Under all others, whenever one of them is missing.
        this.renderer.use(`${eye}/${this.data.pyramid.levels - 1}/0_0`);
        const part = this.stereo === 'side' ? {...whole, x: n * half, width: half} : whole;
        const colours = this.stereo === 'anaglyph' ? ['red', 'cyan'][n] : 'all';
        return {eye, tiles: chosen.draw, part, colours};
      });
      this.renderer.draw(this.view, jobs, 2 * needed);
      this.loader.want(wanted);
    }

    // Returns the values of the layers in a direction; null when they are not there (yet).
    valuesAt(direction, fetch) {
      if (this.layers === null) return null;
      const at = toPixel(this.map, direction);
      return at === null ? null : this.layers.valuesAt(this.map, at.x, at.y, fetch);
    }

    // Returns what is at a place of the view, null: its middle: {direction, pixel, values, parts}.
    readOutAt(place, fetch) {
      const {view} = this;
      const {x, y} = place || {x: view.width / 2, y: view.height / 2};
      const direction = view.direction(x, y);
      const values = this.valuesAt(direction, fetch);
      const decimals = decimalsFor(view.fov / view.height);
      const parts = readOut(direction, values, {decimals, hasNorth: this.data.has_north});
      return {direction, pixel: toPixel(this.map, direction), values, parts};
    }

    fetchLayers() {
      this.out.show(this.readOutAt(this.pointer, true).parts);
      if (this.pointer !== null && this.layers.queue.running.size === 0) this.readOutAt(null, true);
    }

    // Tells what is to be seen once the view rests.
    rest() {
      this.out.say(this.readOutAt(null, true).parts);
      const {yaw, pitch, fov} = this.view;
      this.fragment = formatFragment({yaw, pitch, fov, stereo: this.stereo});
      vpe.panel.setFragment(this.fragment);
    }

    openFragment(hash) {
      const found = parseFragment(hash);
      if (found.stereo) this.setStereo(found.stereo);
      if (found.fov) this.view.setFov(found.fov);
      if (found.yaw !== undefined) this.view.lookAt(found.yaw, found.pitch);
    }

    setStereo(mode) {
      const canDo = this.hasWebGl && this.data.eyes.length > 1;
      this.stereo = canDo ? mode : 'off';
      if (!canDo && mode !== 'off') {
        this.notice.show(this.hasWebGl ? 'This panorama is for one eye.' : 'Two eyes need WebGL, which is not there.');
      }
      this.resize();
    }

    // Turns to a direction, at once where less motion is preferred.
    look(direction, fov = this.view.fov) {
      const to = {yaw: direction.azimuth, pitch: direction.elevation, fov};
      const {yaw, pitch, fov: now} = this.view;
      this.moving = {from: {yaw, pitch, fov: now}, to, start: null};
      if (matchMedia('(prefers-reduced-motion: reduce)').matches) this.moving.start = -Infinity;
      this.point(null);
      byId('cross').hidden = false;
    }

    step(time) {
      const {moving} = this;
      if (moving.start === null) moving.start = time;
      const share = Math.min((time - moving.start) / kTurn_ms, 1);
      const now = vpe.view.between(moving.from, moving.to, share);
      this.view.setFov(now.fov);
      this.view.lookAt(now.yaw, now.pitch);
      if (share < 1) this.changed();
      else this.moving = null;
    }

    stopMoving() {
      this.moving = null;
    }

    hasDialog() {
      return document.querySelector('dialog[open]') !== null;
    }

    // Does what a key or button says.
    command(name) {
      const {view} = this;
      const middle = [view.width / 2, view.height / 2];
      const commands = {
        zoomIn: () => view.zoom(1.2, ...middle),
        zoomOut: () => view.zoom(1 / 1.2, ...middle),
        home: () => this.look({azimuth: this.home.yaw, elevation: this.home.pitch}, view.startFov()),
        north: () => this.look({azimuth: 0, elevation: view.pitch}),
        level: () => this.look({azimuth: view.yaw, elevation: 0}),
        stereo: () => this.setStereo(kStereoModes[(kStereoModes.indexOf(this.stereo) + 1) % 3]),
        compass: () => { this.marks.hasCompass = !this.marks.hasCompass; },
        names: () => { this.marks.hasNames = !this.marks.hasNames; },
        help: () => vpe.panel.toggleDialog(byId('help')),
        places: () => vpe.panel.toggleDialog(byId('places')),
        link: () => this.link(),
        fullScreen: () => vpe.panel.toggleFullScreen(byId('page')).then((text) => text && this.notice.show(text)),
        motion: () => this.motion.toggle().then((text) => {
          if (text) this.notice.show(text);
          vpe.buttons.refresh(this);
        }),
      };
      commands[name]();
      vpe.buttons.refresh(this);
      this.changed();
    }

    link() {
      const {yaw, pitch, fov} = this.view;
      const fragment = formatFragment({yaw, pitch, fov, stereo: this.stereo});
      vpe.panel.showLink(byId('link'), byId('address'), `${location.href.replace(/#.*$/, '')}#${fragment}`);
    }
  }

  vpe.page = {Page};
})((globalThis.vpe = globalThis.vpe || {}));
