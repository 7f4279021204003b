// Firefox, driven by WebDriver BiDi over a WebSocket of our own, as node 18 has none. It runs in an Xvfb of its own, where it
// has WebGL by software; headless it has none.
'use strict';

const crypto = require('node:crypto');
const fs = require('node:fs');
const net = require('node:net');
const os = require('node:os');
const path = require('node:path');
const {spawn} = require('node:child_process');

// No network, no first pages, and WebGL also by software.
const kPreferences = {
  'webgl.force-enabled': true, 'webgl.forbid-software': false, 'app.update.enabled': false, 'app.normandy.enabled': false,
  'browser.shell.checkDefaultBrowser': false, 'datareporting.policy.dataSubmissionEnabled': false,
  'toolkit.telemetry.server': '', 'browser.startup.page': 0, 'network.captive-portal-service.enabled': false,
  'network.connectivity-service.enabled': false, 'services.settings.server': 'data:,',
  'browser.safebrowsing.malware.enabled': false, 'browser.safebrowsing.phishing.enabled': false,
  'remote.prefs.recommended': true, 'remote.active-protocols': 1,
};

const kKeys = {Tab: '\uE004', Escape: '\uE00C', Home: '\uE011', ArrowLeft: '\uE012', ArrowUp: '\uE013', ArrowRight: '\uE014', ArrowDown: '\uE015'};

// Sends and receives texts by RFC 6455. Browsers send no parts of messages; those that do are put together.
class TextSocket {
  constructor(port, receive, closed) {
    this.receive = receive;
    this.bytes = Buffer.alloc(0);
    this.parts = [];
    this.isOpen = false;
    const key = crypto.randomBytes(16).toString('base64');
    this.ready = new Promise((resolve, reject) => {
      this.socket = net.connect(port, '127.0.0.1', () => this.socket.write(`GET /session HTTP/1.1\r\nHost: 127.0.0.1:${port}\r\n` +
        `Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: ${key}\r\n\r\n`));
      this.socket.on('data', (data) => {
        this.bytes = Buffer.concat([this.bytes, data]);
        if (!this.isOpen) this.shake(resolve, reject);
        if (this.isOpen) while (this.frame());
      });
      this.socket.on('error', reject);
      this.socket.on('close', closed);
    });
  }

  shake(resolve, reject) {
    const end = this.bytes.indexOf('\r\n\r\n');
    if (end < 0) return;
    const head = this.bytes.toString('latin1', 0, end);
    this.bytes = this.bytes.subarray(end + 4);
    this.isOpen = head.startsWith('HTTP/1.1 101');
    if (this.isOpen) resolve();
    else reject(new Error(head));
  }

  // Takes one frame. Returns false when there is none.
  frame() {
    if (this.bytes.length < 2) return false;
    const short = this.bytes[1] & 127;
    const more = short === 126 ? 2 : short === 127 ? 8 : 0;
    if (this.bytes.length < 2 + more) return false;
    const length = more === 0 ? short : more === 2 ? this.bytes.readUInt16BE(2) : Number(this.bytes.readBigUInt64BE(2));
    if (this.bytes.length < 2 + more + length) return false;
    const [kind, body] = [this.bytes[0], this.bytes.subarray(2 + more, 2 + more + length)];
    this.bytes = this.bytes.subarray(2 + more + length);
    if ((kind & 15) === 9) this.write(10, body);
    if ((kind & 15) > 2) return true;
    this.parts.push(body);
    if (kind & 128) this.receive(Buffer.concat(this.parts.splice(0)).toString('utf8'));
    return true;
  }

  send(text) { this.write(1, Buffer.from(text)); }

  write(kind, body) {
    const head = Buffer.alloc(14);
    head[0] = 128 | kind;
    let end = 2;
    if (body.length < 126) {
      head[1] = 128 | body.length;
    } else if (body.length < 65536) {
      head[1] = 128 | 126;
      head.writeUInt16BE(body.length, 2);
      end = 4;
    } else {
      head[1] = 128 | 127;
      head.writeBigUInt64BE(BigInt(body.length), 2);
      end = 10;
    }
    const mask = crypto.randomBytes(4);
    mask.copy(head, end);
    this.socket.write(Buffer.concat([head.subarray(0, end + 4), body.map((byte, n) => byte ^ mask[n & 3])]));
  }

  close() { this.socket.destroy(); }
}

// Starts Xvfb with a display of its choice. Returns {process, name}, or null where there is none.
function startDisplay() {
  return new Promise((resolve) => {
    const server = spawn('Xvfb', ['-displayfd', '3', '-screen', '0', '1400x1000x24', '-nolisten', 'tcp'],
      {stdio: ['ignore', 'ignore', 'ignore', 'pipe']});
    server.on('error', () => resolve(null));
    server.on('exit', () => resolve(null));
    server.stdio[3].once('data', (data) => resolve({process: server, name: `:${String(data).trim()}`}));
  });
}

