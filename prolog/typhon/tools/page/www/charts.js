// The view Time: hops and messages per second, agents by program, load, hop
// times. uPlot draws on a canvas, or on a pen that makes SVG.

import { calmly, element } from './dom.js';
import { onTheme, Palette, paperPalette } from './palette.js';
import {
  Picture, pngBlob, saveButtons, SvgPath, SvgPen, textWidth, write,
} from './svg.js';
import { byName, timeText } from './names.js';

const CALM = 500;
const HIGH = 230;
const MANY = 12;                // programs with a line of their own
const NONE = '–';

export const compact = value => (value === null || value === undefined ? NONE
  : Math.abs(value) >= 1e5 ? value.toExponential(1)
  : String(Math.round(value * 100) / 100));

const duration = seconds => (seconds === null || seconds === undefined ? NONE
  : seconds >= 1 ? `${compact(seconds)} s`
  : seconds >= 1e-3 ? `${compact(seconds * 1e3)} ms`
  : `${compact(seconds * 1e6)} µs`);

// The plots. A series is [name, function of a stretch, colour].
const PLOTS = [
  { name: 'rates', title: 'Per second', value: compact,
    series: ({ width }) => [
      ['hops', s => s.hops / width, 0], ['messages', s => s.messages / width, 1],
      ['faults', s => s.faults / width, 'bad']] },
  { name: 'populations', title: 'Agents, by program', value: compact,
    series: ({ programs }) => programs.map(program =>
      [program, s => s.populations?.get(program) ?? 0, { program }]) },
  { name: 'load', title: 'Load of hosts', value: compact,
    series: () => [['most', s => s.load?.most ?? null, 1],
                   ['mean', s => s.load?.mean ?? null, 0]] },
  { name: 'hop-times', title: 'Time of a hop', value: duration, log: true,
    series: () => [['99 %', s => s.percentile(0.99), 1],
                   ['90 %', s => s.percentile(0.9), 2],
                   ['median', s => s.percentile(0.5), 0]] },
];

export const mount = (parent, store, app) => new Charts(parent, store, app);

// A subclass may have other plots, of other data.
export class Charts extends Picture {
  get kinds() { return PLOTS; }

  constructor(parent, store, app) {
    super(store, app);
    this.body = element('div', { class: 'view-plots', tabindex: 0,
      'aria-label': 'Plots' });
    this.element = element('section', { class: 'view view-time',
      'aria-label': 'Time' },
      element('div', { class: 'view-bar' },
        element('span', {}, 'Drag over a plot to zoom, double-click to see all.'),
        element('span', { class: 'view-gap' }), ...saveButtons('time', this)),
      this.body);
    parent.append(this.element);
    if (!globalThis.uPlot) {
      this.body.append(element('p', {}, 'Plots need uPlot: call `make page-tools`.'));
      this.ends = [];
      return;
    }
    this.palette = new Palette(store, this.element);
    this.plots = this.kinds.map(plot => this.add(plot));
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(this.body);
    const later = calmly(store.stamped ? 60 : CALM, () => this.draw());
    this.ends = [store.on('change', later), later.stop,
      onTheme(() => { this.palette.refresh(); this.rebuild(); }),
      () => this.observer.disconnect()];
    this.draw();
  }

  destroy() {
    for (const { drawn } of this.plots || []) drawn?.destroy();
    super.destroy();
  }

  add(plot) {
    const place = element('div', { class: 'view-plot' },
      element('h3', {}, plot.title));
    this.body.append(place);
    return { plot, place, drawn: null, names: '' };
  }

  rebuild() {
    for (const shown of this.plots) {
      shown.drawn?.destroy();
      shown.drawn = null;
    }
    this.draw();
  }

  resize() {
    for (const { drawn, place } of this.plots)
      if (drawn && place.clientWidth && drawn.width !== place.clientWidth)
        drawn.setSize({ width: place.clientWidth, height: HIGH });
    this.draw();
  }

  // ---------------------------------------------------------------- data

  context() {
    const { stretches, width } = this.store.history, programs = new Set();
    for (const { populations } of stretches)
      for (const name of populations?.keys() || []) programs.add(name);
    return { stretches: this.whole(stretches), width,
             programs: [...programs].sort(byName).slice(0, MANY) };
  }

  // The last stretch is incomplete: its counts would be too low.
  whole(stretches) {
    return stretches.length < 3 ? stretches : stretches.slice(0, -1);
  }

  colour(palette, given) {
    if (given === 'bad') return palette.bad;
    return typeof given === 'number' ? palette.nth(given) : palette.of(given.program);
  }

