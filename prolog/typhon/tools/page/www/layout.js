// The positions of hosts. The unit is the distance of neighbours.
//
// A grid, ring, star, line or tree is recognized by its links, with the hosts
// numbered in the order of their creation. Any other network gets a force
// layout (d3-force), with the hosts of a process, and the processes of a
// machine, near each other.

import { byName } from './names.js';

const EXPLAINED = 0.85;         // least share of links in the shape
const THERE = 0.4;              // least share of its links that exist

// For each shape the pairs of numbers of linked hosts, and the position of host
// i of n.
const SHAPES = {
  line: {
    edges: n => range(n - 1).map(i => [i, i + 1]),
    at: i => [i, 0],
  },
  ring: {
    edges: n => range(n).map(i => [i, (i + 1) % n]),
    at: (i, n) => round(i, n),
  },
  star: {
    edges: n => range(n - 1).map(i => [0, i + 1]),
    at: (i, n) => (i === 0 ? [0, 0] : round(i - 1, n - 1, 1.6)),
  },
  tree: {
    edges: n => range(n - 1).map(i => [(i + 2 >> 1) - 1, i + 1]),
    at: treeAt,
  },
  grid: {
    edges: (n, columns) => gridEdges(n, columns, false),
    at: (i, n, columns) => [i % columns, Math.floor(i / columns)],
  },
  'star bus': {                 // a chain of hubs, each with its leaves
    edges: starBusEdges,
    at: starBusAt,
  },
  torus: {
    edges: (n, columns) => gridEdges(n, columns, true),
    at: (i, n, columns) => [i % columns, Math.floor(i / columns)],
  },
};

export const LAYOUTS = ['auto', ...Object.keys(SHAPES), 'force', 'random'];

const range = n => Array.from({ length: Math.max(0, n) }, (_, i) => i);

const around = (i, n, radius) => {
  const angle = 2 * Math.PI * i / Math.max(1, n) - Math.PI / 2;
  return [radius * Math.cos(angle), radius * Math.sin(angle)];
};

const round = (i, n, least = 0) =>
  around(i, n, Math.max(least, n / (2 * Math.PI)));

// Each host has twice the width of a host on the next level.
function treeAt(i, n) {
  const level = Math.floor(Math.log2(i + 1));
  const depth = Math.floor(Math.log2(n));
  const room = 2 ** (depth - level);
  return [(i + 1 - 2 ** level + 0.5) * room, level * 1.3];
}

function gridEdges(n, columns, around) {
  const edges = [], rows = Math.ceil(n / columns);
  for (let i = 0; i < n; i++) {
    const column = i % columns, row = Math.floor(i / columns);
    if (column + 1 < columns && i + 1 < n) edges.push([i, i + 1]);
    else if (around && columns > 2) edges.push([i, i - column]);
    if (row + 1 < rows && i + columns < n) edges.push([i, i + columns]);
    else if (around && rows > 2) edges.push([i, column]);
  }
  return edges;
}

function starBusEdges(n, size) {
  return range(n).slice(1).map(i => (i % size === 0 ? [i - size, i]
    : [i - i % size, i]));
}

// Hubs are in rows, with alternating directions.
function starBusAt(i, n, size) {
  const radius = Math.max(1, (size - 1) / 6), apart = 2 * radius + 0.9;
  const hub = Math.floor(i / size), inRow = Math.ceil(1.3 * Math.sqrt(n / size));
  const row = Math.floor(hub / inRow), column = hub % inRow;
  const x = apart * (row % 2 ? inRow - 1 - column : column), y = apart * row;
  if (i % size === 0) return [x, y];
  const angle = 2 * Math.PI * (i % size - 0.5) / (size - 1);
  return [x + radius * Math.cos(angle), y + radius * Math.sin(angle)];
}

const pair = (i, j, n) => (i < j ? i * n + j : j * n + i);

const sorted = hosts => [...hosts].sort((a, b) =>
  byName(a.name, b.name) || byName(a.id, b.id));

function numberedLinks(hosts, links) {
  const number = new Map(hosts.map((host, i) => [host.id, i]));
  const n = hosts.length, found = new Set();
  for (const { a, b } of links) {
    const i = number.get(a), j = number.get(b);
    if (i !== undefined && j !== undefined) found.add(pair(i, j, n));
  }
  return found;
}

