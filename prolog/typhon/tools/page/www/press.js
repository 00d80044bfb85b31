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
