// Mouse, touch, pen, wheel, keyboard and sensors. They change the view and give commands to the page.
(function (vpe) {
  'use strict';

  const {remainder} = vpe.projection;

  const kNotch = 1.2;

  // `page` has view, toView(event) (place in the view), changed(), stopMoving(), point(place or null) and
  // command(name).
  class PointerInput {
    constructor(stage, page) {
      this.page = page;
      this.stage = stage;
      this.down = new Map();
      stage.addEventListener('pointerdown', (event) => this.begin(event));
      stage.addEventListener('pointermove', (event) => this.move(event));
      for (const kind of ['pointerup', 'pointercancel', 'lostpointercapture']) {
        stage.addEventListener(kind, (event) => this.end(event));
      }
      stage.addEventListener('pointerleave', () => {
        if (this.down.size === 0) page.point(null);
      });
      stage.addEventListener('wheel', (event) => this.wheel(event), {passive: false});
      stage.addEventListener('dblclick', (event) => {
        const at = page.toView(event);
        page.view.zoom(2, at.x, at.y);
        page.changed();
      });
      // Browsers of iOS zoom the page by gestures of their own.
      stage.addEventListener('gesturestart', (event) => event.preventDefault());
    }

    begin(event) {
      if (event.pointerType === 'mouse' && event.button !== 0) return;
      this.page.stopMoving();
      this.stage.setPointerCapture(event.pointerId);
      this.stage.focus({preventScroll: true});
      this.down.set(event.pointerId, this.page.toView(event));
      this.grip();
    }

    // Remembers what the fingers hold.
    grip() {
      const places = [...this.down.values()];
      if (places.length === 0) return;
      const middle = this.middle(places);
      this.held = this.page.view.direction(middle.x, middle.y);
      this.span = places.length > 1 ? this.distance(places) : 0;
      this.fov = this.page.view.fov;
    }

    middle(places) {
      const [a, b = a] = places;
      return {x: 0.5 * (a.x + b.x), y: 0.5 * (a.y + b.y)};
    }

    distance([a, b]) {
      return Math.max(Math.hypot(a.x - b.x, a.y - b.y), 10);
    }

    move(event) {
      const at = this.page.toView(event);
      if (!this.down.has(event.pointerId)) {
        if (this.down.size === 0) this.page.point(at);
        return;
      }
      this.down.set(event.pointerId, at);
      const places = [...this.down.values()];
      const middle = this.middle(places);
      const view = this.page.view;
      if (places.length > 1) {
        const half = Math.tan((this.fov * Math.PI) / 360);
        view.setFov((Math.atan((half * this.span) / this.distance(places)) * 360) / Math.PI);
      }
      view.hold(this.held, middle.x, middle.y);
      this.page.point(event.pointerType === 'mouse' ? at : null);
      this.page.changed();
    }

    end(event) {
      if (!this.down.delete(event.pointerId)) return;
      this.grip();
    }

    wheel(event) {
      event.preventDefault();
      this.page.stopMoving();
      const line = event.deltaMode === 1 ? 33 : event.deltaMode === 2 ? 100 : 1;
      const notches = Math.min(Math.max((-event.deltaY * line) / (event.ctrlKey ? 25 : 100), -3), 3);
      const at = this.page.toView(event);
      this.page.view.zoom(kNotch ** notches, at.x, at.y);
      this.page.changed();
    }
  }

  const kCommands = {
    'Home': 'home', '0': 'home', '?': 'help', 'h': 'help', 'F1': 'help', 'f': 'fullScreen', 's': 'stereo',
    'c': 'compass', 'l': 'names', 'p': 'places', 'm': 'motion', 'u': 'link', 'n': 'north', 'g': 'level',
  };
  const kTurns = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};

  // Returns what a key does: {turn: [yaw, pitch]} in shares of the field of view, {zoom: factor}, {command: name},
  // or null. `key` is that of a KeyboardEvent.
  function actionOf({key, shiftKey, ctrlKey, metaKey, altKey}) {
    if (ctrlKey || metaKey || altKey) return null;
    if (kTurns[key]) {
      const step = shiftKey ? 0.01 : 0.1;
      return {turn: kTurns[key].map((n) => n * step)};
    }
    if (key === '+' || key === '=' || key === 'PageUp') return {zoom: kNotch};
    if (key === '-' || key === '_' || key === 'PageDown') return {zoom: 1 / kNotch};
    const name = key.length === 1 ? key.toLowerCase() : key;
    return kCommands[name] ? {command: kCommands[name]} : null;
  }

  // Handles keys while no field of text and no dialog has them.
  function handleKey(event, page) {
    const action = actionOf(event);
    if (action === null || page.hasDialog() || /^(INPUT|TEXTAREA|SELECT)$/.test(event.target.tagName || '')) return;
    event.preventDefault();
    const view = page.view;
    if (action.command) {
      page.command(action.command);
      return;
    }
    page.stopMoving();
    page.point(null);
    if (action.turn) view.turn(action.turn[0] * view.fov, action.turn[1] * view.fov);
    if (action.zoom) view.zoom(action.zoom, view.width / 2, view.height / 2);
    page.changed(true);
  }

  // Turns the view with the device.
  class MotionInput {
    constructor(page) {
      this.page = page;
      this.isOn = false;
      this.listener = (event) => this.turned(event);
    }

    static isThere() {
      return 'DeviceOrientationEvent' in globalThis && 'ontouchstart' in globalThis;
    }

    // Switches it on or off. Returns a promise of an empty text, or of what is in the way.
    async toggle() {
      if (this.isOn) {
        removeEventListener('deviceorientation', this.listener);
        this.isOn = false;
        return '';
      }
      const ask = globalThis.DeviceOrientationEvent && DeviceOrientationEvent.requestPermission;
      if (typeof ask === 'function') {
        const answer = await ask.call(DeviceOrientationEvent).catch(() => 'denied');
        if (answer !== 'granted') return 'The browser did not allow the use of motion sensors.';
      }
      this.offset = null;
      this.isOn = true;
      addEventListener('deviceorientation', this.listener);
      return '';
    }

    turned({alpha, beta, gamma}) {
      if (alpha === null || beta === null || gamma === null) return;
      const view = this.page.view;
      const seen = vpe.view.deviceDirection(alpha, beta, gamma);
      // Azimuths of sensors count from anywhere: the view goes on from where it was.
      if (this.offset === null) this.offset = view.yaw - seen.azimuth;
      const yaw = view.yaw + remainder(seen.azimuth + this.offset - view.yaw, 360);
      view.lookAt(yaw, seen.elevation);
      this.page.changed();
    }
  }

  vpe.input = {PointerInput, MotionInput, handleKey, actionOf};
})((globalThis.vpe = globalThis.vpe || {}));
