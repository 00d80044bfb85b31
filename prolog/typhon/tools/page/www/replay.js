// A log in the views of the page, with the controls of its player below.

import { button, element } from './dom.js';
import { mount as mapView } from './map.js';
import { mount as spaceView } from './spacetime.js';
import { mount as sequenceView } from './sequence.js';
import { mount as timeView } from './charts.js';
import { decode, playerBar, Player } from './player.js';

const VIEWS = [['Map', mapView], ['Space–time', spaceView],
  ['Sequence', sequenceView], ['Time', timeView]];

// What views ask of the page they are on.
function quietApp() {
  const listeners = new Set();
  return {
    chosen: {}, prefs: {},
    on(name, listener) { if (name === 'select') listeners.add(listener); },
    select(what) {
      this.chosen = what || {};
      for (const listener of listeners) listener(this.chosen);
    },
    ask: () => Promise.reject(new Error('a log can only be looked at')),
  };
}

// log: what replay.pl has made of one.
export function showReplay(parent, log) {
  const player = new Player(decode(log)), app = quietApp();
  const views = VIEWS.map(([name, mount]) => ({ name, mount, view: null,
    panel: element('div', { class: 'replay-panel', role: 'tabpanel',
      'aria-label': name }) }));
  const show = chosen => {
    for (const [i, { panel }] of views.entries()) {
      panel.hidden = i !== chosen;
      tabs.children[i].setAttribute('aria-selected', String(i === chosen));
    }
    const shown = views[chosen];
    shown.view ||= shown.mount(shown.panel, player.store, app);
  };
  const tabs = element('div', { role: 'tablist', class: 'replay-tabs',
    'aria-label': 'Views of the log' }, ...views.map(({ name }, i) =>
    button(name, () => show(i), { role: 'tab' })));
  const whole = element('div', { class: 'replay' },
    element('header', {}, element('h2', {}, log.title), tabs),
    element('div', { class: 'replay-views' }, ...views.map(({ panel }) => panel)));
  parent.append(whole);
  playerBar(whole, player);
  show(0);
  player.seek(player.first);
  const end = () => {
    player.pause();
    for (const { view } of views) view?.destroy();
    whole.remove();
  };
  return { player, store: player.store, app, views, show, end };
}

// On the page: choose a log of this machine; the server, which can read it,
// makes a replay of it.
export function mount(parent, store, app) {
  const said = element('span', { role: 'status' },
    'A log of a network; log(File, [hops, messages, links, hosts]) tells most.');
  const opened = element('div', { class: 'replay-opened' });
  let shown = null, latest = null;
  const open = async file => {
    latest = file;
    said.textContent = `Reading ${file.name} …`;
    try {
      const log = await app.ask({ ask: 'replay', title: file.name,
                                  text: await file.text() });
      if (file !== latest) return null;
      said.textContent = '';
      shown?.end();
      shown = showReplay(opened, log);
    } catch (error) {
      if (file === latest)
        said.textContent = `${file.name} cannot be replayed: ${error.message}`;
    }
    return shown;
  };
  const input = element('input', { type: 'file', accept: '.pl,.log,.txt',
    onchange: () => { if (input.files[0]) open(input.files[0]); } });
  parent.append(element('section', { class: 'view view-replay',
    'aria-label': 'Replay' },
    element('div', { class: 'view-bar' },
      element('label', {}, 'Open a log ', input), said), opened));
  return { open };
}
