// Headless Chromium, driven over a pipe by its DevTools protocol.
'use strict';

const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');
const {spawn} = require('node:child_process');

const kFlags = ['--headless=new', '--remote-debugging-pipe', '--no-sandbox', '--no-first-run', '--disable-extensions',
  '--disable-background-networking', '--disable-component-update', '--hide-scrollbars', '--use-gl=angle',
  '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'];

const kKeyNumbers = {Tab: 9, Enter: 13, Escape: 27, End: 35, Home: 36, ArrowLeft: 37, ArrowUp: 38, ArrowRight: 39, ArrowDown: 40};

class Chromium {
  constructor(program, flags = []) {
    this.profile = fs.mkdtempSync(path.join(os.tmpdir(), 'vpe-chromium-'));
    this.process = spawn(program, [...kFlags, ...flags, `--user-data-dir=${this.profile}`, 'about:blank'],
      {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe']});
    this.waiting = new Map();
    this.number = 0;
    this.problems = [];
    this.requests = [];
    let text = '';
    this.process.stdio[4].on('data', (data) => {
      text += data;
      for (let end = text.indexOf('\0'); end >= 0; end = text.indexOf('\0')) {
        this.receive(JSON.parse(text.slice(0, end)));
        text = text.slice(end + 1);
      }
    });
    this.process.on('exit', () => {
      for (const {reject} of this.waiting.values()) reject(new Error('the browser ended'));
    });
  }

  receive({id, result, error, method, params}) {
    if (id !== undefined) {
      const {resolve, reject} = this.waiting.get(id);
      this.waiting.delete(id);
      if (error) reject(new Error(error.message));
      else resolve(result);
      return;
    }
    if (method === 'Runtime.exceptionThrown') this.problems.push(params.exceptionDetails.exception?.description || params.exceptionDetails.text);
    if (method === 'Runtime.consoleAPICalled' && ['error', 'warning'].includes(params.type)) {
      this.problems.push(params.args.map((a) => a.value).join(' '));
    }
    if (method === 'Log.entryAdded' && params.entry.level === 'error') this.problems.push(`${params.entry.text} ${params.entry.url || ''}`);
    if (method === 'Network.requestWillBeSent') this.requests.push(params.request.url);
  }

  send(method, params = {}) {
    const id = ++this.number;
    this.process.stdio[3].write(`${JSON.stringify({id, method, params, sessionId: this.session})}\0`);
    return new Promise((resolve, reject) => this.waiting.set(id, {resolve, reject}));
  }

  // Opens a tab and begins to record problems and requests.
  async open() {
    const {targetId} = await this.send('Target.createTarget', {url: 'about:blank'});
    const {sessionId} = await this.send('Target.attachToTarget', {targetId, flatten: true});
    this.session = sessionId;
    for (const domain of ['Page', 'Runtime', 'Log', 'Network']) await this.send(`${domain}.enable`);
  }

  async resize(width, height, density = 1) {
    await this.send('Emulation.setDeviceMetricsOverride', {width, height, deviceScaleFactor: density, mobile: false});
  }

  // Returns the value of an expression, awaited.
  async evaluate(expression) {
    const {result, exceptionDetails} = await this.send('Runtime.evaluate', {expression, returnByValue: true, awaitPromise: true});
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description || exceptionDetails.text);
    return result.value;
  }

  // Waits until an expression is true. It may fail before scripts are loaded.
  async until(expression, seconds = 30) {
    const end = Date.now() + 1000 * seconds;
    const guarded = `(() => { try { return Boolean(${expression}); } catch { return false; } })()`;
    while (!(await this.evaluate(guarded))) {
      if (Date.now() > end) throw new Error(`${seconds} s without ${expression}`);
      await new Promise((resolve) => setTimeout(resolve, 20));
    }
  }

  async screenshot() {
    const {data} = await this.send('Page.captureScreenshot', {format: 'png'});
    return Buffer.from(data, 'base64');
  }

  async key(key, modifiers = 0) {
    const text = key.length === 1 ? key : undefined;
    // The browser's own actions, such as going to the next button, follow from the number of a key.
    const event = {key, code: key, windowsVirtualKeyCode: kKeyNumbers[key], modifiers};
    await this.send('Input.dispatchKeyEvent', {type: text ? 'keyDown' : 'rawKeyDown', text, ...event});
    await this.send('Input.dispatchKeyEvent', {type: 'keyUp', ...event});
  }

  async mouse(type, x, y, more = {}) {
    await this.send('Input.dispatchMouseEvent', {type, x, y, ...more});
  }

  async close() {
    const ended = new Promise((resolve) => this.process.on('exit', resolve));
    this.session = undefined;
    this.send('Browser.close').catch(() => {});
    await Promise.race([ended, new Promise((resolve) => setTimeout(resolve, 5000))]);
    this.process.kill('SIGKILL');
    await ended;
    fs.rmSync(this.profile, {recursive: true, force: true, maxRetries: 5});
  }
}

module.exports = {Chromium};
