// A network that exists nowhere: a grid of hosts whose agents hop at random,
// told to the store as the feed tells it, ten times a second.

import { Store } from '/www/store.js';
import { mount } from '/www/map.js';

const given = new URLSearchParams(location.search);
const number = (name, otherwise) => Number(given.get(name) ?? otherwise);
const rows = number('rows', 25), columns = number('columns', 40);
const agents = number('agents', 10000), hops = number('hops', 5000);
const processes = number('processes', 4), seconds = number('took', 0.0002);
const BATCH = 0.1;

const id = i => `n${i + 1}@127.0.0.1:${7000 + Math.floor(i * processes / (rows * columns))}`;
const neighbours = i => {
  const x = i % columns, y = Math.floor(i / columns);
  return [x > 0 && i - 1, x + 1 < columns && i + 1, y > 0 && i - columns,
          y + 1 < rows && i + columns].filter(j => j !== false);
};

const store = new Store();
const where = new Uint32Array(agents);
const hosts = [], all = [];
for (let i = 0; i < rows * columns; i++)
  hosts.push({ id: id(i), links: neighbours(i).map(j => [id(j), 1]), load: null });
for (let a = 0; a < agents; a++) {
  where[a] = Math.floor(Math.random() * hosts.length);
  all.push({ id: `p${a % 5}.${a}@n1@127.0.0.1:7000`, host: hosts[where[a]].id,
             program: ['tourist', 'guard', 'census', 'robot', 'trainer'][a % 5],
             status: 'waiting' });
}
store.applySnapshot({ time: 0, hosts, agents: all });
const chosen = new Set();
const app = { select: what => chosen.forEach(f => f(what)),
  on: (name, f) => chosen.add(f), act: async () => ({}), prefs: {} };
const view = mount(document.getElementById('map'), store, app);
if (given.get('layout')) view.setLayout(given.get('layout'));

let time = 0, spent = 0, batches = 0;
function batch() {
  const events = [];
  for (let n = 0; n < hops * BATCH; n++) {
    const a = Math.floor(Math.random() * agents), from = where[a];
    const choices = neighbours(from);
    const to = choices[Math.floor(Math.random() * choices.length)];
    where[a] = to;
    time += 1 / hops;
    events.push([time, id(from), all[a].id, 'left', id(to)],
                [time + seconds, id(to), all[a].id, 'arrived', id(from), seconds]);
  }
  const start = performance.now();
  store.applyEvents(events);
  spent += performance.now() - start;
  batches++;
}
if (hops > 0) setInterval(batch, BATCH * 1000);

let frames = 0, worst = 0, before = performance.now(), drawing = 0;
const drawn = view.frame.bind(view);
view.frame = () => {
  const start = performance.now();
  view.waiting = 0;
  drawn();
  drawing += performance.now() - start;
  frames++;
  worst = Math.max(worst, start - before);
  before = start;
};
globalThis.measure = { view, store, app,
  start() { frames = worst = drawing = spent = batches = 0; before = performance.now();
            this.from = before; },
  result() {
    const wall = (performance.now() - this.from) / 1000;
    return { framesPerSecond: frames / wall, worstFrame: worst,
             drawing: drawing / Math.max(1, frames), applying: spent / Math.max(1, batches),
             moving: store.moving.size, hops: store.counts.arrived };
  } };
