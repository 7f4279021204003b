// As much of a browser as the viewer uses, for node: elements, events, scripts from a folder, and a WebGL context that
// records calls. It does no layout and draws nothing.
'use strict';

const fs = require('node:fs');
const path = require('node:path');
const vm = require('node:vm');

class FakeElement {
  constructor(browser, tag) {
    Object.assign(this, {browser, tagName: tag.toUpperCase(), children: [], dataset: {}, style: {}, attributes: {},
      listeners: {}, hidden: false, text: '', open: false, parent: null, clientWidth: browser.width,
      clientHeight: browser.height, value: ''});
  }

  get textContent() { return this.text + this.children.map((c) => (typeof c === 'string' ? c : c.textContent)).join(''); }
  set textContent(text) {
    this.children = [];
    this.text = text;
  }
  get firstChild() { return this.children[0]; }
  get lastChild() { return this.children[this.children.length - 1]; }
  append(...all) { for (const child of all) this.appendChild(child); }
  appendChild(child) {
    this.children.push(child);
    if (typeof child === 'string') return child;
    child.parent = this;
    if (child.tagName === 'SCRIPT') this.browser.load(child);
    if (child.tagName === 'IMG' && child.onload) this.browser.later(child.onload, 0);
    return child;
  }
  replaceChildren(...all) {
    this.textContent = '';
    this.append(...all);
  }
  remove() {
    if (this.parent) this.parent.children = this.parent.children.filter((c) => c !== this);
  }
  setAttribute(name, value) { this.attributes[name] = value; }
  addEventListener(kind, listener) { (this.listeners[kind] = this.listeners[kind] || []).push(listener); }
  fire(kind, event = {}) {
    const whole = {type: kind, target: this, preventDefault() {}, ...event};
    for (const listener of this.listeners[kind] || []) listener(whole);
  }
  click() { this.fire('click'); }
  focus() {
    this.browser.document.activeElement = this;
    this.fire('focus');
  }
  select() {}
  setPointerCapture() {}
  close() { this.open = false; }
  showModal() { this.open = true; }
  getBoundingClientRect() { return {left: 0, top: 0, width: this.clientWidth, height: this.clientHeight}; }
  getContext(kind) {
    if (kind === '2d') return new Proxy({measureText: (text) => ({width: 7 * text.length})}, fallback(() => {}));
    return this.browser.hasWebGl ? this.browser.gl : null;
  }
}

// Unknown members are functions or, in capitals, numbers.
function fallback(call) {
  const made = new Map();
  return {
    get(target, name) {
      if (name in target) return target[name];
      if (/^[A-Z]/.test(String(name))) return String(name);
      if (!made.has(name)) made.set(name, (...args) => call(String(name), args));
      return made.get(name);
    },
    set(target, name, value) {
      target[name] = value;
      return true;
    },
  };
}

class FakeBrowser {
  // Opens index.html of a folder. `options`: width, height, density, hasWebGl, hash, isCalm (less motion).
  constructor(folder, options = {}) {
    Object.assign(this, {folder, width: 1280, height: 720, density: 1, hasWebGl: true, hash: '', isCalm: false}, options);
    this.pending = new Set();
    this.calls = [];
    this.loaded = [];
    this.errors = [];
    this.textures = 0;
    this.gl = new Proxy({canvas: null}, fallback((name, args) => {
      this.calls.push([name, ...args]);
      if (name === 'createTexture') this.textures += 1;
      if (name === 'deleteTexture') this.textures -= 1;
      if (name === 'getProgramParameter') return true;
      if (name.startsWith('create') || name === 'getUniformLocation') return {name};
      return undefined;
    }));
    this.makeDocument();
    this.makeWindow();
  }

  makeDocument() {
    const html = fs.readFileSync(path.join(this.folder, 'index.html'), 'utf8');
    this.ids = new Map();
    this.all = [];
    for (const [, tag, text] of html.matchAll(/<([a-z0-9]+)((?:\s+[^<>]*)?)>/g)) {
      const element = new FakeElement(this, tag);
      element.hidden = /\shidden(\s|$)/.test(text);
      for (const [, name, value] of text.matchAll(/([a-z-]+)="([^"]*)"/g)) {
        element.attributes[name] = value;
        if (name === 'id') this.ids.set(value, element);
        if (name.startsWith('data-')) element.dataset[name.slice(5)] = value;
      }
      this.all.push(element);
    }
    const listeners = new FakeElement(this, 'document');
    this.document = Object.assign(listeners, {
      head: new FakeElement(this, 'head'), activeElement: null,
      getElementById: (id) => this.ids.get(id) || null,
      createElement: (tag) => new FakeElement(this, tag),
      querySelectorAll: (what) => this.all.filter((e) => e.dataset[/\[data-([a-z]+)\]/.exec(what)[1]] !== undefined),
      querySelector: () => this.all.find((e) => e.tagName === 'DIALOG' && e.open) || null,
    });
  }

  makeWindow() {
    const window = new FakeElement(this, 'window');
    this.sent = window;
    this.context = vm.createContext({
      document: this.document, console: {...console, error: (text) => this.errors.push(text)},
      location: {hash: this.hash, href: `file:///page/index.html${this.hash}`},
      history: {replaceState: (a, b, hash) => { this.context.location.hash = hash; }},
      navigator: {}, devicePixelRatio: this.density, atob, Blob: class {},
      setTimeout: (action, ms) => this.later(action, ms), clearTimeout: (timer) => this.forget(timer),
      createImageBitmap: () => Promise.resolve({close() {}}), Image: class {},
      matchMedia: () => ({matches: this.isCalm}), addEventListener: (...a) => window.addEventListener(...a),
      removeEventListener() {},
      requestAnimationFrame: (draw) => this.later(() => draw(performance.now()), 1),
    });
  }

  // Does something later, as setTimeout(). What takes more than some seconds does not keep settle() waiting.
  later(action, ms) {
    const timer = setTimeout(() => {
      this.pending.delete(timer);
      this.guard(action);
    }, ms);
    if (ms > 3000) timer.unref();
    else this.pending.add(timer);
    return timer;
  }

  forget(timer) {
    this.pending.delete(timer);
    clearTimeout(timer);
  }

  guard(action) {
    try {
      action();
    } catch (error) {
      this.errors.push(error.stack);
    }
  }

  runFile(name) {
    const text = fs.readFileSync(path.join(this.folder, name), 'utf8');
    this.loaded.push(name);
    vm.runInContext(text, this.context, {filename: name});
  }

  load(script) {
    this.later(() => {
      try {
        this.runFile(script.src);
      } catch (error) {
        if (error.code !== 'ENOENT') throw error;
        script.onerror();
        return;
      }
      script.onload();
    }, 1);
  }

  start() {
    for (const script of this.all.filter((e) => e.tagName === 'SCRIPT')) this.runFile(script.attributes.src);
    return this.context.vpe.current;
  }

  // Presses a key; with `shiftKey` and others in `more`.
  key(key, more = {}) {
    this.document.fire('keydown', {key, target: this.ids.get('stage'), ...more});
  }

  pointer(kind, x, y, more = {}) {
    this.ids.get('stage').fire(`pointer${kind}`, {pointerId: 1, pointerType: 'mouse', button: 0, clientX: x, clientY: y, ...more});
  }

  // Waits until nothing is under way: no tile, no frame, no timer.
  async settle() {
    const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
    do {
      while (this.pending.size > 0) await pause(2);
      await pause(2);
    } while (this.pending.size > 0);
  }
}

module.exports = {FakeBrowser};
