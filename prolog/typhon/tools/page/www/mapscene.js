// The contents of the map, drawn with any pen: a canvas on the screen, or SVG.

import { markPath } from './palette.js';
import { shortName } from './names.js';
import { textWidth, write } from './svg.js';

const GOLDEN = Math.PI * (3 - Math.sqrt(5));
const DENSE = 2500;             // moving marks, above which links show flows
const PLAIN = 400;              // moving marks, above which they are squares
const CROWD = 3000;             // agents, above which hosts show shares
const NEAR = 1.2;               // units between hosts in one shaded area
const BADGE = 8;                // seconds for which a fault flashes

export class Scene {
  constructor(store, palette, places) {
    this.store = store;
    this.palette = palette;
    this.places = places;
    this.k = 60;                // pixels of a unit
    this.x = 0;
    this.y = 0;
    this.curved = false;        // long links are curved around hosts in between
    this.group = 'process';
    this.overlay = '';
    this.hidden = new Set();    // programs
    this.selected = {};         // {agent, host}
    this.focus = null;          // host that has the focus of the keyboard
    this.found = new Set();     // ids that a search has found
  }

  // ---------------------------------------------------------- positions

  at(id) {
    const place = this.places.get(id);
    return place && { x: place.x * this.k + this.x, y: place.y * this.k + this.y };
  }

  toWorld(x, y) { return { x: (x - this.x) / this.k, y: (y - this.y) / this.k }; }

  radius(host) {
    const load = this.store.loadOf(host);
    return Math.max(2.5, this.k * Math.min(0.42, 0.14 + 0.05 * Math.sqrt(load)));
  }

  // The middle of the curve from a to b, or null if it is straight.
  bend(a, b) {
    if (!this.curved) return null;
    const dx = b.x - a.x, dy = b.y - a.y, length = Math.hypot(dx, dy);
    if (length < 1.6 * this.k) return null;
    const side = dx > 0 || (dx === 0 && dy > 0) ? 0.14 : -0.14;
    return { x: (a.x + b.x) / 2 - dy * side, y: (a.y + b.y) / 2 + dx * side };
  }

  along(a, b, share) {
    const c = this.bend(a, b), rest = 1 - share;
    const x = c ? rest * rest * a.x + 2 * rest * share * c.x + share * share * b.x
      : a.x + (b.x - a.x) * share;
    const y = c ? rest * rest * a.y + 2 * rest * share * c.y + share * share * b.y
      : a.y + (b.y - a.y) * share;
    const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
    const aside = Math.min(4, this.k * 0.07);   // opposite hops do not overlap
    return { x: x - (b.y - a.y) / length * aside,
             y: y + (b.x - a.x) / length * aside };
  }

  // The position of the mark of an agent at the time now.
  agentAt(agent, now) {
    if (agent.hop) {
      const a = this.at(agent.hop.from), b = this.at(agent.hop.to);
      if (a && b) return this.along(a, b, this.store.progress(agent.hop, now));
    }
    const host = this.store.hosts.get(agent.host), at = host && this.at(host.id);
    if (!at) return null;
    let i = 0;
    for (const other of host.agents) {
      if (other === agent) break;
      if (this.atRest(other)) i++;
    }
    const dots = this.dots(host, this.resting(host).length);
    return dots ? this.dotAt(at, dots, i) : at;
  }

  atRest(agent) { return !agent.hop && !this.hidden.has(agent.program); }

  resting(host) {
    const resting = [];
    for (const agent of host.agents) if (this.atRest(agent)) resting.push(agent);
    return resting;
  }

  // {spread, r} of the dots of n agents, or null if they are too small.
  dots(host, n) {
    const room = this.radius(host) - 1.5;
    const spread = Math.min(0.09 * this.k, room / Math.sqrt(n + 0.3));
    const r = Math.min(0.055 * this.k, spread * 0.8, 9);
    const crowded = this.store.agents.size > CROWD && r < 5;
    return r < 1.4 || n > 400 || crowded ? null : { spread, r };
  }

  dotAt({ x, y }, { spread }, i) {
    const distance = i === 0 ? 0 : spread * Math.sqrt(i + 0.5);
    return { x: x + distance * Math.cos(i * GOLDEN),
             y: y + distance * Math.sin(i * GOLDEN) };
  }

  // ------------------------------------------------------ static items

