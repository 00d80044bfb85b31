// The page: its views, the selection, and the connection to the hosts.

import { open } from './connection.js';
import { button, element } from './dom.js';
import { agentList, hostList } from './table.js';
import { Announcer, Store } from './store.js';
import { controlBar, Run } from './controls.js';
import { details } from './details.js';
import { workMenu } from './work.js';

// A view is a module with mount(element, store, app), or such a function. It is
// loaded when it is shown for the first time.
const VIEWS = [
  ['map', 'Map', () => import('./map.js')],
  ['hosts', 'Hosts', () => ({ mount: hostList })],
  ['agents', 'Agents', () => ({ mount: agentList })],
  ['tree', 'Supervision', () => import('./tree.js')],
  ['time', 'Time', () => import('./charts.js')],
  ['space', 'Space–time', () => import('./spacetime.js')],
  ['sequence', 'Sequence', () => import('./sequence.js')],
  ['replay', 'Replay', () => import('./replay.js')],
  ['world', 'World', () => import('./world.js')],
  ['model', 'Model', () => import('./model.js')],
];

// Views that only some pages have, which then open with them.
const EXTRA = ['world', 'model'];

const $ = id => document.getElementById(id);

class App extends Announcer {
  constructor(store) {
    super();
    this.store = store;
    this.prefs = rememberedPrefs();
    this.chosen = {};
    this.orders = new Set();    // that this page allows
    this.more = new Map();      // agent -> data that only snapshots contain
    this.mounted = new Map();   // name -> element
    this.views = new Map();     // name -> what mount() returned
    this.state = 'connecting';
  }

  // Select an agent or a host, or clear the selection with {}.
  select(chosen) {
    this.chosen = chosen;
    this.tell('select', chosen);
  }

  ask(message) { return this.connection.ask(message); }

  refresh() { return this.connection.refresh(); }

  // Show a note of this kind: 'said', 'warning' or 'error'.
  note(text, kind = 'said') {
    const note = element('p', { class: `note ${kind}` },
      element('span', {}, text),
      button('×', () => note.remove(), { 'aria-label': 'Dismiss' }));
    const notes = $('notes');
    notes.append(note);
    while (notes.children.length > 5) notes.firstChild.remove();
    if (kind !== 'error') setTimeout(() => note.remove(), 4000);
  }

  // Send an order. Returns its answer, or nothing if it failed, with a note.
  async order(message, said) {
    try {
      const answer = await this.ask(message);
      for (const problem of answer.said) this.note(problem.text, 'warning');
      if (said) this.note(said);
      return answer;
    } catch (error) {
      this.note(error.message, 'error');
      return undefined;
    }
  }

  show(name) {
    for (const [view, panel] of this.mounted) panel.hidden = view !== name;
    for (const tab of $('tabs').children) {
      const mine = tab.dataset.view === name;
      tab.setAttribute('aria-selected', String(mine));
      tab.tabIndex = mine ? 0 : -1;
    }
    this.prefs.view = name;
    this.view = name;
    if (!this.mounted.has(name)) this.mountView(name);
    this.tell('view', name);
  }

  async mountView(name) {
    const [, title, load] = VIEWS.find(([view]) => view === name);
    const panel = element('div', { class: 'panel', role: 'tabpanel',
      id: `panel-${name}`, 'aria-labelledby': `tab-${name}` });
    this.mounted.set(name, panel);
    $('views').append(panel);
    try {
      this.views.set(name, (await load()).mount(panel, this.store, this));
    } catch (error) {
      console.error(error);
      panel.append(element('p', { class: 'empty' },
        `${title} cannot be shown: ${error.message}`));
    }
  }
}

// The browser stores the options of views, if the user allows this.
function rememberedPrefs() {
  let prefs = {};
  try { prefs = JSON.parse(localStorage.getItem('typhon')) || {}; } catch { /* none */ }
  return new Proxy(prefs, { set(target, key, value) {
    target[key] = value;
    try { localStorage.setItem('typhon', JSON.stringify(target)); } catch { /* not kept */ }
    return true;
  } });
}

function tabs(app) {
  for (const [name, title] of VIEWS)
    $('tabs').append(button(title, () => app.show(name), { role: 'tab',
      id: `tab-${name}`, 'data-view': name, 'aria-controls': `panel-${name}` }));
  for (const name of EXTRA) $(`tab-${name}`).hidden = true;
  $('tabs').addEventListener('keydown', event => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const all = [...$('tabs').children].filter(tab => !tab.hidden);
    const next = all[(all.indexOf(event.target) + step + all.length) % all.length];
    next.focus();
    next.click();
  });
}

// ---------------------------------------------------------------- the state

const STATES = { connecting: globalThis.typhonWorker ? 'not started' : 'connecting',
  open: 'live', stopped: 'stopped',
  lost: 'connection lost, trying again', refused: 'refused, trying again' };

