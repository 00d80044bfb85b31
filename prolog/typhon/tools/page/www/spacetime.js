// The view Space-time: each host is a row, each agent a line, level while it
// stays and steep while it hops; messages are thin arrows.

import { button, calmly, choice, element, fitCanvas, onSize } from './dom.js';
import { cut } from './mapscene.js';
import { onTheme, Palette, paperPalette, legend } from './palette.js';
import { line, Picture, saveButtons, textWidth, write } from './svg.js';
import { byName, shortName, timeText, timeTicks } from './names.js';
import { story } from './story.js';

const CALM = 250;
const LEAST = 16;               // pixels of a row
const MANY = 30;                // hosts; with more, only hops at first
const SPANS = [['2', '2 s'], ['10', '10 s'], ['60', '1 min'], ['600', '10 min'],
  ['all', 'all']];

export const mount = (parent, store, app) => new SpaceTime(parent, store, app);

class SpaceTime extends Picture {
  constructor(parent, store, app) {
    super(store, app);
    this.span = store.stamped ? 'all' : '10';
    this.messages = true;
    this.resting = true;
    this.scroll = 0;
    this.hidden = new Set();
    this.build(parent);
    this.palette = new Palette(store, this.element);
    const later = calmly(store.stamped ? 30 : CALM, () => this.draw());
    this.ends = [
      store.on('change', () => { if (!this.held) later(); }),
      later.stop,
      onTheme(() => { this.palette.refresh(); this.draw(); }),
      onSize(this.stage, (w, h) => {
        [this.width, this.height] = [w, h];
        this.pen = fitCanvas(this.canvas, w, h);
        this.draw();
      }),
    ];
    app.on?.('select', () => this.draw());
    this.canvas.addEventListener('click', event => this.click(event));
    this.canvas.addEventListener('wheel', event => {
      event.preventDefault();
      this.scrollBy(event.deltaY);
    }, { passive: false });
    this.canvas.addEventListener('keydown', event => {
      const by = { ArrowDown: 40, ArrowUp: -40, PageDown: 300, PageUp: -300 }[event.key];
      if (!by) return;
      event.preventDefault();
      this.scrollBy(by);
    });
  }

  build(parent) {
    this.canvas = element('canvas', { tabindex: 0, role: 'img',
      'aria-label': 'Hosts by time, agents as lines' });
    this.empty = element('div', { class: 'view-empty' }, 'Nothing has happened yet');
    this.stage = element('div', { class: 'view-stage' }, this.canvas, this.empty);
    this.legend = legend(this.store, () => this.palette, hidden => {
      this.hidden = hidden;
      this.draw();
    });
    this.pauseButton = button('Hold', () => this.hold(), { 'aria-pressed': 'false',
      title: 'What is seen stays, while the network goes on' });
    const only = element('input', { type: 'checkbox',
      onchange: () => { this.only = only.checked; this.draw(); } });
    this.boxes = [['messages', 'messages'], ['resting', 'agents that stay']]
      .map(([name, title]) => {
        const box = element('input', { type: 'checkbox', checked: true, name,
          onchange: () => { this[name] = box.checked; this.draw(); } });
        return { name, box, label: element('label', {}, box, title) };
      });
    this.element = element('section', { class: 'view view-space',
      'aria-label': 'Space and time' },
      element('div', { class: 'view-bar' },
        element('label', {}, 'Time', choice('Time', SPANS, this.span,
          span => { this.span = span; this.draw(); })),
        ...this.boxes.map(({ label }) => label),
        element('label', {}, only, 'only the chosen agent'),
        this.store.stamped ? null : this.pauseButton,
        element('span', { class: 'view-gap' }),
        ...saveButtons('space-time', this)),
      this.stage, this.legend.element);
    parent.append(this.element);
  }

  hold() {
    this.held = this.held ? null : [...this.store.remembered()];
    this.heldAt = this.store.time;
    this.pauseButton.setAttribute('aria-pressed', String(Boolean(this.held)));
    this.draw();
  }

  scrollBy(pixels) {
    this.scroll = Math.max(0, this.scroll + pixels);
    this.draw();
  }

  // ------------------------------------------------------------- picture

  // The visible part: the story of the chosen time, and its rows.
  sight() {
    const events = this.held || [...this.store.remembered()];
    const times = events.filter(event => typeof event[0] === 'number');
    if (times.length === 0) return null;
    const now = this.held ? this.heldAt
      : this.store.stamped ? this.store.clock() : this.store.time;
    const first = Math.min(times[0][0], times[times.length - 1][0]);
    const from = this.span === 'all' ? first : Math.max(first, now - Number(this.span));
    const chosen = this.app.chosen?.agent;
    const history = story(this.only && chosen
      ? events.filter(event => concerns(event, chosen)) : events, now);
    const rows = this.rows(history);
    return { history, rows, from, to: Math.max(now, from + 1e-3) };
  }