  drawBase(pen, width, height) {
    pen.fillStyle = this.palette.bg;
    pen.fillRect(0, 0, width, height);
    this.frame = { left: -40, top: -40, right: width + 40, bottom: height + 40 };
    if (this.group !== 'none') this.drawGroups(pen);
    this.drawLinks(pen);
    const shown = [];
    for (const host of this.store.hosts.values()) {
      const at = this.at(host.id);
      if (at && this.inFrame(at)) shown.push([host, at, this.radius(host)]);
    }
    this.drawHosts(pen, shown);
    for (const [host, at, r] of shown) this.drawAgents(pen, host, at, r);
    for (const [host, at, r] of shown) this.drawTrouble(pen, host, at, r);
    this.drawOverlay(pen, shown);
    this.drawNames(pen, shown);
  }

  inFrame({ x, y }) {
    const { left, top, right, bottom } = this.frame;
    return x > left && x < right && y > top && y < bottom;
  }

  linePath(pen, a, b) {
    const c = this.bend(a, b);
    pen.moveTo(a.x, a.y);
    if (c) pen.quadraticCurveTo(c.x, c.y, b.x, b.y);
    else pen.lineTo(b.x, b.y);
  }

  // Draw a shaded area below hosts of one process that are near each other.
  drawGroups(pen) {
    const groups = new Map();
    for (const host of this.store.hosts.values()) {
      const key = host[this.group];
      if (!groups.has(key)) groups.set(key, []);
      groups.get(key).push(host);
    }
    if (groups.size < 2) return;
    pen.lineCap = 'round';
    pen.lineWidth = this.k;
    let i = 0;
    const labels = this.k > 50 && groups.size <= 24;
    for (const [name, hosts] of groups) {
      pen.strokeStyle = this.tint(i++);
      pen.beginPath();
      this.ground(pen, hosts);
      pen.stroke();
      if (labels) this.groupName(pen, name, hosts);
    }
    pen.lineCap = 'butt';
  }

  tint(i) {
    const hue = Math.round(i * 137.5 + 210) % 360;
    return this.palette.dark ? `hsl(${hue},22%,17%)` : `hsl(${hue},48%,93%)`;
  }

  // Draw a line of the width of a unit from each host to its near neighbours.
  ground(pen, hosts) {
    const cells = new Map();    // squares of that size -> positions of hosts
    const cell = (x, y) => `${Math.floor(x / NEAR)} ${Math.floor(y / NEAR)}`;
    for (const { id } of hosts) {
      const place = this.places.get(id), a = place && this.at(id);
      if (!place) continue;
      pen.moveTo(a.x, a.y);
      pen.lineTo(a.x + 0.01, a.y);
      for (const dx of [-NEAR, 0, NEAR])
        for (const dy of [-NEAR, 0, NEAR])
          for (const other of cells.get(cell(place.x + dx, place.y + dy)) || []) {
            if (Math.hypot(other.x - place.x, other.y - place.y) > NEAR) continue;
            pen.moveTo(a.x, a.y);
            pen.lineTo(other.at.x, other.at.y);
          }
      const key = cell(place.x, place.y);
      if (!cells.has(key)) cells.set(key, []);
      cells.get(key).push({ ...place, at: a });
    }
  }

  groupName(pen, name, hosts) {
    let top = null;
    for (const host of hosts) {
      const at = this.at(host.id);
      if (at && (!top || at.y < top.y - 1 || (at.y < top.y + 1 && at.x < top.x)))
        top = at;
    }
    if (!top) return;
    write(pen, name, top.x - this.k * 0.4, top.y - this.k * 0.36,
      { size: '600 10px', fill: this.palette.muted, baseline: 'bottom' });
  }

  drawLinks(pen) {
    pen.strokeStyle = this.palette.line;
    pen.lineWidth = this.k > 40 ? 1.5 : this.k > 15 ? 1 : 0.6;
    pen.globalAlpha = this.k > 15 ? 0.9 : 0.5;
    pen.beginPath();
    for (const { a, b } of this.store.links.values()) {
      const from = this.at(a), to = this.at(b);
      if (from && to) this.linePath(pen, from, to);
    }
    pen.stroke();
    pen.globalAlpha = 1;
    if (this.k > 70) this.drawCosts(pen);
  }