function stateLine(app) {
  let hops = app.store.counts.arrived, at = performance.now();
  const line = () => {
    const { hosts, agents, counts } = app.store, now = performance.now();
    if (now - at < 900 && $('state').dataset.state === app.state) return;
    const rate = (counts.arrived - hops) * 1000 / Math.max(1, now - at);
    [hops, at] = [counts.arrived, now];
    let there = 0, lost = 0, away = 0, running = 0;
    for (const host of hosts.values())
      if (host.state === 'running') there++;
      else if (host.state === 'away') away++;
      else if (host.state !== 'stopped') lost++;
    for (const agent of agents.values()) if (agent.status !== 'ended') running++;
    $('state').dataset.state = app.state;
    $('state').textContent = [STATES[app.state] + (app.why ? `: ${app.why}` : ''),
      app.readOnly ? 'only to look at' : null, count(there, 'host'),
      lost ? `${lost} lost` : null,
      away ? `${away} away` : null,
      count(running, 'agent'), rate >= 0.5 ? `${count(Math.round(rate), 'hop')}/s` : null,
      counts.skipped ? `${counts.skipped} events skipped` : null]
      .filter(Boolean).join(' · ');
  };
  setInterval(() => { if (!document.hidden) line(); }, 1000);
  app.on('state', line);
  app.store.on('change', line);
}

const count = (n, what) => `${n.toLocaleString('en')} ${what}${n === 1 ? '' : 's'}`;

// --------------------------------------------------------------- the hosts

function connect(app) {
  const { store } = app;
  let resync = null;
  const state = (state, why = '') => {
    if (app.state === 'open' && state === 'lost')
      app.note('The connection is lost. What is shown is as it was.', 'warning');
    [app.state, app.why] = [state, why];
    document.body.dataset.state = state;
    app.tell('state', state);
  };
  app.connection = open({
    state,
    snapshot(snapshot) {
      if (snapshot.read_only !== undefined) setReadOnly(app, snapshot.read_only);
      if (snapshot.orders) app.orders = new Set(snapshot.orders);
      for (const name of EXTRA)
        if (snapshot[name] !== undefined) setExtra(app, name, snapshot[name]);
      app.more = new Map(snapshot.agents.map(agent => [agent.id, agent]));
      store.applySnapshot(snapshot);
      forgetStopped(store, snapshot);
      app.tell('snapshot');
    },
    events(events) {
      store.applyEvents(events);
      if (events.some(event => event[3] === 'skipped' || event[3] === 'started'))
        lookAnew(1000);
      else if (events.some(event => event[3] === 'stopped'))
        lookAnew(10000);
    },
  });

  // Request a new snapshot after missed events.
  function lookAnew(wait) {
    resync ??= setTimeout(() => {
      resync = null;
      app.refresh().catch(() => {});
    }, wait);
  }
}

// Remove hosts that were stopped and are not in the snapshot.
function forgetStopped(store, snapshot) {
  const there = new Set(snapshot.hosts.map(host => host.id));
  for (const host of [...store.hosts.values()])
    if (host.state === 'stopped' && !there.has(host.id)) {
      store.hosts.delete(host.id);
      store.shape++;
    }
}

function setReadOnly(app, readOnly) {
  if (app.readOnly === readOnly) return;
  app.readOnly = readOnly;
  document.body.classList.toggle('read-only', readOnly);
  app.act = readOnly ? undefined : message => app.order(message);
  $('actions').replaceChildren(...(readOnly ? [] : [workMenu(app)]));
  app.tell('rights');
}

function setExtra(app, name, there) {
  const tab = $(`tab-${name}`);
  if (tab.hidden === !there) return;
  tab.hidden = !there;
  if (there !== (app.view === name)) app.show(there ? name : 'map');
}

// While a list is shown, request snapshots at intervals, for data that no event
// contains.
function keepFresh(app) {
  let pause = 3000;
  const look = async () => {
    if (!document.hidden && ['hosts', 'agents'].includes(app.view)
        && app.state === 'open') {
      const start = performance.now();
      try { await app.refresh(); } catch { /* state() reports it */ }
      pause = Math.max(3000, 10 * (performance.now() - start));
    }
    setTimeout(look, pause);
  };
  setTimeout(look, pause);
}

// The controls of virtual time, above all views.
function control(app) {
  const run = app.run = new Run({ ask: message => app.ask(message),
    may: order => app.orders.has(order) },
  () => !document.hidden && app.state === 'open');
  run.on('error', text => app.note(text, 'error'));
  $('run').append(controlBar(run));
}

const store = new Store();
const app = new App(store);

// Show unhandled rejections, too.
addEventListener('unhandledrejection', ({ reason }) =>
  app.note(reason?.message ?? String(reason), 'error'));

tabs(app);
details($('details'), store, app);
stateLine(app);
connect(app);
keepFresh(app);
control(app);
app.show(VIEWS.some(([name]) => name === app.prefs.view) ? app.prefs.view : 'map');
globalThis.typhon = { store, app };     // for the console of the browser