// How well the links of a shape match the links found, of which some may be
// down at the moment; 0 if they do not match.
function likeness(found, edges, n) {
  const wanted = new Set(edges.map(([i, j]) => pair(i, j, n)));
  let common = 0;
  for (const key of wanted) if (found.has(key)) common++;
  const explained = common / Math.max(1, found.size);
  const there = common / Math.max(1, wanted.size);
  return explained < EXPLAINED || there < THERE ? 0 : explained * Math.sqrt(there);
}

const columnsOf = (n, shape) => {
  if (!['grid', 'torus', 'star bus'].includes(shape)) return [0];
  const few = range(Math.floor(Math.sqrt(n)) + 1).filter(c => c > 1 && n % c === 0);
  return [...few, ...few.map(c => n / c)];
};

// {shape, columns} that explains the links best, or null if none does well.
export function recognize(hosts, links, shapes = Object.keys(SHAPES)) {
  const inOrder = sorted(hosts), n = inOrder.length;
  const found = numberedLinks(inOrder, links);
  let best = null, most = 0;
  for (const shape of shapes)
    for (const columns of columnsOf(n, shape)) {
      const alike = likeness(found, SHAPES[shape].edges(n, columns), n);
      if (alike > most) [best, most] = [{ shape, columns }, alike];
    }
  return best;
}

// A Map of positions, or null if a force layout is needed.
export function arrange(layout, hosts, links) {
  if (hosts.length === 0) return new Map();
  if (layout === 'random') return scattered(hosts);
  if (layout === 'force')
    return globalThis.d3 ? null : shaped(hosts, { shape: 'ring' });
  if (layout !== 'auto') {
    const columns = recognize(hosts, links, [layout])?.columns
      || Math.ceil(Math.sqrt(hosts.length));
    return shaped(hosts, { shape: layout, columns });
  }
  if (hosts.every(host => host.given))
    return new Map(hosts.map(host => [host.id, { ...host.given }]));
  const whole = hosts.length > 2 && recognize(hosts, links);
  return whole ? shaped(hosts, whole)
    : inPieces(hosts, links) || arrange('force', hosts, links);
}

function shaped(hosts, { shape, columns }) {
  const n = hosts.length;
  return new Map(sorted(hosts).map((host, i) => {
    const [x, y] = SHAPES[shape].at(i, n, columns);
    return [host.id, { x, y }];
  }));
}

// Networks without links between them are placed side by side, in rows, if each
// has a shape.
function inPieces(hosts, links) {
  const pieces = connected(hosts, links);
  if (pieces.length === 1 && hosts.length > 2) return null;
  const all = new Map(), widest = 1.5 * Math.sqrt(hosts.length);
  let left = 0, top = 0, high = 0;
  for (const piece of pieces.sort((a, b) => b.length - a.length)) {
    const known = piece.length < 3 ? { shape: 'line', columns: 0 }
      : recognize(piece, links);
    if (!known) return null;
    const places = shaped(piece, known), box = boundsOf(places);
    if (left > 0 && left + box.width > widest)
      [left, top, high] = [0, top + high + 1.2, 0];
    for (const [id, { x, y }] of places)
      all.set(id, { x: x - box.x + left, y: y - box.y + top });
    left += box.width + 1.2;
    high = Math.max(high, box.height);
  }
  return all;
}

function boundsOf(places) {
  const xs = [...places.values()].map(({ x }) => x);
  const ys = [...places.values()].map(({ y }) => y);
  const x = Math.min(...xs), y = Math.min(...ys);
  return { x, y, width: Math.max(...xs) - x, height: Math.max(...ys) - y };
}

function connected(hosts, links) {
  const root = new Map(hosts.map(host => [host.id, host.id]));
  const find = id => {
    while (root.get(id) !== id) {
      root.set(id, root.get(root.get(id)));
      id = root.get(id);
    }
    return id;
  };
  for (const { a, b } of links)
    if (root.has(a) && root.has(b)) root.set(find(a), find(b));
  const pieces = new Map();
  for (const host of sorted(hosts)) {
    const id = find(host.id);
    if (!pieces.has(id)) pieces.set(id, []);
    pieces.get(id).push(host);
  }
  return [...pieces.values()];
}

