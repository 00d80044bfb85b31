// The view Map: hosts and links, and agents that travel along them.
//
// There are two canvases. The lower one has the static items; it is redrawn
// when they change, but at most every CALM ms for changes by the feed. The
// upper one has the moving items, and is drawn in each frame while there are
// any. Nothing is drawn without changes, or while the page is hidden.

import { arrange, Force, LAYOUTS, recognize } from './layout.js';
import { onTheme, Palette, paperPalette, legend } from './palette.js';
import { cut, Scene } from './mapscene.js';
import { absence, byName, counted, found, shortName } from './names.js';
import {
  button, choice, element, fillChoice, fitCanvas, onSize, pointers,
} from './dom.js';
import { Picture, saveButtons, write } from './svg.js';

const CALM = 160;               // ms; up to a second if drawing is slow
const FOUND = 200;              // marked results of a search, at most
const PATIENCE = 600;           // ms from new links to a layout check

const same = (a, b) => a && b && a.shape === b.shape && a.columns === b.columns;

export const mount = (parent, store, app) => new MapView(parent, store, app);

class MapView extends Picture {
  constructor(parent, store, app) {
    super(store, app);
    this.places = new Map();
    this.pinned = new Map();
    this.layout = app.prefs?.layout || 'auto';
    this.following = false;
    this.force = null;
    this.fitted = false;
    this.rest = CALM;           // ms until static items are redrawn
    this.ghost = null;          // the mark of an agent that the user drags
    this.build(parent);
    this.palette = new Palette(store, this.element);
    this.scene = new Scene(store, this.palette, this.places);
    this.ends = [
      store.on('change', () => this.changed()),
      onTheme(() => { this.palette.refresh(); this.legend.update(); this.redraw(); }),
      onSize(this.stage, (w, h) => this.resize(w, h)),
    ];
    app.on?.('select', chosen => this.chosen(chosen));
    pointers(this.top, this);
    this.top.addEventListener('dblclick', () => this.setFollowing(true));
    this.top.addEventListener('keydown', event => this.key(event));
    this.changed();
  }

  destroy() {
    super.destroy();
    cancelAnimationFrame(this.waiting);
    clearTimeout(this.calm);
    clearTimeout(this.looking);
  }

  // ------------------------------------------------------------ building

  build(parent) {
    this.base = element('canvas', { 'aria-hidden': 'true' });
    this.top = element('canvas', { tabindex: 0, role: 'application',
      'aria-label': 'Map of the network. Arrows: go from host to host, Enter: '
        + 'open it, comma and period: its agents, H: send the chosen agent '
        + 'here, plus and minus: zoom, 0: all, F: follow.' });
    this.empty = element('div', { class: 'view-empty' }, 'No hosts yet');
    this.stage = element('div', { class: 'view-stage' }, this.base, this.top,
      this.empty);
    this.said = element('div', { class: 'view-said', 'aria-live': 'polite' });
    this.legend = legend(this.store, () => this.palette, hidden => {
      this.scene.hidden = hidden;
      this.redraw();
    });
    this.element = element('section', { class: 'view view-map',
      'aria-label': 'Map' }, this.bar(), this.stage, this.said,
      this.legend.element);
    parent.append(this.element);
  }

  bar() {
    this.overlays = choice('Overlay', [['', 'nothing more']], '', name => {
      this.scene.overlay = name;
      this.redraw();
    });
    this.overlayLabel = element('label', { hidden: true }, 'Show', this.overlays);
    this.search = element('input', { type: 'search', placeholder: 'Search',
      'aria-label': 'Search hosts and agents',
      oninput: () => this.find(),
      onkeydown: event => { if (event.key === 'Enter') this.findNext(); } });
    this.followButton = button('Follow',
      () => this.setFollowing(!this.following),
      { 'aria-pressed': 'false', title: 'Keep the chosen agent in the middle' });
    return element('div', { class: 'view-bar' },
      element('label', {}, 'Layout', choice('Layout', LAYOUTS, this.layout,
        layout => this.setLayout(layout))),
      element('label', {}, 'Group', choice('Group',
        [['process', 'processes'], ['machine', 'machines'], 'none'], 'process',
        group => { this.scene.group = group; this.redraw(); })),
      this.overlayLabel, this.search, this.followButton,
      button('−', () => this.zoomBy(1 / 1.3), { 'aria-label': 'Zoom out' }),
      button('+', () => this.zoomBy(1.3), { 'aria-label': 'Zoom in' }),
      button('Fit', () => this.fit(), { title: 'Show all hosts' }),
      element('span', { class: 'view-gap' }),
      ...saveButtons('map', this));
  }

