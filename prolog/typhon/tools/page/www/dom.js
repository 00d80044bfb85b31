// Creates elements without HTML, so that all content is text; handles pointers
// on a canvas.

import { shortName } from './names.js';

export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === null || value === undefined) continue;
    if (name.startsWith('on')) made.addEventListener(name.slice(2), value);
    else made.setAttribute(name, value === true ? '' : String(value));
  }
  made.append(...children.filter(child => child !== null));
  return made;
}

export const button = (label, onclick, attributes = {}) =>
  element('button', { type: 'button', onclick, ...attributes }, label);

// A button that selects {agent} or {host}.
export function chooser(app, chosen) {
  const [id] = Object.values(chosen);
  return button(shortName(id), () => app.select(chosen),
    { class: 'link', title: id });
}

export function choice(label, options, value, onchange) {
  const select = element('select', { 'aria-label': label, onchange:
    () => onchange(select.value) });
  fillChoice(select, options, value);
  return select;
}

// Options are values, or [value, text].
export function fillChoice(select, options, value) {
  select.replaceChildren(...options.map(option => {
    const [known, text] = Array.isArray(option) ? option : [option, option];
    return element('option', { value: known }, text);
  }));
  select.value = value;
}

// Make these the children of an element, in this order. Children that stay are
// not removed in between, if their order allows it.
export function inOrder(parent, children) {
  const wanted = new Set(children);
  for (const child of [...parent.children]) if (!wanted.has(child)) child.remove();
  children.forEach((child, i) => {
    const there = parent.children[i];
    if (there !== child) parent.insertBefore(child, there || null);
  });
}

// As inOrder, but an unchanged child in the same order stays the same element:
// it may have the focus, or be part of a selection.
export function renew(parent, children) {
  const before = [...parent.children], html = before.map(child => child.outerHTML);
  let next = 0;
  inOrder(parent, children.map(child => {
    const same = html.indexOf(child.outerHTML, next);
    if (same < 0) return child;
    next = same + 1;
    return before[same];
  }));
}

// Call f with the size of an element now, and whenever it changes, except while
// the element is hidden.
export function onSize(watched, f) {
  const tell = () => {
    if (watched.clientWidth && watched.clientHeight)
      f(watched.clientWidth, watched.clientHeight);
  };
  const observer = new ResizeObserver(tell);
  observer.observe(watched);
  tell();
  return () => observer.disconnect();
}

// Give the canvas the resolution of the screen.
export function fitCanvas(canvas, width, height) {
  const ratio = globalThis.devicePixelRatio || 1;
  canvas.width = Math.max(1, Math.round(width * ratio));
  canvas.height = Math.max(1, Math.round(height * ratio));
  const pen = canvas.getContext('2d');
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  return pen;
}

// Returns a function that calls f after a pause, which grows with the time that
// f takes; calls during the pause have no further effect.
export function calmly(rest, f) {
  let waiting = 0, took = 0;
  const later = () => {
    if (waiting) return;
    waiting = setTimeout(() => {
      waiting = 0;
      const start = performance.now();
      f();
      took = performance.now() - start;
    }, Math.max(rest, 4 * took));
  };
  later.stop = () => clearTimeout(waiting);
  return later;
}

// Changes of the document wait while a mouse button is pressed: an element that
// is removed or moved before the button is released gets no click.
let waiting = null;             // functions, while a button is pressed

export function unpressed(f) {
  if (waiting) waiting.add(f);
  else f();
}

function letGo() {
  const all = waiting || [];
  waiting = null;
  setTimeout(() => { for (const f of all) f(); });      // after the click
}

addEventListener('pointerdown', event => {
  if (event.button === 0) waiting ||= new Set();
}, true);
addEventListener('pointerup', letGo, true);
addEventListener('pointercancel', letGo, true);
addEventListener('pointermove', event => {      // released outside the window
  if (waiting && event.buttons === 0) letGo();
}, true);

// Touch, mouse and wheel on a canvas: pan, zoom, and drag of items.

const SLOP = 4;                 // pixels that a click may move

// on: {grab(x, y) -> the item there or null, click(x, y, item, event),
//      drag(item, x, y), drop(item, x, y), pan(dx, dy), zoom(factor, x, y),
//      hover(x, y)}
export function pointers(canvas, on) {
  const down = new Map();       // id -> {x, y}
  let gesture = null;           // {what, x, y, moved}

  const place = event => {
    const box = canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };

  canvas.addEventListener('pointerdown', event => {
    if (event.button !== 0) return;
    const at = place(event);
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, at);
    gesture = down.size === 1
      ? { what: on.grab(at.x, at.y), ...at, moved: false } : null;
  });

  canvas.addEventListener('pointermove', event => {
    const at = place(event), before = down.get(event.pointerId);
    if (!before) {
      on.hover(at.x, at.y);
      return;
    }
    if (down.size === 2) pinch(event.pointerId, at);
    else if (gesture) dragged(at, before);
    down.set(event.pointerId, at);
  });

  const dragged = (at, before) => {
    if (!gesture.moved && Math.hypot(at.x - gesture.x, at.y - gesture.y) < SLOP)
      return;
    gesture.moved = true;
    canvas.classList.add('dragging');
    if (gesture.what) on.drag(gesture.what, at.x, at.y);
    else on.pan(at.x - before.x, at.y - before.y);
  };

  const pinch = (id, at) => {
    const before = down.get(id);
    const [, other] = [...down].find(([key]) => key !== id);
    const factor = Math.hypot(at.x - other.x, at.y - other.y)
      / Math.max(1, Math.hypot(before.x - other.x, before.y - other.y));
    on.zoom(factor, (at.x + other.x) / 2, (at.y + other.y) / 2);
  };

  const up = event => {
    if (!down.delete(event.pointerId)) return;
    canvas.classList.remove('dragging');
    const ended = gesture, at = place(event);
    gesture = null;
    if (!ended) return;
    if (event.type === 'pointercancel') on.drop(null, at.x, at.y);
    else if (!ended.moved) on.click(at.x, at.y, ended.what, event);
    else if (ended.what) on.drop(ended.what, at.x, at.y);
  };
  canvas.addEventListener('pointerup', up);
  canvas.addEventListener('pointercancel', up);

  canvas.addEventListener('wheel', event => {
    event.preventDefault();
    const { x, y } = place(event);
    const lines = event.deltaMode === 1 ? 16 : 1;
    on.zoom(Math.exp(-event.deltaY * lines / 500), x, y);
  }, { passive: false });
}
