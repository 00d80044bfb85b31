// Elements, made without HTML: whatever is said goes in as text.

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

// The children of an element are these, in this order.  Those that stay are
// not taken out meanwhile, as far as their order allows.
export function inOrder(parent, children) {
  const wanted = new Set(children);
  for (const child of [...parent.children]) if (!wanted.has(child)) child.remove();
  children.forEach((child, i) => {
    const there = parent.children[i];
    if (there !== child) parent.insertBefore(child, there || null);
  });
}

// The same, but what is as before, in the same order, stays the same element:
// it may have the focus, or be a part of what somebody selects.
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

// Call f with the size of an element now, and whenever it changes; not while
// it is not shown.
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

// Pixels of the canvas are those of the screen.
export function fitCanvas(canvas, width, height) {
  const ratio = globalThis.devicePixelRatio || 1;
  canvas.width = Math.max(1, Math.round(width * ratio));
  canvas.height = Math.max(1, Math.round(height * ratio));
  const pen = canvas.getContext('2d');
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  return pen;
}

// f is called some time after it is asked for: the longer it takes, the later.
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

// What changes waits while somebody presses: what he presses on would be gone,
// or elsewhere, when he lets go, and that is no click.
let waiting = null;             // functions, while somebody presses

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
addEventListener('pointermove', event => {      // he has let go elsewhere
  if (waiting && event.buttons === 0) letGo();
}, true);