  resize(width, height) {
    const before = [this.width, this.height];
    [this.width, this.height] = [width, height];
    this.basePen = fitCanvas(this.base, width, height);
    this.topPen = fitCanvas(this.top, width, height);
    if (!this.scene) return;
    if (this.touched && before[0]) {    // keep the centre
      this.scene.x += (width - before[0]) / 2;
      this.scene.y += (height - before[1]) / 2;
    } else {
      this.fitted = false;
    }
    this.dirty = true;
    this.changed();
  }

  // ------------------------------------------------------------- changes

  // A hidden map is not updated: it is when it gets a size again.
  changed() {
    if (!this.stage.clientWidth) return;
    if (this.shape !== this.store.shape) this.reshape();
    const names = [...this.store.overlays.values()]
      .filter(({ values }) => values.size > 0).map(({ name }) => name);
    if (names.length !== this.overlays.length - 1) this.showOverlays(names);
    this.legend.update();
    this.stale = true;
    this.wake();
  }

  showOverlays(names) {
    this.overlayLabel.hidden = names.length === 0;
    fillChoice(this.overlays, [['', 'nothing more'],
      ...names.map(name => [name, this.store.overlays.get(name).title])],
      this.scene.overlay);
  }

  // Hosts or links were added or removed. Only new sets of hosts change
  // positions; changes of links do not move hosts.
  reshape() {
    this.shape = this.store.shape;
    const hosts = [...this.store.hosts.values()];
    this.empty.hidden = hosts.length > 0;
    const known = hosts.length === this.known && hosts.every(h => this.places.has(h.id));
    if (!known) this.lay(hosts);
    else if (this.layout === 'auto' && !this.looking)
      this.looking = setTimeout(() => { this.looking = 0; this.lookAgain(); }, PATIENCE);
    this.dirty = true;
  }

  // Links arrive after hosts, so the shape of a network is recognized only
  // then.
  lookAgain() {
    const hosts = [...this.store.hosts.values()];
    const shape = recognize(hosts, this.linksToLay());
    const unlaid = this.force && this.store.links.size > 1.5 * this.laidLinks;
    if (shape ? !same(shape, this.laid) : unlaid) this.lay(hosts);
  }

  // A replay knows all links in advance.
  linksToLay() { return this.store.plan || [...this.store.links.values()]; }

  lay(hosts) {
    const grown = this.known > 0;
    this.known = hosts.length;
    const links = this.linksToLay(), found = arrange(this.layout, hosts, links);
    this.laid = found && recognize(hosts, links);
    this.laidLinks = this.store.links.size;
    this.force = found ? null : new Force(hosts, links, this.places);
    for (const id of [...this.places.keys()])
      if (!this.store.hosts.has(id)) this.places.delete(id);
    for (const [id, place] of found || []) this.places.set(id, place);
    for (const [id, place] of this.pinned) this.place(id, place);
    this.scene.curved = Boolean(found);
    if (this.force) this.force.step(grown ? 8 : 60, this.places);
    if (!this.touched) this.fitted = false;
    this.redraw();
  }

  place(id, place) {
    if (!this.store.hosts.has(id)) return;
    this.places.set(id, place);
    this.force?.pin(id, place);
  }

  setLayout(layout) {
    this.layout = layout;
    if (this.app.prefs) this.app.prefs.layout = layout;
    this.pinned.clear();
    this.touched = false;
    this.lay([...this.store.hosts.values()]);
  }

