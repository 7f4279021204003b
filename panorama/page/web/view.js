// The state of the viewer: a level perspective view that turns and zooms within the limits of an image, as
// panorama/viewer/viewer.h. Screen places are in CSS pixels from the upper left corner. No DOM.
(function (vpe) {
  'use strict';

  const {kDeg, remainder, clamp, wrap, toDirection, columnsPerRadian, elevationsOf, toVector, fromVector} =
    vpe.projection;

  const kMinFov = 0.001;
  const kMaxFov = 120;
  const kDefaultFov = 60;
  // Screen pixels that a pixel of the image may be wide.
  const kMaxMagnification = 16;
  // From here on an image counts as closed at the zenith or nadir.
  const kClosed = 89.9;

  const tangentOfHalf = (fov) => Math.tan(0.5 * fov * kDeg);
  const fovOf = (tangent) => (2 * Math.atan(tangent)) / kDeg;

  // Holds yaw, pitch and field of view (all in degrees, `fov` vertical) within the limits of an image.
  class View {
    // `density` is the number of device pixels to a CSS pixel.
    constructor(map, width, height, density = 1) {
      this.map = map;
      this.width = width;
      this.height = height;
      this.density = density;
      this.yaw = map.kind === 'plane' ? map.middle_azimuth_deg
        : toDirection(map, 0.5 * Math.min(map.width_px, map.turn_px), map.horizon_px).azimuth;
      this.pitch = 0;
      this.fov = kDefaultFov;
      this.setFov(this.startFov());
    }

    // Returns the field of view of the start: 60 degrees, on upright screens wider, and no more than the image
    // shows where that is less.
    startFov() {
      const upright = this.height > this.width;
      const wanted = upright ? fovOf((tangentOfHalf(50) * this.height) / this.width) : kDefaultFov;
      const seen = elevationsOf(this.map);
      const reach = seen.high - seen.low;
      return Math.min(wanted, 100, Math.max(reach, 1e-3));
    }

    focal() {
      return (0.5 * this.height) / tangentOfHalf(this.fov);
    }

    minFov() {
      const finest = Math.max(columnsPerRadian(this.map), this.map.focal_px);
      const fov = fovOf((0.5 * this.height * this.density) / (kMaxMagnification * finest));
      return clamp(fov, kMinFov, kMaxFov);
    }

    pitchRange() {
      const seen = elevationsOf(this.map);
      const half = 0.5 * this.fov;
      const low = seen.low <= -kClosed ? -90 : seen.low + half;
      const high = seen.high >= kClosed ? 90 : seen.high - half;
      if (low <= high) return {low, high};
      const middle = 0.5 * (seen.low + seen.high);
      return {low: middle, high: middle};
    }

    resize(width, height, density = this.density) {
      this.width = width;
      this.height = height;
      this.density = density;
      this.setFov(this.fov);
    }

    lookAt(yaw, pitch) {
      if (!Number.isFinite(yaw) || !Number.isFinite(pitch)) return;
      this.yaw = this.limitedYaw(yaw);
      const range = this.pitchRange();
      this.pitch = clamp(pitch, range.low, range.high);
    }

    // Returns a yaw within the sides of a plane; other images are turned without end.
    limitedYaw(yaw) {
      const map = this.map;
      if (map.kind !== 'plane') return yaw;
      const middle = map.middle_azimuth_deg;
      const low = remainder(toDirection(map, 0, map.horizon_px).azimuth - middle, 360);
      const high = remainder(toDirection(map, map.width_px, map.horizon_px).azimuth - middle, 360);
      return middle + clamp(remainder(yaw - middle, 360), low, high);
    }

    turn(yaw, pitch) {
      this.lookAt(this.yaw + yaw, this.pitch + pitch);
    }

    setFov(fov) {
      if (!Number.isFinite(fov)) return;
      this.fov = clamp(fov, this.minFov(), kMaxFov);
      this.lookAt(this.yaw, this.pitch);
    }

    // Divides the tangent of half the field of view by a factor > 0. The direction at (x, y) stays there unless
    // a limit of the pitch is reached.
    zoom(factor, x, y) {
      if (!(factor > 0) || !Number.isFinite(factor + x + y)) return;
      const under = this.direction(x, y);
      this.setFov(fovOf(tangentOfHalf(this.fov) / factor));
      this.hold(under, x, y);
    }

    // Turns, without roll, so that a direction is at (x, y), or as near to it as the limits allow.
    hold(direction, x, y) {
      if (!Number.isFinite(direction.azimuth + direction.elevation + x + y)) return;
      // The ray (u, v, 1) in (right, up, forward) rises by sqrt(1 + v^2) sin(pitch + atan v).
      const u = (x - 0.5 * this.width) / this.focal();
      const v = (0.5 * this.height - y) / this.focal();
      const sine = Math.sin(direction.elevation * kDeg) * Math.sqrt((1 + u * u + v * v) / (1 + v * v));
      const rise = Math.asin(clamp(sine, -1, 1));
      // Two pitches fulfil this, one with the ray beyond the zenith or nadir; the nearer one counts.
      const here = this.pitch * kDeg + Math.atan(v);
      const beyond = (rise < 0 ? -Math.PI : Math.PI) - rise;
      const isBeyond = Math.abs(beyond - here) < Math.abs(rise - here);
      const range = this.pitchRange();
      const pitch = clamp(((isBeyond ? beyond : rise) - Math.atan(v)) / kDeg, range.low, range.high);
      const aside = Math.atan2(u, Math.cos(pitch * kDeg) - v * Math.sin(pitch * kDeg)) / kDeg;
      // The nearest of all equivalent yaws, so that yaw continues where it was.
      this.lookAt(this.yaw + remainder(direction.azimuth - aside - this.yaw, 360), pitch);
    }

    // Returns {right, up, forward}: unit vectors [east, north, up].
    axes() {
      const yaw = (this.yaw % 360) * kDeg;
      const pitch = this.pitch * kDeg;
      const [sy, cy, sp, cp] = [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];
      return {right: [cy, -sy, 0], up: [-sp * sy, -sp * cy, cp], forward: [cp * sy, cp * cy, sp]};
    }

    // Returns the direction at a screen place.
    direction(x, y) {
      const {right, up, forward} = this.axes();
      const u = (x - 0.5 * this.width) / this.focal();
      const v = (0.5 * this.height - y) / this.focal();
      return fromVector([0, 1, 2].map((n) => right[n] * u + up[n] * v + forward[n]));
    }

    // Returns the screen place {x, y} of a direction, also beside the screen; null for one that is not in front.
    screen(direction) {
      const {right, up, forward} = this.axes();
      const ray = toVector(direction);
      const dot = (a) => a[0] * ray[0] + a[1] * ray[1] + a[2] * ray[2];
      const ahead = dot(forward);
      if (ahead <= 1e-9) return null;
      return {
        x: 0.5 * this.width + (this.focal() * dot(right)) / ahead,
        y: 0.5 * this.height - (this.focal() * dot(up)) / ahead,
      };
    }
  }

  // Returns the direction to which the back of a device points, from the angles of a deviceorientation event
  // (degrees): rotations about z, then x, then y in the frame east, north, up.
  function deviceDirection(alpha, beta, gamma) {
    const [a, b, g] = [alpha * kDeg, beta * kDeg, gamma * kDeg];
    const [sa, ca, sb, cb, sg, cg] = [Math.sin(a), Math.cos(a), Math.sin(b), Math.cos(b), Math.sin(g), Math.cos(g)];
    // The third column of the rotation, where the screen faces, with another sign.
    return fromVector([-(ca * sg + sa * sb * cg), -(sa * sg - ca * sb * cg), -(cb * cg)]);
  }

  // Returns where the view is, between two views that are {yaw, pitch, fov}, at a share of the time 0..1. It turns
  // the shorter way.
  function between(from, to, share) {
    const s = share * share * (3 - 2 * share);
    return {
      yaw: from.yaw + s * remainder(to.yaw - from.yaw, 360),
      pitch: from.pitch + s * (to.pitch - from.pitch),
      fov: Math.exp(Math.log(from.fov) + s * (Math.log(to.fov) - Math.log(from.fov))),
    };
  }

  vpe.view = {View, deviceDirection, between, kDefaultFov, kMaxFov, wrapYaw: (yaw) => wrap(yaw, 360)};
})((globalThis.vpe = globalThis.vpe || {}));
