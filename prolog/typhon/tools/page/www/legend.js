// Which colour is which program. A press hides its agents, and shows them.

import { element, fitCanvas, inOrder } from './dom.js';
import { markPath } from './palette.js';
import { byName } from './names.js';

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

    // The same on a picture that is saved, from left to right.
    draw(pen, colours, x, y) {
      pen.font = '11px system-ui, sans-serif';
      pen.textAlign = 'left';
      pen.textBaseline = 'middle';
      for (const name of names()) {
        if (hidden.has(name)) continue;
        pen.fillStyle = colours.of(name);
        pen.beginPath();
        markPath(pen, colours.shape(name), x + 5, y, 5);
        pen.fill();
        pen.fillStyle = colours.text;
        pen.fillText(name, x + 14, y + 0.5);
        x += pen.measureText(name).width + 30;
      }
    },
  };
}