// Positions that depend only on the names, so that they are the same each time.
function scattered(hosts) {
  const side = Math.sqrt(hosts.length) * 1.5;
  return new Map(hosts.map(({ id }) => {
    const h = hash(id);
    return [id, { x: side * (h % 65536) / 65536, y: side * (h >>> 16) / 65536 }];
  }));
}

function hash(text) {
  let h = 2166136261;
  for (let i = 0; i < text.length; i++)
    h = Math.imul(h ^ text.charCodeAt(i), 16777619);
  h = Math.imul(h ^ h >>> 15, 2246822507);
  return (h ^ h >>> 13) >>> 0;
}

// Force layout: hosts repel each other, and links attract them. step(ms)
// computes for that time, and returns whether a host moved.
export class Force {
  constructor(hosts, links, places) {
    const d3 = globalThis.d3;
    const centres = groupCentres(hosts);
    this.nodes = sorted(hosts).map(({ id, process }) => {
      const at = places.get(id), centre = centres.get(process), h = hash(id);
      return { id, centre, pinned: false,
               x: at ? at.x : centre.x + (h % 1024) / 1024,
               y: at ? at.y : centre.y + (h >>> 10 & 1023) / 1024 };
    });
    this.byId = new Map(this.nodes.map(node => [node.id, node]));
    this.unit = 1;
    this.ends = [...links]
      .filter(({ a, b }) => this.byId.has(a) && this.byId.has(b))
      .map(({ a, b }) => ({ source: a, target: b }));
    const together = centres.size > 1 ? 0.04 : 0.01;
    this.simulation = d3.forceSimulation(this.nodes).stop().alphaDecay(0.04)
      .force('link', d3.forceLink(this.ends).id(node => node.id).distance(1))
      .force('apart', d3.forceManyBody().strength(-0.3).distanceMax(8))
      .force('room', d3.forceCollide(0.4))
      .force('x', d3.forceX(node => node.centre.x).strength(together))
      .force('y', d3.forceY(node => node.centre.y).strength(together));
    this.simulation.alpha(places.size > this.nodes.length / 2 ? 0.3 : 1);
  }

  step(milliseconds, places) {
    const simulation = this.simulation, end = performance.now() + milliseconds;
    if (simulation.alpha() < simulation.alphaMin()) return false;
    do simulation.tick();
    while (performance.now() < end && simulation.alpha() >= simulation.alphaMin());
    this.measure();
    for (const { id, x, y } of this.nodes)
      places.set(id, { x: x / this.unit, y: y / this.unit });
    return true;
  }

  // The unit is the median length of links.
  measure() {
    const lengths = this.ends.map(({ source, target }) =>
      Math.hypot(source.x - target.x, source.y - target.y)).sort((a, b) => a - b);
    this.unit = lengths[lengths.length >> 1] || 1;
  }

  // A host that the user has dragged keeps its position.
  pin(id, place) {
    const node = this.byId.get(id);
    if (!node) return;
    const x = place.x * this.unit, y = place.y * this.unit;
    [node.x, node.y, node.fx, node.fy] = [x, y, x, y];
    this.simulation.alpha(Math.max(0.15, this.simulation.alpha()));
  }
}

// The centres of processes are around the centre of their machine, those of
// machines around the centre of the network.
function groupCentres(hosts) {
  const machines = new Map();
  for (const { machine, process } of hosts) {
    if (!machines.has(machine)) machines.set(machine, new Set());
    machines.get(machine).add(process);
  }
  const size = Math.sqrt(hosts.length), centres = new Map();
  [...machines.values()].forEach((processes, i) => {
    const middle = machines.size > 1 ? around(i, machines.size, size * 0.9) : [0, 0];
    [...processes].forEach((process, j) => {
      const [x, y] = processes.size > 1
        ? around(j, processes.size, size * 0.6) : [0, 0];
      centres.set(process, { x: middle[0] + x, y: middle[1] + y });
    });
  });
  return centres;
}
