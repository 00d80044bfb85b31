// The view Sequence: messages between chosen agents, from top to bottom in the
// order of time.

import { button, calmly, element, fitCanvas, onSize } from './dom.js';
import { cut } from './mapscene.js';
import { onTheme, Palette, paperPalette } from './palette.js';
import { line, Picture, saveButtons, textWidth, write } from './svg.js';
import { byName, shortName, timeText } from './names.js';
import { arrowHead } from './spacetime.js';
import { story } from './story.js';

const CALM = 300;
const ROW = 24;
const ROWS = 400;               // the latest ones are shown
const AGENTS = 8;               // those with the most messages, by default
const HEAD = 34;
const LEFT = 74;

export const mount = (parent, store, app) => new Sequence(parent, store, app);

class Sequence extends Picture {
  constructor(parent, store, app) {
    super(store, app);
    this.chosen = [];           // agents; [] for those with most messages
    this.moves = true;
    this.build(parent);
    this.palette = new Palette(store, this.element);
    const later = calmly(CALM, () => this.draw());
    this.ends = [
      store.on('change', later), later.stop,
      onTheme(() => { this.palette.refresh(); this.draw(); }),
      onSize(this.stage, width => { this.width = width; this.draw(); }),
    ];
  }

  build(parent) {
    this.canvas = element('canvas', { role: 'img',
      'aria-label': 'Messages between agents, in the order of time' });
    this.empty = element('div', { class: 'view-empty' }, 'No messages yet');
    this.stage = element('div', { class: 'view-stage view-scroll', tabindex: 0,
      'aria-label': 'Sequence chart' }, this.canvas, this.empty);
    this.names = element('datalist', { id: `agents-${Math.random().toString(36).slice(2)}` });
    this.input = element('input', { type: 'text', list: this.names.id,
      placeholder: 'Add an agent', 'aria-label': 'Add an agent',
      onchange: () => this.add(this.input.value),
      onfocus: () => this.offer() });
    this.chips = element('span', {});
    const moves = element('input', { type: 'checkbox', checked: true,
      onchange: () => { this.moves = moves.checked; this.draw(); } });
    this.element = element('section', { class: 'view view-sequence',
      'aria-label': 'Sequence' },
      element('div', { class: 'view-bar' }, this.input, this.names,
        button('Add the chosen one', () => this.add(this.app.chosen?.agent || '')),
        this.chips, element('label', {}, moves, 'moves'),
        element('span', { class: 'view-gap' }),
        ...saveButtons('sequence', this)),
      this.stage);
    parent.append(this.element);
  }

  offer() {
    const names = [...this.store.agents.keys()].sort(byName).slice(0, 500);
    this.names.replaceChildren(...names.map(id =>
      element('option', { value: id }, shortName(id))));
  }

  // text is an id, or the beginning of one.
  add(text) {
    const wanted = text.trim();
    this.input.value = '';
    const id = this.store.agents.has(wanted) || wanted === 'user' ? wanted
      : [...this.store.agents.keys()].find(known => wanted && known.startsWith(wanted));
    if (!id || this.chosen.includes(id)) return;
    this.choose([...this.chosen, id]);
  }

  choose(agents) {
    this.chosen = agents;
    this.chips.replaceChildren(...agents.map(id =>
      button(`${cut(shortName(id), 20)} ×`,
        () => this.choose(this.chosen.filter(other => other !== id)),
        { 'aria-label': `Without ${shortName(id)}` })));
    this.draw();
  }

  // --------------------------------------------------------------- chart

  // {agents, rows}: a row is a message that is sent or taken, or a hop.
  chart() {
    const history = story(this.store.remembered(), this.store.time);
    const agents = this.chosen.length ? this.chosen : talkers(history.letters);
    const column = new Map(agents.map((id, i) => [id, i]));
    const rows = [];
    for (const letter of history.letters) {
      if (!column.has(letter.sender) || !column.has(letter.receiver)) continue;
      if (letter.from !== null) rows.push({ time: letter.from, order: 0, letter });
      if (letter.to !== null) rows.push({ time: letter.to, order: 1, taken: letter });
    }
    if (this.moves)
      for (const hop of history.hops)
        if (column.has(hop.agent)) rows.push({ time: hop.to, order: 2, hop });
    rows.sort((a, b) => a.time - b.time || a.order - b.order);
    return { agents, column, rows: joined(telling(rows)).slice(-ROWS) };
  }

  draw() {
    if (!this.stage.clientWidth || !this.palette) return;
    const chart = this.chart(), height = this.heightOf(chart);
    const follow = this.stage.scrollTop + this.stage.clientHeight
      >= this.stage.scrollHeight - 4;
    this.empty.hidden = chart.agents.length > 0;
    const wide = this.wide(chart);
    this.canvas.style.width = `${wide}px`;
    this.canvas.style.height = `${height}px`;
    this.picture(fitCanvas(this.canvas, wide, height), this.palette, chart, wide, height);
    if (follow && !this.store.stamped) this.stage.scrollTop = this.stage.scrollHeight;
  }

