// Fingers, mouse and wheel on a canvas: pan, zoom, and what is dragged.

const SLOP = 4;                 // pixels that a click may tremble

// on: {grab(x, y) -> what is there or null, click(x, y, what, event),
//      drag(what, x, y), drop(what, x, y), pan(dx, dy), zoom(factor, x, y),
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
