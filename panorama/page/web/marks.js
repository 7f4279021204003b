// What is drawn over the picture: the compass, names, other panoramas, the scale.
(function (vpe) {
  'use strict';

  const {compassMarks, scaleBar, layOutLabels, lengthText} = vpe.text;

  const kCompassPx = 26;
  const kFont = '13px system-ui, sans-serif';
  const kMostLabels = 60;

  function element(kind, className, text) {
    const made = document.createElement(kind);
    made.className = className;
    if (text !== undefined) made.textContent = text;
    return made;
  }

  // Returns where a mark of the data lies.
  const directionOf = (mark) => ({azimuth: mark.azimuth_deg, elevation: mark.elevation_deg});
  const textOf = (mark) => (mark.range_m ? `${mark.text}, ${lengthText(mark.range_m)}` : mark.text);

  // Makes a link to the page of another panorama, which opens with the view at the time when the link is used.
  // pageOf(mark) returns its address.
  function pageLink(kind, text, mark, pageOf) {
    const link = element('a', kind, text);
    link.href = mark.page;
    for (const use of ['pointerdown', 'focus', 'click']) {
      link.addEventListener(use, () => {
        link.href = pageOf(mark);
      });
    }
    return link;
  }

  class Marks {
    // `boxes` has the elements compass, labels, hotspots, scale and scaleText. focused(mark) is called when a
    // hotspot gets the keyboard. seen() returns the view as it is.
    constructor(data, boxes, {focused, seen}) {
      this.data = data;
      this.boxes = boxes;
      this.pageOf = (mark) => vpe.text.pageInView(mark.page, seen(), data.has_north);
      this.hasCompass = true;
      this.hasNames = true;
      const pen = boxes.compass.getContext('2d');
      this.pen = pen;
      pen.font = kFont;
      this.labels = data.names.map((mark) => ({
        mark, text: textOf(mark), width: pen.measureText(textOf(mark)).width + 10,
      }));
      this.hotspots = data.hotspots.map((mark) => {
        const link = pageLink('hotspot', textOf(mark), mark, this.pageOf);
        link.hidden = true;
        link.title = `Go to the panorama ${mark.text}`;
        link.addEventListener('focus', () => focused(mark));
        boxes.hotspots.appendChild(link);
        return {mark, link};
      });
    }

    // Draws all marks. `isBare` leaves only the picture, as for two eyes side by side.
    draw(view, {density, isBare, range}) {
      this.drawCompass(view, density, isBare);
      this.drawLabels(view, isBare);
      this.drawHotspots(view, isBare);
      const scale = this.boxes.scale;
      scale.hidden = isBare;
      if (isBare) return;
      const bar = scaleBar(view, range, Math.min(160, view.width / 3));
      if (this.boxes.scaleText.textContent !== bar.text) this.boxes.scaleText.textContent = bar.text;
      scale.style.width = `${bar.px.toFixed(1)}px`;
    }

    drawCompass(view, density, isBare) {
      const canvas = this.boxes.compass;
      canvas.hidden = isBare || !this.hasCompass;
      if (canvas.hidden) return;
      const width = Math.round(view.width * density);
      const height = Math.round(kCompassPx * density);
      if (canvas.width !== width || canvas.height !== height) {
        canvas.width = width;
        canvas.height = height;
      }
      const pen = this.pen;
      pen.setTransform(density, 0, 0, density, 0, 0);
      pen.clearRect(0, 0, view.width, kCompassPx);
      pen.fillStyle = 'rgba(0, 0, 0, 0.45)';
      pen.fillRect(0, 0, view.width, kCompassPx);
      pen.font = kFont;
      pen.textAlign = 'center';
      pen.textBaseline = 'middle';
      for (const {x, text, isMajor} of compassMarks(view, this.data.has_north)) {
        pen.fillStyle = isMajor ? '#ffd479' : '#ffffff';
        pen.fillRect(x - 0.5, kCompassPx - 6, 1, 6);
        pen.fillText(text, x, 10);
      }
    }

    drawLabels(view, isBare) {
      const box = this.boxes.labels;
      box.hidden = isBare || !this.hasNames;
      if (box.hidden) return;
      const seen = [];
      for (const label of this.labels) {
        const at = view.screen(directionOf(label.mark));
        if (at === null || at.x < 0 || at.y < 0 || at.x > view.width || at.y > view.height) continue;
        seen.push({...label, x: at.x, y: at.y});
        if (seen.length >= 3 * kMostLabels) break;
      }
      const placed = layOutLabels(seen, {height: view.height}).slice(0, kMostLabels);
      while (box.children.length > placed.length) box.lastChild.remove();
      while (box.children.length < placed.length) {
        const label = element('div', 'label');
        label.append(element('span', 'name'), element('i', 'leader'));
        box.appendChild(label);
      }
      placed.forEach((label, n) => {
        const shown = box.children[n];
        if (shown.firstChild.textContent !== label.text) shown.firstChild.textContent = label.text;
        shown.lastChild.style.height = `${label.leader}px`;
        shown.style.transform = `translate(${label.x.toFixed(1)}px, ${label.y.toFixed(1)}px)`;
      });
    }

    drawHotspots(view, isBare) {
      for (const {mark, link} of this.hotspots) {
        const at = isBare ? null : view.screen(directionOf(mark));
        const isSeen = at !== null && at.x >= 0 && at.y >= 0 && at.x <= view.width && at.y <= view.height;
        // One that has the keyboard stays until the view has reached it.
        if (!isSeen && document.activeElement === link) continue;
        link.hidden = !isSeen;
        if (!isSeen) continue;
        link.style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px) translate(-50%, -100%)`;
      }
    }
  }

  vpe.marks = {Marks, directionOf, textOf, element, pageLink};
})((globalThis.vpe = globalThis.vpe || {}));
