// Read-out, notices, dialogs and buttons.
(function (vpe) {
  'use strict';

  const {element, directionOf, textOf, pageLink} = vpe.marks;

  const kReadOut_ms = 100;

  // Shows what is under the pointer, and says what is in the middle of a view that rests.
  class ReadOut {
    constructor(boxes) {
      this.boxes = boxes;
      this.text = '';
      this.timer = 0;
      this.next = -Infinity;
    }

    // Shows what parts() returns, at once or some milliseconds later: at most ten times a second. `time` is that of
    // a frame.
    showSoon(time, parts) {
      if (this.timer !== 0) return;
      const wait = this.next - time;
      this.next = Math.max(time, this.next) + kReadOut_ms;
      if (wait <= 0) {
        this.show(parts());
        return;
      }
      this.timer = setTimeout(() => {
        this.timer = 0;
        this.show(parts());
      }, wait);
    }

    // Shows [label, text] pairs.
    show(parts) {
      const text = parts.map(([label, value]) => `${label} ${value}`).join('|');
      if (text === this.text) return;
      this.text = text;
      this.boxes.readout.replaceChildren(...parts.map(([label, value]) => {
        const part = element('span', 'part');
        part.append(element('span', 'what', label), ` ${value}`);
        return part;
      }));
    }

    // Gives a sentence to screen readers.
    say(parts) {
      const text = `${parts.map(([label, value]) => `${label} ${value}`).join(', ')}.`;
      if (this.boxes.spoken.textContent !== text) this.boxes.spoken.textContent = text;
    }
  }

  // Shows a sentence for some seconds. Screen readers read it.
  class Notice {
    constructor(box) {
      this.box = box;
      this.timer = 0;
    }

    show(text, seconds = 8) {
      clearTimeout(this.timer);
      this.box.textContent = text;
      this.box.hidden = text === '';
      if (seconds > 0) this.timer = setTimeout(() => this.show('', 0), 1000 * seconds);
    }
  }

  // Fills the list of names and other panoramas. look(mark) turns to one; pageOf(mark) returns the address of its page.
  function fillPlaces(list, data, {look, pageOf}) {
    const entry = (mark, isHotspot) => {
      const item = element('li', '');
      const button = element('button', '', `Look at ${textOf(mark)}`);
      button.type = 'button';
      button.addEventListener('click', () => look(directionOf(mark)));
      item.appendChild(button);
      if (isHotspot) {
        item.append(' ', pageLink('', `Go to the panorama ${mark.text}`, mark, pageOf));
      }
      return item;
    };
    list.replaceChildren(...data.hotspots.map((mark) => entry(mark, true)),
      ...data.names.map((mark) => entry(mark, false)));
  }

  // Opens a dialog, or closes it when it is open. Browsers without modal dialogs show it in place.
  function toggleDialog(dialog) {
    if (dialog.open) {
      dialog.close();
    } else if (typeof dialog.showModal === 'function') {
      dialog.showModal();
    } else {
      dialog.setAttribute('open', '');
    }
  }

  // Shows the address of a view, selected, and copies it where the browser allows that.
  function showLink(dialog, field, address) {
    field.value = address;
    if (!dialog.open) toggleDialog(dialog);
    field.focus();
    field.select();
    if (navigator.clipboard && navigator.clipboard.writeText) {
      navigator.clipboard.writeText(address).catch(() => {});
    }
  }

  // Puts the fragment into the address without a new entry of the history.
  function setFragment(fragment) {
    try {
      history.replaceState(null, '', `#${fragment}`);
    } catch (error) {
      // Some browsers refuse that for files; the address then stays as it is.
    }
  }

  // Enters or leaves full screen. Returns a promise of an empty text or of what is in the way.
  async function toggleFullScreen(box) {
    const current = document.fullscreenElement || document.webkitFullscreenElement;
    const leave = document.exitFullscreen || document.webkitExitFullscreen;
    const enter = box.requestFullscreen || box.webkitRequestFullscreen;
    if (!enter) return 'This browser has no full screen.';
    try {
      await (current ? leave.call(document) : enter.call(box));
    } catch (error) {
      return 'The browser did not allow full screen.';
    }
    return '';
  }

  vpe.panel = {ReadOut, Notice, fillPlaces, toggleDialog, showLink, setFragment, toggleFullScreen};
})((globalThis.vpe = globalThis.vpe || {}));