  drawCosts(pen) {
    for (const { a, b, cost } of this.store.links.values()) {
      if (cost === 1 || cost === null) continue;
      const from = this.at(a), to = this.at(b);
      if (!from || !to) continue;
      const { x, y } = this.along(from, to, 0.5);
      write(pen, short(cost), x, y, { size: '10px', fill: this.palette.muted,
        align: 'center', baseline: 'bottom' });
    }
  }

  drawHosts(pen, shown) {
    const running = shown.filter(([host]) => host.state === 'running');
    const over = shown.filter(([host]) => host.state !== 'running');
    this.discs(pen, running, this.palette.surface, this.palette.line, []);
    this.discs(pen, over, this.palette.faint, this.palette.muted,
      this.k > 15 ? [3, 3] : []);
  }

  discs(pen, shown, fill, line, dash) {
    if (shown.length === 0) return;
    pen.beginPath();
    for (const [, { x, y }, r] of shown) {
      pen.moveTo(x + r, y);
      pen.arc(x, y, r, 0, 2 * Math.PI);
    }
    pen.fillStyle = fill;
    pen.fill();
    pen.strokeStyle = line;
    pen.lineWidth = this.k > 30 ? 1.5 : 1;
    pen.setLineDash(dash);
    pen.stroke();
    pen.setLineDash([]);
  }

  drawAgents(pen, host, at, r) {
    if (host.state !== 'running') return;
    const agents = this.resting(host);
    if (agents.length === 0) return;
    const dots = this.dots(host, agents.length);
    if (!dots) {
      this.drawShares(pen, agents, at, r);
      return;
    }
    agents.forEach((agent, i) => {
      const { x, y } = this.dotAt(at, dots, i);
      pen.fillStyle = this.palette.of(agent.program);
      pen.beginPath();
      markPath(pen, this.palette.shape(agent.program), x, y, dots.r);
      pen.fill();
      if (agent.status !== 'faulty') return;
      pen.strokeStyle = this.palette.bad;
      pen.lineWidth = Math.max(1.5, dots.r / 3);
      pen.stroke();
    });
  }

  // Too many agents for single dots: the share of each program as a part of a
  // bar.
  drawShares(pen, agents, { x, y }, r) {
    const shares = new Map();
    for (const { program } of agents)
      shares.set(program, (shares.get(program) || 0) + 1);
    const wide = r * 1.3, high = r * 1.1;
    let left = x - wide / 2;
    for (const program of [...shares.keys()].sort()) {
      const part = wide * shares.get(program) / agents.length;
      pen.fillStyle = this.palette.of(program);
      pen.fillRect(left, y - high / 2, part, high);
      left += part;
    }
  }

  drawTrouble(pen, host, { x, y }, r) {
    if (host.state !== 'running') {
      const d = r * 0.5;
      pen.strokeStyle = host.state === 'lost' ? this.palette.bad : this.palette.muted;
      pen.lineWidth = Math.max(1.5, r / 7);
      pen.beginPath();
      pen.moveTo(x - d, y - d);
      pen.lineTo(x + d, y + d);
      pen.moveTo(x + d, y - d);
      pen.lineTo(x - d, y + d);
      pen.stroke();
      return;
    }
    let faulty = 0;
    for (const agent of host.agents) if (agent.status === 'faulty') faulty++;
    const fresh = this.store.clock() - host.faultAt < BADGE;
    if (faulty === 0 && !fresh) return;
    const size = Math.max(4, Math.min(9, this.k * 0.13));
    const bx = x + r * 0.75, by = y - r * 0.75;
    pen.fillStyle = this.palette.bad;
    pen.beginPath();
    pen.moveTo(bx, by - size);
    pen.lineTo(bx + size, by + size * 0.75);
    pen.lineTo(bx - size, by + size * 0.75);
    pen.closePath();
    pen.fill();
    if (size < 6) return;
    write(pen, '!', bx, by + size * 0.12, { fill: this.palette.bg,
      size: `bold ${Math.round(size * 1.2)}px`, align: 'center' });
  }

  drawNames(pen, shown) {
    if (this.k < 36) return;
    const style = { size: this.k > 50 ? '12px' : '10px', align: 'center',
      baseline: 'top', fill: this.palette.text, halo: this.palette.bg };
    pen.lineJoin = 'round';
    for (const [host, { x, y }, r] of shown) {
      const more = host.state === 'running' ? '' : `, ${host.state}`;
      write(pen, cut(host.name, 24) + more, x, y + r + 2, style);
    }
    pen.lineJoin = 'miter';
  }