  rows(history) {
    const hosts = new Set();
    for (const { host } of history.stays) hosts.add(host);
    for (const { a, b } of history.hops) hosts.add(a).add(b);
    return [...hosts].sort(byName);
  }

  // Set the options when hosts are known: with many hosts, messages and agents
  // that stay would hide the hops.
  begin() {
    this.begun = true;
    for (const { name, box } of this.boxes)
      this[name] = box.checked = this.store.hosts.size <= MANY;
  }

  draw() {
    if (!this.stage.clientWidth || !this.palette) return;
    if (!this.begun && this.store.hosts.size > 0) this.begin();
    const sight = this.sight();
    this.empty.hidden = Boolean(sight);
    this.legend.update();
    this.pen.fillStyle = this.palette.bg;
    this.pen.fillRect(0, 0, this.width, this.height);
    this.lines = sight ? this.picture(this.pen, this.palette, sight, this.height) : [];
  }

  // Draws the picture, and returns the lines of agents, to find an agent at a
  // position: [agent, x1, y1, x2, y2].
  picture(pen, palette, { history, rows, from, to }, height) {
    const left = this.margin(pen, rows), top = 22, right = this.width - 12;
    const high = Math.max(LEAST, Math.min(60, (height - top - 6) / rows.length));
    const most = Math.max(0, rows.length * high + top + 6 - height);
    this.scroll = Math.min(this.scroll, most);
    const number = new Map(rows.map((host, i) => [host, i]));
    const x = time => left + (right - left) * (time - from) / (to - from);
    const rowTop = host => top + number.get(host) * high - this.scroll;
    const y = (host, lane) => rowTop(host) + high * 0.12
      + high * 0.76 * ((lane ?? 0) + 0.5) / (history.lanes.get(host) || 1);

    this.movers = new Set(history.hops.map(({ agent }) => agent));
    this.drawRows(pen, palette, rows, rowTop, high, left, right);
    pen.save();
    pen.beginPath();
    pen.rect(left, top, right - left, Math.max(1, height - top));
    pen.clip();
    const lines = this.drawAgents(pen, palette, history, x, y, high);
    if (this.messages) this.drawLetters(pen, palette, history, x, y);
    this.drawMarks(pen, palette, history, x, y);
    pen.restore();
    pen.fillStyle = palette.bg;
    pen.fillRect(0, 0, this.width, top);
    this.drawTimes(pen, palette, from, to, x, top);
    return lines;
  }

  margin(pen, rows) {
    const widest = rows.reduce((most, host) =>
      Math.max(most, textWidth(pen, cut(shortName(host), 18), '11px')), 0);
    return Math.min(this.width * 0.3, widest + 16);
  }

  drawRows(pen, palette, rows, rowTop, high, left, right) {
    rows.forEach((host, i) => {
      const top = rowTop(host);
      if (top > this.height || top + high < 0) return;
      pen.fillStyle = i % 2 ? palette.bg : palette.surface;
      pen.fillRect(left, top, right - left, high);
      write(pen, cut(shortName(host), 18), left - 6, top + high / 2,
        { size: '11px', fill: palette.text, align: 'right' });
    });
  }

  drawTimes(pen, palette, from, to, x, top) {
    pen.strokeStyle = palette.faint;
    pen.lineWidth = 1;
    for (const time of timeTicks(from, to, Math.max(2, this.width / 110))) {
      write(pen, timeText(time, to - from), x(time), top - 5, { size: '10px',
        fill: palette.muted, align: 'center', baseline: 'bottom' });
      line(pen, x(time), top - 4, x(time), top);
    }
  }

  shown(agent) {
    const known = this.store.agents.get(agent);
    return (this.resting || this.movers.has(agent))
      && (!known || !this.hidden.has(known.program));
  }

  drawAgents(pen, palette, { stays, hops }, x, y, high) {
    const lines = [];
    const chosen = this.app.chosen?.agent;
    const laneAt = new Map();
    for (const stay of stays) {
      laneAt.set(`${stay.agent} ${stay.from}`, stay.lane);
      laneAt.set(`${stay.agent} to ${stay.to}`, stay.lane);
      const row = y(stay.host, stay.lane);
      lines.push([stay.agent, x(stay.from), row, x(stay.to), row]);
    }
    for (const { agent, a, from, b, to } of hops)
      lines.push([agent, x(from), y(a, laneAt.get(`${agent} to ${from}`)),
                  x(to), y(b, laneAt.get(`${agent} ${to}`))]);
    const groups = new Map();   // colour -> lines
    for (const line of lines) {
      if (!this.shown(line[0]) || line[3] < 0) continue;
      const colour = palette.of(this.store.agents.get(line[0])?.program || '?');
      const key = line[0] === chosen ? `chosen ${colour}` : colour;
      if (!groups.has(key)) groups.set(key, []);
      groups.get(key).push(line);
    }
    const thick = Math.max(1.2, Math.min(3, high / 10));
    for (const [key, group] of groups) {
      const own = key.startsWith('chosen ');
      pen.strokeStyle = own ? key.slice(7) : key;
      pen.globalAlpha = chosen && !own ? 0.45 : 1;
      pen.lineWidth = own ? thick + 2.5 : thick;
      pen.beginPath();
      for (const [, x1, y1, x2, y2] of group) {
        pen.moveTo(x1, y1);
        pen.lineTo(Math.max(x2, x1 + 0.6), y2);
      }
      pen.stroke();
    }
    pen.globalAlpha = 1;
    return lines;
  }

