// Colours: of programs, chosen so that people who see few colours tell them
// apart (after Okabe and Ito, made darker or lighter for contrast), each with
// a shape as well; and those of the theme, which views.css defines.

const LIGHT = ['#0072b2', '#d55e00', '#00835f', '#b8418c', '#8a6d00',
               '#2a8fc4', '#5b4bb0', '#59636e'];
const DARK = ['#56b4e9', '#f08a3c', '#2fc79a', '#e58fc0', '#f0d24c',
              '#9fd0f5', '#aa9bf0', '#b3bcc5'];

const THEME = ['bg', 'surface', 'text', 'muted', 'line', 'faint', 'accent',
               'bad'];

export const SHAPES = ['circle', 'square', 'diamond'];

// Programs keep the colour that they got first.
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

  // What the style sheet says now.
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

// As printed on paper, whatever the theme.
export function paperPalette(store, element) {
  const palette = new Palette(store, element);
  Object.assign(palette, { bg: '#ffffff', surface: '#ffffff', text: '#1c2128',
    muted: '#57606a', line: '#8c959f', faint: '#d0d7de', accent: '#0550ae',
    bad: '#b3261e', dark: false });
  return palette;
}

// Call back when the theme changes; returns what ends that.
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

// A mark of an agent, to be filled.
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
