// Colours of programs, which colour-blind readers can distinguish (after Okabe
// and Ito, made darker or lighter for contrast), each also with a shape; and
// colours of the theme, which views.css defines.

import { element, fitCanvas, inOrder } from './dom.js';
import { byName } from './names.js';
import { textWidth, write } from './svg.js';

const LIGHT = ['#0072b2', '#d55e00', '#00835f', '#b8418c', '#8a6d00',
               '#2a8fc4', '#5b4bb0', '#59636e'];
const DARK = ['#56b4e9', '#f08a3c', '#2fc79a', '#e58fc0', '#f0d24c',
              '#9fd0f5', '#aa9bf0', '#b3bcc5'];

const THEME = ['bg', 'surface', 'text', 'muted', 'line', 'faint', 'accent',
               'bad'];

export const SHAPES = ['circle', 'square', 'diamond'];

// A program keeps its first colour.
const numbers = new WeakMap();

function numberOf(store, program) {
  if (!numbers.has(store)) numbers.set(store, new Map());
  const known = numbers.get(store);
  if (!known.has(program)) known.set(program, known.size);
  return known.get(program);
}

export class Palette {
  constructor(store, element) {
    this.store = store;
    this.element = element;
    this.refresh();
  }

  // Read the present colours of the style sheet.
  refresh() {
    const style = getComputedStyle(this.element);
    for (const name of THEME)
      this[name] = style.getPropertyValue(`--view-${name}`).trim() || '#888';
    this.dark = style.getPropertyValue('--view-dark').trim() === '1';
  }

  of(program) { return this.nth(numberOf(this.store, program)); }

  nth(n) {
    const colours = this.dark ? DARK : LIGHT;
    return colours[n % colours.length];
  }

  shape(program) {
    const n = Math.floor(numberOf(this.store, program) / LIGHT.length);
    return SHAPES[n % SHAPES.length];
  }
}

// The colours for paper, which do not depend on the theme.
export function paperPalette(store, element) {
  const palette = new Palette(store, element);
  Object.assign(palette, { bg: '#ffffff', surface: '#ffffff', text: '#1c2128',
    muted: '#57606a', line: '#8c959f', faint: '#d0d7de', accent: '#0550ae',
    bad: '#b3261e', dark: false });
  return palette;
}

// Call back when the theme changes; returns a function that ends this.
export function onTheme(listener) {
  const query = matchMedia('(prefers-color-scheme: dark)');
  const observer = new MutationObserver(listener);
  query.addEventListener('change', listener);
  observer.observe(document.documentElement,
    { attributes: true, attributeFilter: ['data-theme', 'class'] });
  return () => {
    query.removeEventListener('change', listener);
    observer.disconnect();
  };
}

// Make the path of the mark of an agent, to be filled.
export function markPath(pen, shape, x, y, r) {
  if (shape === 'square') {
    pen.rect(x - r * 0.9, y - r * 0.9, r * 1.8, r * 1.8);
  } else if (shape === 'diamond') {
    pen.moveTo(x, y - r * 1.25);
    pen.lineTo(x + r * 1.25, y);
    pen.lineTo(x, y + r * 1.25);
    pen.lineTo(x - r * 1.25, y);
    pen.closePath();
  } else {
    pen.moveTo(x + r, y);
    pen.arc(x, y, r, 0, 2 * Math.PI);
  }
}

// The legend of programs and colours. A click hides or shows the agents of a
// program.

const MANY = 24;

export function legend(store, palette, onHidden) {
  const list = element('div', { class: 'view-legend', role: 'group',
    'aria-label': 'Programs' });
  const entries = new Map();    // program -> {button, count, swatch}
  const hidden = new Set();
  let dark = null;

  const toggle = program => {
    if (!hidden.delete(program)) hidden.add(program);
    entries.get(program).button.setAttribute('aria-pressed',
      String(!hidden.has(program)));
    onHidden(hidden);
  };

  const entry = program => {
    const swatch = element('canvas', { 'aria-hidden': 'true' });
    const count = element('span', {});
    const made = element('button', { type: 'button', 'aria-pressed':
      String(!hidden.has(program)), onclick: () => toggle(program) },
      swatch, program, count);
    return { button: made, count, swatch };
  };

  const paint = (program, swatch) => {
    const pen = fitCanvas(swatch, 14, 14);
    pen.fillStyle = palette().of(program);
    pen.beginPath();
    markPath(pen, palette().shape(program), 7, 7, 5.5);
    pen.fill();
  };

  const names = () => [...store.populations().keys()].sort(byName).slice(0, MANY);

  return {
    element: list,

    update() {
      const now = names(), populated = store.populations();
      const anew = now.length !== entries.size
        || now.some(name => !entries.has(name)) || dark !== palette().dark;
      if (anew) {
        dark = palette().dark;
        const before = new Map(entries);
        entries.clear();
        for (const name of now) entries.set(name, before.get(name) || entry(name));
        inOrder(list, [...entries.values()].map(e => e.button));
        for (const [name, { swatch }] of entries) paint(name, swatch);
      }
      for (const [name, { count }] of entries) {
        const text = String(populated.get(name));
        if (count.textContent !== text) count.textContent = text;
      }
    },

    // Draw the legend on a saved picture, from left to right.
    draw(pen, colours, x, y) {
      const size = '11px';
      for (const name of names()) {
        if (hidden.has(name)) continue;
        pen.fillStyle = colours.of(name);
        pen.beginPath();
        markPath(pen, colours.shape(name), x + 5, y, 5);
        pen.fill();
        write(pen, name, x + 14, y + 0.5, { size, fill: colours.text });
        x += textWidth(pen, name, size) + 30;
      }
    },
  };
}
