// Texts of the page: read-outs, marks of azimuth, the scale, and the fragment of the address. No DOM.
(function (vpe) {
  'use strict';

  const {wrap, remainder, clamp, kDeg} = vpe.projection;

  const kMinus = '\u2212';
  const kStereoModes = ['off', 'anaglyph', 'side'];

  // Returns a number with this many decimals; one that rounds to zero has no sign.
  function fixed(value, decimals) {
    const text = Math.abs(value).toFixed(decimals);
    return value < 0 && Number(text) !== 0 ? kMinus + text : text;
  }

  // Returns the number of decimals that tell pixels apart which are `step` wide.
  function decimalsFor(step) {
    return clamp(Math.ceil(-Math.log10(step)), 0, 6);
  }

  // Returns a length in metres or kilometres with about five digits.
  function lengthText(metres) {
    const size = Math.abs(metres);
    if (size >= 1000) return `${fixed(metres / 1000, size < 1e5 ? 2 : 1)} km`;
    return `${fixed(metres, size < 100 ? 2 : 1)} m`;
  }

  const kPoints = ['N', 'NNE', 'NE', 'ENE', 'E', 'ESE', 'SE', 'SSE', 'S', 'SSW', 'SW', 'WSW', 'W', 'WNW', 'NW', 'NNW'];
  function pointOf(azimuth) {
    return kPoints[Math.round(wrap(azimuth, 360) / 22.5) % 16];
  }

  function azimuthText(azimuth, decimals, hasNorth) {
    const text = `${fixed(wrap(Number(azimuth.toFixed(decimals)), 360), decimals)}\u00b0`;
    return hasNorth ? `${text} ${pointOf(azimuth)}` : text;
  }

  function placeText(lon, lat) {
    return `${fixed(Math.abs(lat), 6)}\u00b0 ${lat < 0 ? 'S' : 'N'}, ` +
      `${fixed(Math.abs(lon), 6)}\u00b0 ${lon < 0 ? 'W' : 'E'}`;
  }

  const kPlain = {
    range_m: ['Range', lengthText],
    elevation_m: ['Height', (v) => `${fixed(v, 1)} m`],
    slope_deg: ['Slope', (v) => `${fixed(v, 1)}\u00b0`],
    incidence_deg: ['Incidence', (v) => `${fixed(v, 1)}\u00b0`],
    synthetic: ['Source', (v) => (v > 0.5 ? 'synthetic' : 'data')],
  };

  // Returns the read-out of a direction as [label, text] pairs. `values` maps names of bands to numbers or null; it
  // is null as long as they are not there.
  function readOut(direction, values, {decimals, hasNorth}) {
    const parts = [
      ['Azimuth', azimuthText(direction.azimuth, decimals, hasNorth)],
      ['Elevation', `${fixed(direction.elevation, decimals)}\u00b0`],
    ];
    if (values === null) return parts;
    const known = Object.entries(values).filter(([, value]) => value !== null);
    if (known.length === 0 && Object.keys(values).length > 0) parts.push(['Here', 'sky, or nothing known']);
    if (typeof values.lon_deg === 'number' && typeof values.lat_deg === 'number') {
      parts.push(['Place', placeText(values.lon_deg, values.lat_deg)]);
    }
    for (const [name, value] of known) {
      if (name === 'lon_deg' || name === 'lat_deg') continue;
      const [label, format] = kPlain[name] || [name, (v) => String(Number(v.toPrecision(6)))];
      parts.push([label, format(value)]);
    }
    return parts;
  }

  // Returns the largest of 1, 2, 5 times a power of ten that is at most `most`.
  function niceStep(most) {
    const power = 10 ** Math.floor(Math.log10(most) + 1e-9);
    const share = most / power;
    return power * (share >= 5 ? 5 : share >= 2 ? 2 : 1);
  }

  const kMarkSteps = [90, 45, 15, 5, 2, 1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4];
  // Returns marks of azimuth along the view's middle row: {x, text, isMajor}, x in CSS pixels.
  function compassMarks(view, hasNorth, spacingPx = 70) {
    const span = spanOf(view);
    const wanted = (spacingPx / view.width) * span;
    const step = kMarkSteps.filter((s) => s >= wanted).pop() || kMarkSteps[0];
    const marks = [];
    for (let n = Math.ceil((view.yaw - span / 2) / step); n * step <= view.yaw + span / 2; ++n) {
      const azimuth = n * step;
      const at = view.screen({azimuth, elevation: middleRowElevation(view, azimuth - view.yaw)});
      if (at === null) continue;
      const shown = wrap(azimuth, 360);
      const isPoint = hasNorth && step >= 1 && Math.abs(remainder(shown, 45)) < 1e-9;
      marks.push({
        x: at.x,
        text: isPoint ? pointOf(shown) : `${Number(shown.toFixed(decimalsFor(step)))}\u00b0`,
        isMajor: isPoint,
      });
    }
    return marks;
  }

  // Returns the azimuths in degrees that the middle row of the screen spans.
  function spanOf(view) {
    if (view.scale) return Math.min((view.width / view.focal()) / kDeg, 3600);
    const tangent = (0.5 * view.width) / view.focal();
    return (2 * Math.atan2(tangent, Math.max(Math.cos(view.pitch * kDeg), 1e-6))) / kDeg;
  }

  // Returns the elevation on the middle row at an azimuth from the middle.
  function middleRowElevation(view, aside) {
    if (view.scale) return view.pitch;
    return Math.atan(Math.tan(clamp(view.pitch, -89.9999, 89.9999) * kDeg) * Math.cos(aside * kDeg)) / kDeg;
  }

  // Returns the scale bar in the middle of the view: {px, text}, at most `most` CSS pixels long. With the range of
  // what is in the middle it also has a length across the line of sight.
  function scaleBar(view, range, most = 160) {
    const isFlat = Boolean(view.scale);
    const reach = isFlat ? most / view.focal() : 2 * Math.atan((0.5 * most) / view.focal());
    const degrees = niceStep(reach / kDeg);
    const px = isFlat ? view.focal() * degrees * kDeg : 2 * view.focal() * Math.tan(0.5 * degrees * kDeg);
    let text = `${Number(degrees.toPrecision(1))}\u00b0`;
    if (range) text += ` = ${lengthText(2 * range * Math.tan(0.5 * degrees * kDeg))} at ${lengthText(range)}`;
    return {px, text};
  }

  // Returns the fragment of a view, without #. Numbers are as exact as its pixels.
  function formatFragment({yaw, pitch, fov, stereo}) {
    const digits = clamp(Math.ceil(-Math.log10(fov / 10000)), 0, 9);
    const number = (v) => String(Number(v.toFixed(digits)));
    const text = `view=${number(wrap(yaw, 360))},${number(pitch)},${String(Number(fov.toPrecision(5)))}`;
    return stereo && stereo !== 'off' ? `${text}&stereo=${stereo}` : text;
  }

  // Returns the address of another panorama's page that opens with the heading, pitch and field of view of this one.
  // Without a common north it opens as it is.
  function pageInView(page, {yaw, pitch, fov}, hasNorth) {
    return hasNorth ? `${page}#${formatFragment({yaw, pitch, fov})}` : page;
  }

  // Returns {yaw, pitch, fov, stereo} with what a fragment says; absent or wrong parts are undefined.
  function parseFragment(fragment) {
    const found = {};
    for (const part of fragment.replace(/^#/, '').split('&')) {
      const [key, value = ''] = part.split('=');
      if (key === 'view') {
        const numbers = value.split(',').map((word) => (word.trim() === '' ? NaN : Number(word)));
        if (numbers.length >= 2 && numbers.length <= 3 && numbers.every(Number.isFinite) &&
            Math.abs(numbers[1]) <= 90) {
          [found.yaw, found.pitch] = numbers;
          if (numbers.length === 3 && numbers[2] > 0) found.fov = numbers[2];
        }
      }
      if (key === 'stereo' && kStereoModes.includes(value)) found.stereo = value;
    }
    return found;
  }

  // Returns the labels that find room, each with the row, counted from its place upwards, in which it stands. Labels
  // are {x, y, width} in order of importance.
  function layOutLabels(labels, {height, rowPx = 20, rows = 6, gapPx = 8}) {
    const taken = [];
    const placed = [];
    for (const label of labels) {
      for (let row = 0; row < rows; ++row) {
        const box = {
          left: label.x - label.width / 2 - gapPx / 2,
          right: label.x + label.width / 2 + gapPx / 2,
          bottom: label.y - 14 - row * rowPx,
        };
        box.top = box.bottom - rowPx;
        if (box.top < 0 || box.bottom > height) continue;
        const meets = (o) => box.left < o.right && o.left < box.right && box.top < o.bottom && o.top < box.bottom;
        if (taken.some(meets)) continue;
        taken.push(box);
        placed.push({...label, row, top: box.top, leader: 14 + row * rowPx});
        break;
      }
    }
    return placed;
  }

  vpe.text = {
    kStereoModes, fixed, decimalsFor, lengthText, pointOf, azimuthText, placeText, readOut, niceStep, compassMarks,
    spanOf, middleRowElevation, scaleBar, pageInView, formatFragment, parseFragment, layOutLabels,
  };
})((globalThis.vpe = globalThis.vpe || {}));
