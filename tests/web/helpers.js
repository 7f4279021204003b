// Numbers, maps and comparisons of the viewer's tests. Loads the scripts without DOM into globalThis.vpe.
'use strict';

const assert = require('node:assert');
const {kPure, run} = require('./viewer_files.js');

run([...kPure, 'webgl.js']);
const {remainder} = globalThis.vpe.projection;

const near = (a, b, most, what) => assert.ok(Math.abs(a - b) <= most, `${what}: ${a} is not ${b}`);
const nearAzimuth = (a, b, most, what) => assert.ok(Math.abs(remainder(a - b, 360)) <= most, `${what}: ${a} is not ${b}`);

// Draws numbers 0..1, the same in every run.
function generator(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

function cylinder(width, height, left = 0, horizon = height / 2) {
  return {
    kind: 'cylinder', width_px: width, height_px: height, turn_px: width, turn_azimuth_deg: left, crop_left_px: 0,
    horizon_px: horizon, focal_px: width / (2 * Math.PI), facets: 0,
  };
}
const sphere = (width) => ({...cylinder(width, width / 2), kind: 'equirectangular'});
function facets(count, width, height, yaw) {
  return {
    ...cylinder(count * width, height, yaw - 180 / count), kind: 'facets', facets: count,
    focal_px: width / 2 / Math.tan(Math.PI / count),
  };
}
const plane = {
  kind: 'plane', width_px: 800, height_px: 600, middle_azimuth_deg: 350, middle_px: 400, horizon_px: 320, focal_px: 700,
};
const maps = [cylinder(6000, 1910, -180), sphere(4096), facets(8, 512, 900, 10), plane];
const pyramidOf = (map, tile = 512) => ({
  width_px: map.width_px, height_px: map.height_px, tile_px: tile,
  levels: 1 + Math.max(0, Math.ceil(Math.log2(Math.max(map.width_px, map.height_px) / tile))),
});

module.exports = {near, nearAzimuth, generator, cylinder, sphere, facets, plane, maps, pyramidOf};