  heightOf({ rows }) { return HEAD + rows.length * ROW + 16; }

  wide({ agents }) { return Math.max(this.width - 16, LEFT + agents.length * 110); }

  picture(pen, palette, { agents, column, rows }, width, height) {
    pen.fillStyle = palette.bg;
    pen.fillRect(0, 0, width, height);
    const each = (width - LEFT) / Math.max(1, agents.length);
    const x = agent => LEFT + each * (column.get(agent) + 0.5);
    const y = i => HEAD + (i + 0.6) * ROW;
    this.lifelines(pen, palette, agents, x, height);
    const rowOf = new Map();
    rows.forEach((row, i) => {
      if (row.letter) rowOf.set(row.letter, i);
      this.time(pen, palette, row.time, y(i));
    });
    rows.forEach((row, i) => {
      if (row.hop) this.hop(pen, palette, row.hop, x(row.hop.agent), y(i));
      else if (row.taken)
        this.letter(pen, palette, row.taken, x, y(rowOf.get(row.taken) ?? i), y(i));
      else if (row.letter.to === null)
        this.letter(pen, palette, row.letter, x, y(i), null);
      else if (row.both) this.letter(pen, palette, row.letter, x, y(i), y(i));
    });
  }

  lifelines(pen, palette, agents, x, height) {
    for (const agent of agents) {
      const program = this.store.agents.get(agent)?.program || agent;
      const room = Math.max(6, Math.floor((x(agents[1] ?? agent) - x(agents[0])) / 8));
      pen.strokeStyle = palette.faint;
      pen.lineWidth = 1.5;
      line(pen, x(agent), HEAD - 4, x(agent), height - 6);
      pen.fillStyle = palette.of(program);
      pen.fillRect(x(agent) - 16, HEAD - 8, 32, 4);
      write(pen, cut(shortName(agent), agents.length > 1 ? room : 30), x(agent),
        14, { size: '600 12px', fill: palette.text, align: 'center' });
    }
  }

  time(pen, palette, time, y) {
    write(pen, timeText(time, 1), 4, y, { size: '10px', fill: palette.muted });
  }

  letter(pen, palette, { sender, receiver, text }, x, from, to) {
    const lost = to === null, own = sender === receiver;
    const x1 = x(sender), x2 = own ? x1 + 30 : x(receiver), y2 = to ?? from;
    pen.strokeStyle = pen.fillStyle
      = palette.of(this.store.agents.get(sender)?.program || sender);
    pen.lineWidth = 1.5;
    pen.setLineDash(lost ? [4, 3] : []);
    line(pen, x1, from, x2, y2);
    pen.setLineDash([]);
    pen.beginPath();
    arrowHead(pen, x1, from, x2, y2, 8);
    pen.fill();
    if (!text) return;
    const room = Math.max(8, Math.abs(x2 - x1) / 6.5);
    write(pen, cut(text, Math.floor(room)), (x1 + x2) / 2, (from + y2) / 2 - 3,
      { size: '11px', fill: palette.text, align: 'center', baseline: 'bottom' });
  }

  hop(pen, palette, { b }, x, y) {
    const text = `→ ${cut(shortName(b), 14)}`;
    const wide = textWidth(pen, text, '11px') + 10;
    pen.fillStyle = palette.surface;
    pen.fillRect(x - wide / 2, y - 8, wide, 16);
    pen.strokeStyle = palette.line;
    pen.lineWidth = 1;
    pen.strokeRect(x - wide / 2, y - 8, wide, 16);
    write(pen, text, x, y, { size: '11px', fill: palette.text, align: 'center' });
  }

  size() {
    const chart = this.chart();
    return [this.wide(chart), this.heightOf(chart)];
  }

  drawAll(pen, width, height) {
    this.picture(pen, paperPalette(this.store, this.element), this.chart(),
      width, height);
  }
}

// Keep only moves after which the agent sends or takes a message: they show the
// host on which it does so.
function telling(rows) {
  const kept = [], last = new Map();    // agent -> row of its last move
  const flush = agent => {
    if (last.has(agent)) kept.push(last.get(agent));
    last.delete(agent);
  };
  for (const row of rows) {
    if (row.hop) {
      last.set(row.hop.agent, row);
      continue;
    }
    flush(row.letter ? row.letter.sender : row.taken.receiver);
    kept.push(row);
  }
  return kept.sort((a, b) => a.time - b.time || a.order - b.order);
}

// A message that is taken without other events in between needs only one row.
function joined(rows) {
  const kept = [];
  for (const row of rows) {
    const before = kept[kept.length - 1];
    if (row.taken && before?.letter === row.taken) before.both = true;
    else kept.push(row);
  }
  return kept;
}

function talkers(letters) {
  const counts = new Map();
  for (const { sender, receiver } of letters)
    for (const agent of [sender, receiver])
      if (agent) counts.set(agent, (counts.get(agent) || 0) + 1);
  return [...counts].sort((a, b) => b[1] - a[1]).slice(0, AGENTS)
    .map(([agent]) => agent).sort(byName);
}
