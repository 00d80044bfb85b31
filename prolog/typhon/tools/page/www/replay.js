// The view Replay: a log in the views of the page, above the controls of its
// player.

import { button, element, choice } from './dom.js';
import { mount as mapView } from './map.js';
import { mount as spaceView } from './spacetime.js';
import { mount as sequenceView } from './sequence.js';
import { mount as timeView } from './charts.js';
import { Announcer, Store } from './store.js';

const VIEWS = [['Map', mapView], ['Space–time', spaceView],
  ['Sequence', sequenceView], ['Time', timeView]];

// The interface of the page that views use, without a server.
class QuietApp extends Announcer {
  chosen = {};
  prefs = {};

  select(what) {
    this.chosen = what || {};
    this.tell('select', this.chosen);
  }

  ask() { return Promise.reject(new Error('a log can only be looked at')); }
}

// log: a log as converted by replay.pl.
export function showReplay(parent, log) {
  const player = new Player(decode(log)), app = new QuietApp();
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

// On the page the user chooses a log of this machine, and the server converts
// it.
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

// A log in the same views: a store whose clock follows a slider.
//
// The events are those of the opened file, as converted by replay.pl:
// {snapshot, events, overlays, title}. To go back, the player begins again and
// applies all earlier events.

const SPEEDS = [0.01, 0.1, 0.25, 0.5, 1, 2, 5, 10, 50, 200, 1000];
const CHUNK = 2000;             // events applied at a time
const SHOWN = 40;               // default seconds in which a log is played

export class Player {
  constructor(log) {
    this.log = log;
    this.events = known(log.events);
    const times = this.events.map(event => event[0]);
    this.first = times.length ? times[0] : 0;
    this.last = times.length ? times[times.length - 1] : 0;
    this.time = this.first;
    this.next = 0;              // the first event that is not applied
    this.playing = false;
    this.listeners = new Set();
    const span = this.last - this.first;
    this.store = new Store({ clock: () => this.time, stamped: true,
                             width: fitting(span) });
    this.store.paused = true;
    this.store.plan = allLinks(log, this.events);
    this.setSpeed(nearest(span / SHOWN));
    this.begin();
  }

  onTime(listener) { this.listeners.add(listener); }

  begin() {
    this.store.reset();
    if (this.log.snapshot)
      this.store.applySnapshot({ ...this.log.snapshot, time: this.first });
    for (const overlay of this.log.overlays || []) this.store.overlay(overlay);
    this.next = 0;
  }

  // Show the state at time: after all events up to it, and no others.
  seek(time) {
    const to = Math.max(this.first, Math.min(this.last, time));
    if (to < this.time) this.begin();
    this.time = to;
    this.applyUntil(to);
    this.store.touch();
    for (const listener of this.listeners) listener(this);
  }

  applyUntil(time) {
    while (this.next < this.events.length && this.events[this.next][0] <= time) {
      const from = this.next, most = Math.min(from + CHUNK, this.events.length);
      while (this.next < most && this.events[this.next][0] <= time) this.next++;
      this.store.applyEvents(this.events.slice(from, this.next));
    }
  }

  // Go to the next or the previous event; events at the same time are one step.
  step(by) {
    this.pause();
    if (by > 0 && this.next < this.events.length)
      this.seek(this.events[this.next][0]);
    else if (by < 0) this.seek(this.before());
  }

  before() {
    let i = this.next - 1;
    if (i < 0) return this.first;
    const now = this.events[i][0];
    while (i >= 0 && this.events[i][0] === now) i--;
    return i >= 0 ? this.events[i][0] : this.first;
  }

  setSpeed(speed) {
    this.speed = speed;
    this.store.rate = speed;
  }

  play() {
    if (this.playing) return;
    if (this.time >= this.last) this.seek(this.first);
    this.playing = true;
    this.store.paused = false;
    this.wall = performance.now();
    this.frame = requestAnimationFrame(() => this.tick());
    this.seek(this.time);
  }

  pause() {
    this.playing = false;
    this.store.paused = true;
    cancelAnimationFrame(this.frame);
  }

  tick() {
    const wall = performance.now();
    const passed = Math.min(0.25, (wall - this.wall) / 1000);
    this.wall = wall;
    if (this.time >= this.last) this.pause();
    this.seek(this.time + passed * this.speed);
    if (this.playing) this.frame = requestAnimationFrame(() => this.tick());
  }
}

// Texts in events are indexes into names, and numbers are lists of one element.
export function decode(log) {
  const { names } = log;
  const item = given => (Array.isArray(given) ? given[0]
    : given === null ? null : names[given]);
  return { ...log, events: log.events.map(([time, ...items]) =>
    [time, ...items.map(item)]) };
}

// Returns the events in the order of time. A departure also gets the duration
// of the hop and the time until the next hop of the agent: [..., 'left', to,
// seconds, room].
function known(events) {
  const sorted = events.map((event, i) => [event, i])
    .sort(([a, i], [b, j]) => a[0] - b[0] || i - j).map(([event]) => [...event]);
  const out = new Map();        // agent -> its last departure
  for (const event of sorted) {
    const [time, host, agent, kind] = event, left = out.get(agent);
    if (kind === 'left') {
      if (left && left.length > 5) left.push(time - left[0]);
      out.set(agent, event);
    } else if (kind === 'stayed') {
      out.delete(agent);
    } else if (kind === 'arrived' && left?.length === 5 && left[4] === host) {
      left.push(Math.max(0, time - left[0]));
    }
  }
  return sorted;
}

// The links that exist at any time, which determine the layout.
function allLinks(log, events) {
  const links = [];
  for (const { id, links: others } of log.snapshot?.hosts || [])
    for (const [other] of others || []) links.push({ a: id, b: other });
  for (const [, host, , kind, other] of events)
    if (kind === 'link') links.push({ a: host, b: other });
  return links;
}

const nearest = wanted => SPEEDS.reduce((a, b) =>
  (Math.abs(Math.log(b / Math.max(wanted, 1e-3)))
    < Math.abs(Math.log(a / Math.max(wanted, 1e-3))) ? b : a));

// The width of a stretch, for some hundred stretches of history.
const fitting = span => {
  const rough = span / 300, power = 10 ** Math.floor(Math.log10(rough || 1));
  return [1, 2, 5, 10].map(n => n * power).find(width => width >= rough) || 1;
};

// The controls: slider, play, speed, step. Space and arrows do the same.
export function playerBar(parent, player) {
  const slider = element('input', { type: 'range', min: 0, max: 1000, step: 'any',
    value: 0, 'aria-label': 'Time',
    oninput: () => { player.pause(); player.seek(timeAt(Number(slider.value))); } });
  const shown = element('output', { 'aria-label': 'Time' });
  const play = button('Play', () => toggle(), { 'aria-label': 'Play' });
  const toggle = () => { player.playing ? player.pause() : player.play(); update(); };
  const span = Math.max(1e-9, player.last - player.first);
  const timeAt = value => player.first + span * value / 1000;
  const day = player.first > 1e8;
  const bar = element('div', { class: 'replay-bar', role: 'group',
    'aria-label': 'Replay' },
    button('«', () => { player.pause(); player.seek(player.first); },
      { 'aria-label': 'To the beginning' }),
    button('‹', () => player.step(-1), { 'aria-label': 'Step back' }),
    play,
    button('›', () => player.step(1), { 'aria-label': 'Step on' }),
    button('»', () => { player.pause(); player.seek(player.last); },
      { 'aria-label': 'To the end' }),
    slider, shown,
    element('label', {}, 'Speed', choice('Speed',
      SPEEDS.map(speed => [speed, `${speed} ×`]), player.speed,
      speed => player.setSpeed(Number(speed)))));

  const update = () => {
    slider.value = (player.time - player.first) / span * 1000;
    const said = day ? new Date(player.time * 1000).toLocaleTimeString('en-GB')
      : `${player.time.toFixed(span < 100 ? 2 : 1)} s`;
    shown.textContent = said;
    slider.setAttribute('aria-valuetext', said);
    play.textContent = player.playing ? 'Pause' : 'Play';
    play.setAttribute('aria-label', player.playing ? 'Pause' : 'Play');
  };
  player.onTime(update);
  update();
  parent.append(bar);
  return bar;
}
