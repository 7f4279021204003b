// Connects the buttons of the page and starts it. The last script of the page.
(function (vpe) {
  'use strict';

  const byId = (id) => document.getElementById(id);
  const kStereoTexts = {off: 'Stereo: off', anaglyph: 'Stereo: red-cyan', side: 'Stereo: side by side'};

  // Shows the state of the page in its buttons.
  function refresh(page) {
    const states = {
      compass: page.marks.hasCompass, names: page.marks.hasNames, motion: page.motion.isOn,
    };
    for (const button of document.querySelectorAll('[data-command]')) {
      const command = button.dataset.command;
      if (command in states) button.setAttribute('aria-pressed', String(states[command]));
      if (command === 'stereo') button.textContent = kStereoTexts[page.stereo];
    }
  }
  vpe.buttons = {refresh};

  // Returns which commands make sense for a panorama in this browser.
  function isUseful(command, data) {
    const marks = data.names.length + data.hotspots.length;
    const box = byId('page');
    switch (command) {
      case 'stereo': return data.eyes.length > 1;
      case 'motion': return vpe.input.MotionInput.isThere();
      case 'places': return marks > 0;
      case 'names': return data.names.length > 0;
      case 'fullScreen': return Boolean(box.requestFullscreen || box.webkitRequestFullscreen);
      case 'north': return data.has_north;
      default: return true;
    }
  }

  function connect(page) {
    const {data, stage} = page;
    new vpe.input.PointerInput(stage, page);
    document.addEventListener('keydown', (event) => vpe.input.handleKey(event, page));
    for (const button of document.querySelectorAll('[data-command]')) {
      button.hidden = !isUseful(button.dataset.command, data);
      button.addEventListener('click', () => page.command(button.dataset.command));
    }
    for (const button of document.querySelectorAll('[data-close]')) {
      button.addEventListener('click', () => byId(button.dataset.close).close());
    }
    const download = byId('download');
    download.hidden = !data.picture;
    if (data.picture) download.href = data.picture;
    vpe.panel.fillPlaces(byId('place-list'), data, {
      look: (direction) => {
        byId('places').close();
        page.look(direction);
        stage.focus();
      },
      pageOf: page.marks.pageOf,
    });
    addEventListener('hashchange', () => {
      if (location.hash.slice(1) === page.fragment) return;
      page.openFragment(location.hash);
      refresh(page);
      page.changed();
    });
    if (typeof ResizeObserver === 'function') new ResizeObserver(() => page.resize()).observe(stage);
    else addEventListener('resize', () => page.resize());
  }

  function start() {
    const data = globalThis.vpeData;
    const page = new vpe.page.Page(data);
    vpe.current = page;
    connect(page);
    for (const eye of data.eyes) page.loader.take(`${eye}/${data.pyramid.levels - 1}/0_0`);
    refresh(page);
    page.resize();
    byId('stage').focus({preventScroll: true});
  }

  start();
})((globalThis.vpe = globalThis.vpe || {}));