  drawLetters(pen, palette, { letters }, x, y) {
    pen.strokeStyle = palette.muted;
    pen.fillStyle = palette.muted;
    pen.lineWidth = 0.8;
    pen.globalAlpha = 0.8;
    const heads = [];
    pen.beginPath();
    for (const { a, from, b, to } of letters) {
      if (a === null || b === null || x(to) < 0) continue;
      const [x1, y1, x2, y2] = [x(from), y(a), x(to), y(b)];
      pen.moveTo(x1, y1);
      pen.lineTo(x2, y2);
      heads.push([x1, y1, x2, y2]);
    }
    pen.stroke();
    pen.beginPath();
    for (const head of heads) arrowHead(pen, ...head, 5);
    pen.fill();
    pen.globalAlpha = 1;
  }

  drawMarks(pen, palette, { marks, stays }, x, y) {
    const lanes = new Map(stays.map(stay => [`${stay.agent} ${stay.host}`, stay.lane]));
    for (const { kind, agent, host, time } of marks) {
      if (!this.shown(agent)) continue;
      const at = x(time), row = y(host, lanes.get(`${agent} ${host}`));
      const colour = palette.of(this.store.agents.get(agent)?.program || '?');
      if (kind === 'begins' || kind === 'clone') {
        pen.fillStyle = colour;
        pen.beginPath();
        pen.arc(at, row, kind === 'begins' ? 3 : 2, 0, 2 * Math.PI);
        pen.fill();
      } else {
        pen.strokeStyle = kind === 'fails' ? palette.bad : colour;
        pen.lineWidth = 2;
        pen.beginPath();
        pen.moveTo(at - (kind === 'fails' ? 4 : 0), row - 4);
        pen.lineTo(at + (kind === 'fails' ? 4 : 0), row + 4);
        if (kind === 'fails') {
          pen.moveTo(at + 4, row - 4);
          pen.lineTo(at - 4, row + 4);
        }
        pen.stroke();
      }
    }
  }

  click(event) {
    const box = this.canvas.getBoundingClientRect();
    const px = event.clientX - box.left, py = event.clientY - box.top;
    let nearest = null, least = 8;
    for (const [agent, x1, y1, x2, y2] of this.lines) {
      const length = (x2 - x1) ** 2 + (y2 - y1) ** 2 || 1;
      const share = Math.max(0, Math.min(1,
        ((px - x1) * (x2 - x1) + (py - y1) * (y2 - y1)) / length));
      const distance = Math.hypot(px - x1 - share * (x2 - x1),
                                  py - y1 - share * (y2 - y1));
      if (distance < least) [nearest, least] = [agent, distance];
    }
    if (nearest) this.app.select({ agent: nearest });
  }

  // -------------------------------------------------------------- saving

  // Draws all rows, on white.
  drawAll(pen, width, height) {
    const palette = paperPalette(this.store, this.element), sight = this.sight();
    const scroll = this.scroll;
    this.scroll = 0;
    const before = this.height;
    this.height = height;
    pen.fillStyle = palette.bg;
    pen.fillRect(0, 0, width, height);
    if (sight) this.picture(pen, palette, sight, height - 22);
    this.legend.draw(pen, palette, 10, height - 11);
    this.scroll = scroll;
    this.height = before;
  }

  size() {
    const sight = this.sight();
    return [this.width,
      Math.max(this.height, (sight ? sight.rows.length : 0) * LEAST + 54)];
  }
}

const concerns = ([, , agent, kind, other], chosen) =>
  agent === chosen || (other === chosen && (kind === 'sent' || kind === 'received'));

export function arrowHead(pen, x1, y1, x2, y2, size) {
  const length = Math.hypot(x2 - x1, y2 - y1) || 1;
  const ux = (x2 - x1) / length, uy = (y2 - y1) / length;
  pen.moveTo(x2, y2);
  pen.lineTo(x2 - size * ux - size * 0.5 * uy, y2 - size * uy + size * 0.5 * ux);
  pen.lineTo(x2 - size * ux + size * 0.5 * uy, y2 - size * uy - size * 0.5 * ux);
  pen.closePath();
}