class Firefox {
  // `display` is that of startDisplay(); null: headless, without WebGL.
  constructor(program, display) {
    this.profile = fs.mkdtempSync(path.join(os.tmpdir(), 'vpe-firefox-'));
    fs.writeFileSync(path.join(this.profile, 'user.js'),
      Object.entries(kPreferences).map(([name, value]) => `user_pref(${JSON.stringify(name)}, ${JSON.stringify(value)});\n`).join(''));
    const env = {...process.env, HOME: this.profile, MOZ_CRASHREPORTER_DISABLE: '1'};
    if (display) Object.assign(env, {DISPLAY: display.name, MOZ_ENABLE_WAYLAND: '0', LIBGL_ALWAYS_SOFTWARE: '1'});
    const flags = ['--no-remote', '--remote-debugging-port=0', '--profile', this.profile, 'about:blank'];
    this.process = spawn(program, display ? flags : ['--headless', ...flags], {stdio: ['ignore', 'ignore', 'pipe'], env});
    this.waiting = new Map();
    this.number = 0;
    this.problems = [];
    this.requests = [];
  }

  // Returns the port that the browser tells.
  port(seconds = 60) {
    return new Promise((resolve, reject) => {
      let text = '';
      const timer = setTimeout(() => reject(new Error(`no port within ${seconds} s: ${text}`)), 1000 * seconds);
      this.process.stderr.on('data', (data) => {
        text = (text + data).slice(-4000);
        const found = /WebDriver BiDi listening on ws:\/\/[^:]*:(\d+)/.exec(text);
        if (!found) return;
        clearTimeout(timer);
        resolve(Number(found[1]));
      });
      this.process.on('exit', () => reject(new Error(`the browser ended: ${text}`)));
    });
  }

  async open() {
    const closed = () => {
      for (const {reject} of this.waiting.values()) reject(new Error('the browser ended'));
    };
    this.socket = new TextSocket(await this.port(), (text) => this.receive(JSON.parse(text)), closed);
    await this.socket.ready;
    await this.send('session.new', {capabilities: {}});
    const {contexts} = await this.send('browsingContext.getTree', {});
    this.context = contexts[0].context;
    await this.send('session.subscribe', {events: ['log.entryAdded', 'network.beforeRequestSent']});
  }

  receive({type, id, result, error, message, method, params}) {
    if (type !== 'event') {
      const {resolve, reject} = this.waiting.get(id);
      this.waiting.delete(id);
      if (type === 'error') reject(new Error(`${error}: ${message}`));
      else resolve(result);
      return;
    }
    if (method === 'log.entryAdded' && ['error', 'warn'].includes(params.level)) this.problems.push(params.text);
    if (method === 'network.beforeRequestSent') this.requests.push(params.request.url);
  }

  send(method, params) {
    const id = ++this.number;
    this.socket.send(JSON.stringify({id, method, params}));
    return new Promise((resolve, reject) => this.waiting.set(id, {resolve, reject}));
  }

  async navigate(url) { await this.send('browsingContext.navigate', {context: this.context, url, wait: 'complete'}); }

  async resize(width, height) {
    await this.send('browsingContext.setViewport', {context: this.context, viewport: {width, height}, devicePixelRatio: 1});
  }

  // Returns the value of an expression, awaited; it goes through JSON.
  async evaluate(expression) {
    const {type, result, exceptionDetails} = await this.send('script.evaluate', {
      expression: `(async () => JSON.stringify(await (${expression})))()`, awaitPromise: true, target: {context: this.context}});
    if (type === 'exception') throw new Error(exceptionDetails.text);
    return result.value === undefined ? undefined : JSON.parse(result.value);
  }

  // Waits until an expression is true. It may fail before scripts are loaded.
  async until(expression, seconds = 60) {
    const end = Date.now() + 1000 * seconds;
    while (!(await this.evaluate(`(() => { try { return Boolean(${expression}); } catch { return false; } })()`))) {
      if (Date.now() > end) throw new Error(`${seconds} s without ${expression}`);
      await new Promise((resolve) => setTimeout(resolve, 20));
    }
  }

  async screenshot() {
    const {data} = await this.send('browsingContext.captureScreenshot', {context: this.context});
    return Buffer.from(data, 'base64');
  }

  async key(key) {
    const value = kKeys[key] || key;
    await this.send('input.performActions', {context: this.context,
      actions: [{type: 'key', id: 'keys', actions: [{type: 'keyDown', value}, {type: 'keyUp', value}]}]});
  }

  // Moves the mouse through places, with the button down between the first and the last one.
  async drag(...places) {
    const moves = places.map(([x, y]) => ({type: 'pointerMove', x, y, duration: 0}));
    await this.send('input.performActions', {context: this.context, actions: [{type: 'pointer', id: 'mouse',
      actions: [moves[0], {type: 'pointerDown', button: 0}, ...moves.slice(1), {type: 'pointerUp', button: 0}]}]});
  }

  async close() {
    const ended = new Promise((resolve) => this.process.on('exit', resolve));
    if (this.socket) this.send('browser.close', {}).catch(() => {});
    await Promise.race([ended, new Promise((resolve) => setTimeout(resolve, 8000))]);
    if (this.process.exitCode === null && this.process.signalCode === null) {
      this.process.kill('SIGKILL');
      await ended;
    }
    if (this.socket) this.socket.close();
    fs.rmSync(this.profile, {recursive: true, force: true, maxRetries: 5});
  }
}

module.exports = {Firefox, startDisplay};