  chosen(chosen) {
    this.scene.selected = chosen || {};
    if (!this.scene.selected.agent) this.setFollowing(false);
    this.wake();
  }

  // ------------------------------------------------------------- drawing

  redraw() {
    this.dirty = true;
    this.wake();
  }

  wake() {
    if (!this.waiting)
      this.waiting = requestAnimationFrame(() => this.frame());
  }

  frame() {
    this.waiting = 0;
    if (!this.stage.clientWidth) return;        // resized when it is shown
    const now = this.store.clock(), wall = performance.now();
    if (this.force) this.settle(wall);
    if (!this.fitted) this.fitNow();
    if (this.following) this.centre(now);
    this.pace(wall);
    if (this.dirty || (this.stale && wall - (this.drawn || 0) >= this.rest)) {
      this.scene.drawBase(this.basePen, this.width, this.height);
      this.dirty = this.stale = false;
      this.drawn = wall;
    }
    this.topPen.clearRect(0, 0, this.width, this.height);
    this.scene.drawTop(this.topPen, now);
    if (this.ghost) this.drawGhost();
    this.next();
  }

  // Continue the force layout; redraw while it moves hosts, and when it ends.
  settle(wall) {
    const moved = this.force.step(7, this.places);
    if (!moved && !this.unsettled) return;
    if (moved) this.stale = true;
    else this.dirty = true;
    if (!this.touched && (!moved || wall - (this.drawn || 0) >= this.rest))
      this.fitted = false;
    this.unsettled = moved;
    this.wake();
  }

  // Static items are drawn less often if frames take long.
  pace(wall) {
    const took = wall - (this.wallBefore || 0);
    this.wallBefore = wall;
    if (took > 300) return;             // no frames were needed
    this.rest = took > 30 ? Math.min(1000, this.rest * 1.15)
      : Math.max(CALM, this.rest * 0.97);
  }

  // Request another frame while marks move; otherwise when changes may be
  // drawn, or when a mark of the last frame has arrived.
  next() {
    const moving = this.store.moving.size;
    if (moving > 0 && !this.store.paused) this.wake();
    if (moving !== this.movingBefore) this.stale = true;
    this.movingBefore = moving;
    if (!this.stale || this.calm) return;
    this.calm = setTimeout(() => { this.calm = 0; this.wake(); }, CALM);
  }

  drawGhost() {
    const { id, x, y, host } = this.ghost, pen = this.topPen;
    const agent = this.store.agents.get(id);
    if (!agent) return;
    if (host) this.scene.ring(pen, host, 0, [], 4);
    pen.fillStyle = this.palette.of(agent.program);
    pen.beginPath();
    pen.arc(x, y, 9, 0, 2 * Math.PI);
    pen.fill();
    write(pen, cut(agent.name, 30), x + 14, y,
      { size: '600 12px', fill: this.palette.text });
  }

  // -------------------------------------------------------------- camera

  fit() {
    this.touched = false;
    this.fitted = false;
    this.setFollowing(false);
    this.wake();
  }

  fitNow() {
    const { scene, width, height } = this;
    const xs = [], ys = [];
    for (const { x, y } of this.places.values()) { xs.push(x); ys.push(y); }
    if (xs.length === 0) return;
    const extent = values => [values.reduce((a, b) => Math.min(a, b)) - 0.65,
                              values.reduce((a, b) => Math.max(a, b)) + 0.65];
    const [left, right] = extent(xs), [top, bottom] = extent(ys);
    scene.k = Math.min(150, width / (right - left), height / (bottom - top));
    scene.x = (width - scene.k * (left + right)) / 2;
    scene.y = (height - scene.k * (top + bottom)) / 2;
    this.fitted = true;
    this.dirty = true;
  }

  pan(dx, dy) {
    this.scene.x += dx;
    this.scene.y += dy;
    this.touched = true;
    this.setFollowing(false);
    this.redraw();
  }

