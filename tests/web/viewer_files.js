// The viewer's files, for node: those without DOM are loaded into globalThis.vpe.
'use strict';

const fs = require('node:fs');
const path = require('node:path');
const vm = require('node:vm');

const kFolder = path.join(__dirname, '../../panorama/page/web');
// In the order of the page (panorama/page/page_files.cpp).
const kPure = ['projection.js', 'view.js', 'pyramid.js', 'pace.js', 'flat_view.js', 'planes.js', 'text.js'];
const kWithDom = ['loader.js', 'webgl.js', 'flat_renderer.js', 'marks.js', 'input.js', 'panel.js', 'page.js', 'main.js'];

function run(names, context) {
  for (const name of names) {
    const file = path.join(kFolder, name);
    const text = fs.readFileSync(file, 'utf8');
    if (context) vm.runInContext(text, context, {filename: file});
    else vm.runInThisContext(text, {filename: file});
  }
}

module.exports = {kFolder, kPure, kWithDom, run};
