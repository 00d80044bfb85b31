// A pen that draws SVG in place of a canvas, with the part of
// CanvasRenderingContext2D that the views and uPlot use; text is kept as text.
// Also functions for either pen, and for saving views.

import { button } from './dom.js';

const number = n => String(Math.round(n * 100) / 100);
const escaped = text => String(text).replace(/[&<>"']/g,
  c => `&#${c.charCodeAt(0)};`)
  .replace(/[\u0000-\u0008\u000b\u000c\u000e-\u001f\ufffe\uffff]/g, '\ufffd');

// The commands of a path, for the pen and for Path2D.
export class SvgPath {
  constructor() { this.d = []; }

  moveTo(x, y) { this.d.push(`M${number(x)} ${number(y)}`); }
  lineTo(x, y) {
    this.d.push(`${this.d.length ? 'L' : 'M'}${number(x)} ${number(y)}`);
  }
  quadraticCurveTo(a, b, x, y) {
    this.d.push(`Q${[a, b, x, y].map(number).join(' ')}`);
  }
  bezierCurveTo(a, b, c, d, x, y) {
    this.d.push(`C${[a, b, c, d, x, y].map(number).join(' ')}`);
  }
  rect(x, y, w, h) {
    this.d.push(`M${number(x)} ${number(y)}h${number(w)}v${number(h)}h${number(-w)}z`);
  }
  arc(x, y, r, from, to) {
    const whole = Math.abs(to - from) >= 2 * Math.PI - 1e-6;
    const end = whole ? from + Math.PI : to;
    const at = angle => `${number(x + r * Math.cos(angle))} ${
      number(y + r * Math.sin(angle))}`;
    const large = !whole && to - from > Math.PI ? 1 : 0;
    this.d.push(`${this.d.length ? 'L' : 'M'}${at(from)}`);
    this.d.push(`A${number(r)} ${number(r)} 0 ${large} 1 ${at(end)}`);
    if (whole) this.d.push(`A${number(r)} ${number(r)} 0 0 1 ${at(from)}z`);
  }
  closePath() { this.d.push('z'); }
  addPath(path) { this.d.push(...path.d); }
}

const PENS = { fillStyle: '#000', strokeStyle: '#000', lineWidth: 1,
  globalAlpha: 1, font: '10px sans-serif', textAlign: 'start',
  textBaseline: 'alphabetic', lineCap: 'butt', lineJoin: 'miter', dash: [],
  matrix: [1, 0, 0, 1, 0, 0], clipped: '' };

const ANCHORS = { center: 'middle', right: 'end', end: 'end' };
const BASELINES = { middle: 'central', top: 'hanging', hanging: 'hanging',
  bottom: 'text-after-edge' };

export class SvgPen extends SvgPath {
  constructor(width, height) {
    super();
    Object.assign(this, structuredClone(PENS), { width, height });
    this.elements = [];
    this.saved = [];
    this.clips = 0;
    // OffscreenCanvas measures text in the fonts of the document
    this.ruler = new OffscreenCanvas(1, 1).getContext('2d');
  }

  save() {
    this.saved.push(Object.fromEntries(Object.keys(PENS).map(k => [k, this[k]])));
  }
  restore() { Object.assign(this, this.saved.pop()); }
  transform(a, b, c, d, e, f) {
    const [A, B, C, D, E, F] = this.matrix;
    this.matrix = [A * a + C * b, B * a + D * b, A * c + C * d, B * c + D * d,
                   A * e + C * f + E, B * e + D * f + F];
  }
  translate(x, y) { this.transform(1, 0, 0, 1, x, y); }
  scale(x, y) { this.transform(x, 0, 0, y, 0, 0); }
  rotate(a) {
    this.transform(Math.cos(a), Math.sin(a), -Math.sin(a), Math.cos(a), 0, 0);
  }
  setTransform(...m) { this.matrix = m; }
  setLineDash(dash) { this.dash = dash; }
  beginPath() { this.d = []; }
  clearRect() {}
  measureText(text) {
    this.ruler.font = this.font;
    return this.ruler.measureText(text);
  }

  clip(path = this) {
    const id = `clip${++this.clips}`;
    this.elements.push(`<clipPath id="${id}"><path d="${
      path.d.join('')}"${this.placed()}/></clipPath>`);
    this.clipped = ` clip-path="url(#${id})"`;
  }

  placed() {
    const [a, b, c, d, e, f] = this.matrix;
    return a === 1 && b === 0 && c === 0 && d === 1 && e === 0 && f === 0 ? ''
      : ` transform="matrix(${this.matrix.map(n =>
          String(Math.round(n * 1e4) / 1e4)).join(' ')})"`;
  }

  put(tag, attributes, paint, text) {
    const alpha = this.globalAlpha < 1 ? ` opacity="${number(this.globalAlpha)}"` : '';
    const body = text === undefined ? '/>' : `>${escaped(text)}</${tag}>`;
    // a clip is in the coordinates of the picture, not of the element
    const element = `<${tag} ${attributes} ${paint}${alpha}${this.placed()}${body}`;
    this.elements.push(this.clipped ? `<g${this.clipped}>${element}</g>` : element);
  }

  inked() {
    const dash = this.dash.length ? ` stroke-dasharray="${this.dash.join(' ')}"` : '';
    const cap = this.lineCap === 'butt' ? '' : ` stroke-linecap="${this.lineCap}"`;
    const join = this.lineJoin === 'miter' ? '' : ` stroke-linejoin="${this.lineJoin}"`;
    return `fill="none" stroke="${escaped(this.strokeStyle)}" stroke-width="${
      number(this.lineWidth)}"${dash}${cap}${join}`;
  }

  filled() { return `fill="${escaped(this.fillStyle)}"`; }

  fill(path = this) { this.path(path, this.filled()); }
  stroke(path = this) { this.path(path, this.inked()); }
  path(path, paint) {
    if (path.d && path.d.length) this.put('path', `d="${path.d.join('')}"`, paint);
  }
  box(x, y, w, h) {
    return `x="${number(x)}" y="${number(y)}" width="${number(w)}" height="${number(h)}"`;
  }
  fillRect(...box) { this.put('rect', this.box(...box), this.filled()); }
  strokeRect(...box) { this.put('rect', this.box(...box), this.inked()); }

  fillText(text, x, y) { this.text(text, x, y, this.filled()); }
  strokeText(text, x, y) { this.text(text, x, y, this.inked()); }

  text(text, x, y, paint) {
    const baseline = BASELINES[this.textBaseline];
    this.put('text', `x="${number(x)}" y="${number(y)}" text-anchor="${
      ANCHORS[this.textAlign] || 'start'}"${
      baseline ? ` dominant-baseline="${baseline}"` : ''} style="font:${
      escaped(this.font)}"`, paint, text);
  }

  toString() {
    return `<svg xmlns="http://www.w3.org/2000/svg" width="${number(this.width)
      }" height="${number(this.height)}" viewBox="0 0 ${number(this.width)} ${
      number(this.height)}">\n${this.elements.join('\n')}\n</svg>\n`;
  }
}

// Text and lines, with either pen.

const FONT = 'system-ui, sans-serif';

// size: such as '600 12px'; halo: the colour of the background of the text.
export function write(pen, text, x, y, { size, fill, align = 'left',
                                         baseline = 'middle', halo = null }) {
  pen.font = `${size} ${FONT}`;
  pen.textAlign = align;
  pen.textBaseline = baseline;
  if (halo) {
    pen.strokeStyle = halo;
    pen.lineWidth = 3;
    pen.strokeText(text, x, y);
  }
  pen.fillStyle = fill;
  pen.fillText(text, x, y);
}

export function textWidth(pen, text, size) {
  pen.font = `${size} ${FONT}`;
  return pen.measureText(text).width;
}

export function line(pen, x1, y1, x2, y2) {
  pen.beginPath();
  pen.moveTo(x1, y1);
  pen.lineTo(x2, y2);
  pen.stroke();
}

// Views as files: SVG as the view draws it, and PNG at twice the resolution.

// A view has `ends`, functions that end it, and its `element`; size() is
// [width, height] of the picture that drawAll(pen, width, height) draws for
// print.
export class Picture {
  constructor(store, app) { Object.assign(this, { store, app }); }

  destroy() {
    this.ends.forEach(end => end());
    this.element.remove();
  }

  async toSVG() {
    const size = this.size(), pen = new SvgPen(...size);
    await this.drawAll(pen, ...size);
    return pen.toString();
  }

  toPNG() {
    const size = this.size();
    return pngBlob(...size, pen => this.drawAll(pen, ...size));
  }
}

export function download(name, blob) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

export const svgBlob = text => new Blob([text], { type: 'image/svg+xml' });

// draw(pen) draws the picture of toSVG on a canvas.
export async function pngBlob(width, height, draw, scale = 2) {
  const canvas = document.createElement('canvas');
  canvas.width = Math.round(width * scale);
  canvas.height = Math.round(height * scale);
  const pen = canvas.getContext('2d');
  pen.scale(scale, scale);
  draw(pen);
  return new Promise(resolve => canvas.toBlob(resolve, 'image/png'));
}

// Two buttons, for a view with toSVG and toPNG.
export const saveButtons = (name, view) => [
  button('SVG', async () => download(`${name}.svg`, svgBlob(await view.toSVG())),
    { title: 'Save this view as SVG', 'aria-label': `Save ${name} as SVG` }),
  button('PNG', async () => download(`${name}.png`, await view.toPNG()),
    { title: 'Save this view as PNG', 'aria-label': `Save ${name} as PNG` }),
];