  zoom(factor, x, y) {
    const { scene } = this;
    const k = Math.max(2, Math.min(600, scene.k * factor)), by = k / scene.k;
    scene.x = x - (x - scene.x) * by;
    scene.y = y - (y - scene.y) * by;
    scene.k = k;
    this.touched = true;
    this.redraw();
  }

  zoomBy(factor) { this.zoom(factor, this.width / 2, this.height / 2); }

  // Move the followed agent smoothly to the centre.
  centre(now) {
    const agent = this.store.agents.get(this.scene.selected.agent);
    const at = agent && this.scene.agentAt(agent, now);
    if (!at) return;
    const dx = this.width / 2 - at.x, dy = this.height / 2 - at.y;
    if (Math.hypot(dx, dy) < 0.5) return;
    this.scene.x += dx * 0.15;
    this.scene.y += dy * 0.15;
    this.touched = true;
    this.dirty = true;
    this.wake();
  }

  setFollowing(on) {
    const agent = this.scene?.selected.agent;
    if (on && !agent) {
      this.say('Choose an agent first, then it can be followed.');
      return;
    }
    if (on === this.following) return;
    this.following = on;
    this.followButton.setAttribute('aria-pressed', String(on));
    if (on && this.scene.k < 60) this.zoomBy(60 / this.scene.k);
    this.say(on ? `Following ${shortName(agent)}` : '');
    this.wake();
  }

  // ------------------------------------------------------------ pointers

  grab(x, y) { return this.scene.hit(x, y, this.store.clock()); }

  hover(x, y) {
    const hit = this.grab(x, y);
    const id = hit?.agent || hit?.host || '';
    if (id === this.hovered) return;
    this.hovered = id;
    this.top.style.cursor = id ? 'pointer' : '';
    this.say(hit ? this.describe(hit) : '');
  }

  click(x, y, what) {
    this.top.focus({ preventScroll: true });
    if (!what) return;
    this.scene.focus = null;
    this.app.select(what.agent ? { agent: what.agent } : { host: what.host });
  }

  drag(what, x, y) {
    if (what.agent) {
      const over = this.scene.hitHost(x, y);
      this.ghost = { id: what.agent, x, y, host: over?.host };
      this.wake();
    } else {
      const place = this.scene.toWorld(x, y);
      this.pinned.set(what.host, place);
      this.place(what.host, place);
      this.touched = true;
      this.redraw();
    }
  }

  drop(what, x, y) {
    this.ghost = null;
    this.wake();
    if (!what?.agent) return;
    const over = this.scene.hitHost(x, y);
    if (over) this.send(what.agent, over.host);
  }

  send(agent, host) {
    if (this.store.agents.get(agent)?.host === host) return;
    if (!this.app.act) {
      this.say('This page can only look.');
      return;
    }
    this.say(`${shortName(agent)} is ordered to go to ${shortName(host)}`);
    this.app.act({ do: 'move', agent, host });
  }

