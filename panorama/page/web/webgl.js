// Draws tiles with WebGL. Every tile is a mesh of points on the surface that carries the image. Points are kept
// relative to the tile's middle, which is moved by the view in double precision: so narrow views are exact, too.
(function (vpe) {
  'use strict';

  const {surfacePoint, facetPx} = vpe.projection;
  const {cellsOf, overlapping, placeInTile} = vpe.pyramid;

  const kVertexShader = `
    attribute vec3 offset;
    attribute vec2 place;
    uniform mat3 axes;
    uniform vec3 middle;
    varying vec2 at;
    void main() {
      vec3 p = axes * offset + middle;
      gl_Position = vec4(p.xy, 0.0, p.z);
      at = place;
    }`;

  // For red-cyan glasses the left eye's brightness is red, the right eye's green and blue stay.
  const kFragmentShader = `
    #ifdef GL_FRAGMENT_PRECISION_HIGH
    precision highp float;
    #else
    precision mediump float;
    #endif
    uniform sampler2D picture;
    uniform float grey;
    varying vec2 at;
    void main() {
      vec3 colour = texture2D(picture, at).rgb;
      gl_FragColor = vec4(mix(colour, vec3(dot(colour, vec3(0.299, 0.587, 0.114))), grey), 1.0);
    }`;

  // Returns {middle, vertices, indices} of a tile: 5 numbers a vertex, offset from the middle and place in the
  // picture. Cells of facets have vertices of their own on either side of a seam.
  function meshOf(pyramid, map, tile) {
    const {xs, ys} = cellsOf(map, overlapping(pyramid, map, tile));
    const middle = surfacePoint(map, 0.5 * (tile.x0 + tile.x1), 0.5 * (tile.y0 + tile.y1));
    const vertices = [];
    const indices = [];
    const add = (x, y, facet) => {
      const p = surfacePoint(map, x, y, facet);
      const {u, v} = placeInTile(pyramid, tile, x, y);
      vertices.push(p[0] - middle[0], p[1] - middle[1], p[2] - middle[2], u, v);
    };
    const rows = ys.length;
    for (let i = 0; i + 1 < xs.length; ++i) {
      const facet = map.kind === 'facets'
        ? Math.floor((0.5 * (xs[i] + xs[i + 1]) + map.crop_left_px) / facetPx(map)) : undefined;
      const first = vertices.length / 5;
      for (const x of [xs[i], xs[i + 1]]) {
        for (const y of ys) add(x, y, facet);
      }
      for (let j = 0; j + 1 < rows; ++j) {
        const a = first + j;
        const b = a + rows;
        indices.push(a, a + 1, b, b, a + 1, b + 1);
      }
    }
    return {middle, vertices: new Float32Array(vertices), indices: new Uint16Array(indices)};
  }

  // Returns the uniforms of a view, for a screen of its shape: `axes` column by column, and middle(point).
  function uniformsOf(view) {
    const {right, up, forward} = view.axes();
    const across = view.focal() / (0.5 * view.width);
    const down = view.focal() / (0.5 * view.height);
    const axes = [];
    for (let n = 0; n < 3; ++n) axes.push(right[n] * across, up[n] * down, forward[n]);
    const dot = (a, p) => a[0] * p[0] + a[1] * p[1] + a[2] * p[2];
    return {axes, middle: (p) => [across * dot(right, p), down * dot(up, p), dot(forward, p)]};
  }

  function programOf(gl) {
    const program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, kVertexShader], [gl.FRAGMENT_SHADER, kFragmentShader]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, 'offset');
    gl.bindAttribLocation(program, 1, 'place');
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return null;
    return program;
  }

  // Draws into a canvas. Throws Error where WebGL cannot be used.
  class WebGlRenderer {
    constructor(canvas, pyramid, map) {
      const options = {alpha: false, antialias: false, depth: false, stencil: false};
      const gl = canvas.getContext('webgl2', options) || canvas.getContext('webgl', options);
      if (!gl) throw new Error('no WebGL');
      this.canvas = canvas;
      this.gl = gl;
      this.pyramid = pyramid;
      this.map = map;
      this.tiles = new vpe.pyramid.RecentlyUsed(64, (tile) => this.drop(tile));
      this.prepare();
    }

    // Makes what is lost with a context.
    prepare() {
      const gl = this.gl;
      const program = programOf(gl);
      if (program === null) throw new Error('no shaders');
      this.at = {};
      for (const name of ['axes', 'middle', 'picture', 'grey']) this.at[name] = gl.getUniformLocation(program, name);
      gl.useProgram(program);
      gl.uniform1i(this.at.picture, 0);
      gl.enableVertexAttribArray(0);
      gl.enableVertexAttribArray(1);
      gl.disable(gl.DEPTH_TEST);
      gl.disable(gl.CULL_FACE);
    }

    // Forgets all tiles and begins anew, after the context was lost and given back.
    restore() {
      this.tiles.values.clear();
      this.prepare();
    }

    drop({texture, points, order}) {
      this.gl.deleteTexture(texture);
      this.gl.deleteBuffer(points);
      this.gl.deleteBuffer(order);
    }

    has(name) {
      return this.tiles.has(name);
    }

    // Gives the canvas a size in pixels, rounded.
    resize(width, height) {
      const size = [width, height].map((length) => Math.max(Math.round(length), 1));
      if (this.canvas.width !== size[0] || this.canvas.height !== size[1]) {
        [this.canvas.width, this.canvas.height] = size;
      }
    }

    // Counts a tile as used without drawing it.
    use(name) {
      this.tiles.get(name);
    }

    // Takes the picture of a tile. `name` is that of an eye's tile.
    add(name, tile, picture) {
      const gl = this.gl;
      const mesh = meshOf(this.pyramid, this.map, tile);
      const texture = gl.createTexture();
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, gl.RGB, gl.UNSIGNED_BYTE, picture);
      for (const [key, value] of [['MIN_FILTER', 'LINEAR'], ['MAG_FILTER', 'LINEAR'],
        ['WRAP_S', 'CLAMP_TO_EDGE'], ['WRAP_T', 'CLAMP_TO_EDGE']]) {
        gl.texParameteri(gl.TEXTURE_2D, gl[`TEXTURE_${key}`], gl[value]);
      }
      if (picture.close) picture.close();
      const points = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, points);
      gl.bufferData(gl.ARRAY_BUFFER, mesh.vertices, gl.STATIC_DRAW);
      const order = gl.createBuffer();
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, order);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, mesh.indices, gl.STATIC_DRAW);
      this.tiles.set(name, {texture, points, order, count: mesh.indices.length, middle: mesh.middle});
    }

    // Draws eyes: [{eye, tiles, part, colours}], each on its part {x, y, width, height} of the canvas in device
    // pixels, y up. `colours` is 'all', 'red' or 'cyan'. The view's shape is that of the parts. At least `needed`
    // tiles are kept.
    draw(view, eyes, needed) {
      const gl = this.gl;
      gl.colorMask(true, true, true, true);
      gl.viewport(0, 0, this.canvas.width, this.canvas.height);
      gl.clearColor(38 / 255, 40 / 255, 46 / 255, 1);
      gl.clear(gl.COLOR_BUFFER_BIT);
      const {axes, middle} = uniformsOf(view);
      gl.uniformMatrix3fv(this.at.axes, false, axes);
      for (const {eye, tiles, part, colours} of eyes) {
        gl.viewport(part.x, part.y, part.width, part.height);
        gl.colorMask(colours !== 'cyan', colours !== 'red', colours !== 'red', true);
        gl.uniform1f(this.at.grey, colours === 'red' ? 1 : 0);
        for (const {name} of tiles) this.drawTile(this.tiles.get(`${eye}/${name}`), middle);
      }
      this.tiles.keep(needed);
    }

    drawTile(tile, middle) {
      if (tile === undefined) return;
      const gl = this.gl;
      gl.bindTexture(gl.TEXTURE_2D, tile.texture);
      gl.bindBuffer(gl.ARRAY_BUFFER, tile.points);
      gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 20, 0);
      gl.vertexAttribPointer(1, 2, gl.FLOAT, false, 20, 12);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, tile.order);
      gl.uniform3fv(this.at.middle, middle(tile.middle));
      gl.drawElements(gl.TRIANGLES, tile.count, gl.UNSIGNED_SHORT, 0);
    }
  }

  vpe.webgl = {WebGlRenderer, meshOf, uniformsOf};
})((globalThis.vpe = globalThis.vpe || {}));