  draw() {
    if (!globalThis.uPlot || !this.body.clientWidth) return;
    const context = this.context();
    if (context.stretches.length === 0) return;
    for (const shown of this.plots) {
      const series = shown.plot.series(context);
      const names = series.map(([name]) => name).join(' ');
      if (shown.drawn && shown.names !== names) {
        shown.drawn.destroy();
        shown.drawn = null;
      }
      const data = rows(context.stretches, series);
      shown.names = names;
      if (shown.drawn) shown.drawn.setData(data, !this.zoomed(shown));
      else shown.drawn = new globalThis.uPlot(
        this.options(shown.plot, series, shown.place.clientWidth, this.palette),
        data, shown.place);
    }
  }

  // Whether the plot shows only a part of the data; new data do not change it
  // then.
  zoomed({ drawn }) {
    const [xs] = drawn.data, { min, max } = drawn.scales.x;
    return min > xs[0] || max < xs[xs.length - 1];
  }

  options(plot, series, width, palette, height = HIGH) {
    const axis = { stroke: palette.muted, font: '11px system-ui, sans-serif',
      grid: { stroke: palette.faint, width: 1 },
      ticks: { stroke: palette.faint, width: 1 } };
    return {
      width, height,
      cursor: { sync: { key: 'typhon' }, drag: { x: true, y: false } },
      scales: { x: { time: false },
                y: plot.log ? { distr: 3 } : { range: { min: { pad: 0, soft: 0, mode: 1 },
                                                       max: { pad: 0.1, soft: 1, mode: 1 } } } },
      axes: [{ ...axis, space: 80, values: (u, ticks) => ticks.map(t =>
                 timeText(t, u.scales.x.max - u.scales.x.min)) },
             { ...axis, size: 58, values: (u, ticks) => ticks.map(t =>
                 (t === null ? '' : plot.value(t))) }],
      series: [{ label: 'time', value: (u, t) => (t === null ? NONE : timeText(t, 100)) },
        ...series.map(([label, , given]) => ({ label, width: 1.5, spanGaps: true,
          stroke: this.colour(palette, given), points: { show: false },
          value: (u, v) => plot.value(v) }))],
    };
  }

  // -------------------------------------------------------------- saving

  size() { return [this.body.clientWidth, this.kinds.length * (HIGH + 44)]; }

  async drawAll(pen, width, height) {
    const palette = paperPalette(this.store, this.element), context = this.context();
    pen.fillStyle = palette.bg;
    pen.fillRect(0, 0, width, height);
    let top = 0;
    for (const plot of this.kinds) {
      const series = plot.series(context);
      pen.save();
      pen.translate(0, top);
      this.caption(pen, palette, plot, series);
      pen.translate(0, 34);
      await this.onPen(pen, this.options(plot, series, width, palette),
                       rows(context.stretches, series));
      pen.restore();
      top += HIGH + 44;
    }
  }

  caption(pen, palette, plot, series) {
    write(pen, plot.title, 10, 12, { size: '600 13px', fill: palette.text });
    const size = '11px';
    let x = 10;
    for (const [name, , given] of series) {
      pen.fillStyle = this.colour(palette, given);
      pen.fillRect(x, 26, 12, 3);
      write(pen, name, x + 16, 28, { size, fill: palette.text });
      x += textWidth(pen, name, size) + 32;
    }
  }

  // uPlot creates a canvas of its own, and its paths. For this one plot the
  // context of each canvas is the pen, and paths are those of the pen.
  async onPen(pen, options, data) {
    const asked = HTMLCanvasElement.prototype.getContext, { Path2D } = globalThis;
    const ratio = globalThis.devicePixelRatio || 1;
    const place = element('div', {});
    let plot = null;
    if (pen instanceof SvgPen) globalThis.Path2D = SvgPath;
    HTMLCanvasElement.prototype.getContext = () => pen;
    pen.scale(1 / ratio, 1 / ratio);
    try {
      plot = new globalThis.uPlot({ ...options, legend: { show: false },
        cursor: { show: false } }, data, place);
      await Promise.resolve();      // uPlot draws in a microtask
      await Promise.resolve();
    } finally {
      HTMLCanvasElement.prototype.getContext = asked;
      globalThis.Path2D = Path2D;
    }
    plot.destroy();
  }

  // The PNG is drawn from SVG, since uPlot would clear the canvas.
  async toPNG() {
    const text = await this.toSVG(), picture = new Image();
    picture.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
    await picture.decode();
    return pngBlob(picture.width, picture.height, pen => pen.drawImage(picture, 0, 0));
  }
}

const rows = (stretches, series) => [stretches.map(stretch => stretch.start),
  ...series.map(([, value]) => stretches.map(value))];