  // ----------------------------------------------------------- overlays

  drawOverlay(pen, shown) {
    const overlay = this.store.overlays.get(this.overlay);
    if (!overlay) return;
    const numbers = [...overlay.values.values()].filter(v => typeof v === 'number');
    const most = Math.max(1e-12, ...numbers.map(Math.abs));
    for (const [host, at, r] of shown) {
      const value = overlay.values.get(host.id);
      if (value === undefined) continue;
      if (overlay.kind === 'bar' && typeof value === 'number')
        this.drawBar(pen, value, most, at, r);
      else this.drawValue(pen, value, overlay.kind, at, r);
    }
    if (overlay.kind === 'link') this.drawLinkValues(pen, overlay, most);
  }

  drawBar(pen, value, most, { x, y }, r) {
    const high = Math.max(10, 0.7 * this.k), wide = Math.max(3, 0.1 * this.k);
    const part = high * Math.abs(value) / most, left = x + r + 2;
    pen.fillStyle = this.palette.faint;
    pen.fillRect(left, y - high / 2, wide, high);
    pen.fillStyle = value < 0 ? this.palette.bad : this.palette.accent;
    pen.fillRect(left, y + high / 2 - part, wide, part);
    if (this.k < 45) return;
    write(pen, short(value), left + wide + 2, y + high / 2,
      { size: '10px', fill: this.palette.text, baseline: 'bottom' });
  }

  drawValue(pen, value, kind, { x, y }, r) {
    const text = cut(short(value), 18);
    const size = `600 ${this.k > 40 ? 11 : 9}px`;
    const wide = textWidth(pen, text, size) + 6;
    const left = x - wide / 2, top = y - r - 15;
    pen.fillStyle = this.palette.bg;
    pen.fillRect(left, top, wide, 14);
    pen.strokeStyle = kind === 'label' ? this.palette.accent
      : this.palette.of(`overlay ${text}`);
    pen.lineWidth = 1.5;
    pen.strokeRect(left, top, wide, 14);
    write(pen, text, x, top + 7.5,
      { size, fill: this.palette.text, align: 'center' });
  }

  drawLinkValues(pen, overlay, most) {
    pen.strokeStyle = this.palette.accent;
    pen.globalAlpha = 0.6;
    for (const [key, value] of overlay.values) {
      const [a, b] = key.split(' ').map(id => this.at(id));
      if (!a || !b || typeof value !== 'number') continue;
      pen.lineWidth = 1 + 6 * Math.abs(value) / most;
      pen.beginPath();
      this.linePath(pen, a, b);
      pen.stroke();
    }
    pen.globalAlpha = 1;
  }

  // ------------------------------------------------------ moving items

  drawTop(pen, now) {
    this.drawTrail(pen);
    const moving = this.store.settle(now);
    if (moving.size > DENSE) this.drawFlows(pen, moving);
    else this.drawMarks(pen, moving, now);
    this.drawChosen(pen, now);
  }

  drawMarks(pen, moving, now) {
    const byProgram = new Map();
    for (const agent of moving) {
      const { from, to } = agent.hop, a = this.at(from), b = this.at(to);
      if (!a || !b || this.hidden.has(agent.program)) continue;
      const point = this.along(a, b, this.store.progress(agent.hop, now));
      const points = byProgram.get(agent.program);
      if (points) points.push(point);
      else byProgram.set(agent.program, [point]);
    }
    const r = Math.max(1.6, Math.min(8, this.k * 0.085));
    for (const [program, points] of byProgram) {
      pen.fillStyle = this.palette.of(program);
      if (moving.size > PLAIN) this.squares(pen, points, Math.min(r, 2.5));
      else this.marks(pen, this.palette.shape(program), points, r);
    }
  }

  marks(pen, shape, points, r) {
    if (r < 2.6) {
      this.squares(pen, points, r);
      return;
    }
    pen.beginPath();
    for (const { x, y } of points) markPath(pen, shape, x, y, r);
    pen.fill();
    pen.strokeStyle = this.palette.bg;
    pen.lineWidth = 1;
    pen.stroke();
  }

  squares(pen, points, r) {
    for (const { x, y } of points) pen.fillRect(x - r, y - r, 2 * r, 2 * r);
  }