  // ------------------------------------------------------------ keyboard

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1],
                    ArrowDown: [0, 1] }[event.key];
    if (arrow && event.shiftKey) this.pan(-60 * arrow[0], -60 * arrow[1]);
    else if (arrow) this.step(arrow);
    else if (Object.hasOwn(KEYS, event.key)) KEYS[event.key](this);
    else return;
    event.preventDefault();
  }

  // Focus the nearest host in that direction.
  step([dx, dy]) {
    const from = this.scene.focus && this.scene.at(this.scene.focus);
    let nearest = null, least = Infinity;
    for (const id of this.places.keys()) {
      const at = this.scene.at(id);
      if (!at || id === this.scene.focus) continue;
      const x = at.x - (from ? from.x : 0), y = at.y - (from ? from.y : 0);
      const ahead = from ? x * dx + y * dy : Infinity;
      if (ahead <= 1) continue;
      const cost = from ? ahead + 2.5 * Math.abs(x * dy - y * dx) : Math.hypot(x, y);
      if (cost < least) [nearest, least] = [id, cost];
    }
    if (nearest) this.setFocus(nearest);
  }

  setFocus(id) {
    this.scene.focus = id;
    this.into(this.scene.at(id));
    this.say(this.describe({ host: id }));
    this.wake();
  }

  into({ x, y }) {
    const edge = 50;
    const dx = Math.max(0, edge - x) - Math.max(0, x - this.width + edge);
    const dy = Math.max(0, edge - y) - Math.max(0, y - this.height + edge);
    if (dx || dy) this.pan(dx, dy);
  }

  // Select the next agent on the focused host.
  nextAgent(by) {
    const host = this.store.hosts.get(this.scene.focus || this.scene.selected.host);
    if (!host || host.agents.size === 0) return;
    const ids = [...host.agents].map(agent => agent.id).sort(byName);
    const i = ids.indexOf(this.scene.selected.agent);
    const next = ids[(i + by + ids.length) % ids.length];
    this.app.select({ agent: next });
    this.say(this.describe({ agent: next }));
  }

  // -------------------------------------------------------------- search

  find() {
    const text = this.search.value;
    const ids = found(text, [this.store.hosts.values(), this.store.agents.values()]);
    this.scene.found = new Set(ids.slice(0, FOUND));
    this.foundAt = -1;
    if (text.trim()) this.say(`${ids.length} found`);
    this.wake();
  }

  findNext() {
    const ids = [...this.scene.found];
    if (ids.length === 0) return;
    this.foundAt = (this.foundAt + 1) % ids.length;
    const id = ids[this.foundAt], isHost = this.store.hosts.has(id);
    const agent = this.store.agents.get(id);
    const at = isHost ? this.scene.at(id)
      : agent && this.scene.agentAt(agent, this.store.clock());
    if (at) this.into(at);
    this.app.select(isHost ? { host: id } : { agent: id });
    this.say(this.describe(isHost ? { host: id } : { agent: id }));
  }

  // --------------------------------------------------------------- texts

  say(text) {
    if (this.said.textContent !== text) this.said.textContent = text;
  }

  describe({ agent: agentId, host: hostId }) {
    const agent = this.store.agents.get(agentId);
    if (agent)
      return `${agent.name}, ${agent.program}, ${agent.fault || agent.status}, `
        + `on ${shortName(agent.host)}, ${counted(agent.hops, 'hop')}`;
    const host = this.store.hosts.get(hostId);
    if (!host) return '';
    const links = [...host.links.keys()].map(shortName).sort(byName);
    const shown = links.length > 8 ? `${links.length} hosts`
      : links.join(' ') || 'no host';
    const value = this.store.overlays.get(this.scene.overlay)?.values.get(hostId);
    return `${host.name} (${host.process}), `
      + `${[host.state, absence(host)].filter(Boolean).join(' ')}, `
      + `${counted(host.agents.size, 'agent')}, linked to ${shown}`
      + (value === undefined ? '' : `, ${this.scene.overlay}: ${value}`);
  }

  // --------------------------------------------------------------- saving

  size() { return [this.width, this.height]; }

  drawAll(pen, width, height) {
    const { scene } = this;
    scene.palette = paperPalette(this.store, this.element);
    const now = this.store.clock();
    scene.drawBase(pen, width, height);
    scene.drawTop(pen, now);
    this.legend.draw(pen, scene.palette, 10, height - 14);
    scene.palette = this.palette;
  }
}

const KEYS = {
  '+': view => view.zoomBy(1.3),
  '=': view => view.zoomBy(1.3),
  '-': view => view.zoomBy(1 / 1.3),
  0: view => view.fit(),
  f: view => view.setFollowing(!view.following),
  ',': view => view.nextAgent(-1),
  '.': view => view.nextAgent(1),
  h: view => {
    const { focus, selected } = view.scene;
    if (focus && selected.agent) view.send(selected.agent, focus);
  },
  Enter: view => {
    if (view.scene.focus) view.app.select({ host: view.scene.focus });
  },
  Escape: view => {
    view.scene.focus = null;
    view.setFollowing(false);
    view.wake();
  },
};