  // Too many marks: the width of a link shows the number of agents on it.
  drawFlows(pen, moving) {
    const flows = new Map();
    for (const { hop, program } of moving) {
      if (this.hidden.has(program)) continue;
      const key = hop.from < hop.to ? `${hop.from} ${hop.to}` : `${hop.to} ${hop.from}`;
      flows.set(key, (flows.get(key) || 0) + 1);
    }
    const levels = new Map();
    for (const [key, n] of flows) {
      const level = Math.round(Math.log2(n) * 2);
      if (!levels.has(level)) levels.set(level, []);
      levels.get(level).push(key);
    }
    pen.strokeStyle = this.palette.accent;
    pen.globalAlpha = 0.75;
    for (const [level, keys] of levels) {
      pen.lineWidth = Math.min(0.3 * this.k, 1 + level * 0.8);
      pen.beginPath();
      for (const key of keys) {
        const [a, b] = key.split(' ').map(id => this.at(id));
        if (a && b) this.linePath(pen, a, b);
      }
      pen.stroke();
    }
    pen.globalAlpha = 1;
  }

  drawTrail(pen) {
    const agent = this.store.agents.get(this.selected.agent);
    if (!agent) return;
    pen.strokeStyle = this.palette.of(agent.program);
    pen.lineWidth = 2.5;
    const trail = agent.trail.slice(-16);
    for (let i = 1; i < trail.length; i++) {
      const a = this.at(trail[i - 1]), b = this.at(trail[i]);
      if (!a || !b) continue;
      pen.globalAlpha = 0.15 + 0.6 * i / trail.length;
      pen.beginPath();
      this.linePath(pen, a, b);
      pen.stroke();
    }
    pen.globalAlpha = 1;
  }

  drawChosen(pen, now) {
    for (const id of this.found) this.ring(pen, id, now, [2, 2], 2);
    if (this.focus) this.ring(pen, this.focus, now, [5, 3], 2);
    if (this.selected.host) this.ring(pen, this.selected.host, now, [], 3);
    const agent = this.store.agents.get(this.selected.agent);
    if (!agent || agent.status === 'ended') return;
    this.ring(pen, agent.id, now, [], 3);
    const at = this.agentAt(agent, now);
    if (!at) return;
    write(pen, cut(agent.name, 30), at.x + 12, at.y - 8, { size: '600 12px',
      baseline: 'bottom', fill: this.palette.text, halo: this.palette.bg });
  }

  ring(pen, id, now, dash, width) {
    const host = this.store.hosts.get(id), agent = this.store.agents.get(id);
    const at = host ? this.at(id) : agent && this.agentAt(agent, now);
    if (!at) return;
    const r = host ? this.radius(host) + 4 : Math.max(7, this.k * 0.09 + 3);
    pen.strokeStyle = this.palette.accent;
    pen.lineWidth = width;
    pen.setLineDash(dash);
    pen.beginPath();
    pen.arc(at.x, at.y, r, 0, 2 * Math.PI);
    pen.stroke();
    pen.setLineDash([]);
  }

  // ------------------------------------------------------ agents on hosts

  hit(x, y, now) {
    let nearest = null, least = 12;
    for (const agent of this.store.moving) {
      const at = agent.hop && this.agentAt(agent, now);
      const distance = at ? Math.hypot(at.x - x, at.y - y) : Infinity;
      if (distance < least) [nearest, least] = [{ agent: agent.id }, distance];
    }
    return nearest || this.hitHost(x, y);
  }

  hitHost(x, y) {
    for (const host of this.store.hosts.values()) {
      const at = this.at(host.id);
      if (!at) continue;
      const r = Math.max(8, this.radius(host));
      if (Math.hypot(at.x - x, at.y - y) > r) continue;
      const agent = host.state === 'running' && this.hitDot(host, at, x, y);
      return agent ? { agent: agent.id, host: host.id } : { host: host.id };
    }
    return null;
  }

  hitDot(host, at, x, y) {
    const agents = this.resting(host), dots = this.dots(host, agents.length);
    if (!dots) return null;
    return agents.find((agent, i) => {
      const dot = this.dotAt(at, dots, i);
      return Math.hypot(dot.x - x, dot.y - y) <= Math.max(3, dots.r + 1);
    });
  }
}

export const cut = (text, length) =>
  (text.length > length ? `${text.slice(0, length - 1)}…` : text);

export const short = value => (typeof value === 'number'
  ? String(Math.round(value * 1000) / 1000) : shortName(String(value)));
