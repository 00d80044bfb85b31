// A table of any length: only the visible rows are in the document.

import {
  element, inOrder, onSize, unpressed, choice, fillChoice,
} from './dom.js';
import { absence, byName, processOf, shortName } from './names.js';

const ROW = 28;                 // pixels, as in style.css
const SPARE = 6;                // rows above and below the visible ones
const CALM = 250;               // ms between two updates

// columns: [{key, title, width, value: row => sortable, text: row => string,
// mark: row => class}]; rows() returns all rows, id(row) the id of one.
export class Table {
  constructor(parent, { label, columns, rows, id, open, sort, rowClass }) {
    Object.assign(this, { columns, rows, id, open, rowClass });
    this.sorting = { key: sort || columns[0].key, down: false };
    this.shown = [];
    this.made = new Map();      // id -> row in the document
    this.active = null;
    this.chosen = null;
    this.words = [];
    this.body = element('div', { class: 'table-body', role: 'rowgroup' });
    this.head = this.heading();
    this.element = element('div', { class: 'table', role: 'grid', tabindex: 0,
      'aria-label': label, onkeydown: event => this.key(event) },
      this.head, this.body);
    parent.append(this.element);
    this.element.addEventListener('scroll', () => this.draw());
    this.body.addEventListener('click', event => this.clicked(event));
    onSize(this.element, () => this.draw());
  }

  heading() {
    const cells = this.columns.map(({ key, title, width, mark }) => {
      const cell = element('div', { role: 'columnheader',
        class: mark?.({}) === 'number' ? 'cell number' : 'cell',
        'aria-sort': 'none' }, element('button', { type: 'button',
        tabindex: -1, onclick: () => this.sortBy(key) }, title));
      cell.style.flex = width;
      cell.dataset.key = key;
      return cell;
    });
    return element('div', { class: 'table-head', role: 'rowgroup' },
      element('div', { class: 'row', role: 'row' }, ...cells));
  }

  sortBy(key) {
    const down = this.sorting.key === key && !this.sorting.down;
    this.sorting = { key, down };
    this.update();
  }

  filter(text, test = null) {
    this.words = text.toLowerCase().split(/\s+/).filter(Boolean);
    this.test = test;
    this.update();
  }

  // Update the table soon, since data have changed.
  changed() {
    if (this.waiting || !this.element.isConnected) return;
    this.waiting = setTimeout(() => unpressed(() => {
      this.waiting = null;
      if (this.element.offsetParent) this.update();
    }), CALM);
  }

  update() {
    const { key, down } = this.sorting;
    const { value } = this.columns.find(column => column.key === key);
    const keyed = [];
    for (const row of this.rows())
      if ((!this.test || this.test(row)) && this.matches(row))
        keyed.push([value(row), this.id(row), row]);
    keyed.sort((a, b) => (down ? -1 : 1) * compare(a[0], b[0])
      || compare(a[1], b[1]));
    this.shown = keyed.map(entry => entry[2]);
    for (const cell of this.head.firstChild.children)
      cell.setAttribute('aria-sort', cell.dataset.key !== key ? 'none'
        : down ? 'descending' : 'ascending');
    this.element.setAttribute('aria-rowcount', this.shown.length + 1);
    this.body.style.height = `${this.shown.length * ROW}px`;
    this.draw();
    this.counted?.(this.shown.length);
  }

  matches(row) {
    if (this.words.length === 0) return true;
    const text = this.columns.map(column => column.text(row)).join(' ')
      .toLowerCase() + ' ' + this.id(row).toLowerCase();
    return this.words.every(word => text.includes(word));
  }

  draw() {
    const height = this.element.clientHeight;
    const first = Math.max(0, Math.floor(this.element.scrollTop / ROW) - SPARE);
    const last = Math.min(this.shown.length,
      first + Math.ceil(height / ROW) + 2 * SPARE);
    const inSight = new Map();
    for (let n = first; n < last; n++) {
      const id = this.id(this.shown[n]);
      inSight.set(id, this.made.get(id) || this.newRow(id));
      this.fillRow(inSight.get(id), n);
    }
    this.made = inSight;
    inOrder(this.body, [...inSight.values()]);
    const active = inSight.get(this.active);
    if (active) this.element.setAttribute('aria-activedescendant', active.id);
    else this.element.removeAttribute('aria-activedescendant');
  }

  // A row stays the same element while it is visible.
  newRow(id) {
    const made = element('div', { role: 'row' }, ...this.columns.map(column => {
      const cell = element('div', { role: 'gridcell' });
      cell.style.flex = column.width;
      return cell;
    }));
    made.dataset.row = id;
    return made;
  }

  fillRow(made, n) {
    const row = this.shown[n], id = this.id(row);
    made.id = `${this.element.id || 'r'}-${n}`;
    made.className = ['row', this.rowClass?.(row), id === this.active && 'active']
      .filter(Boolean).join(' ');
    made.setAttribute('aria-rowindex', n + 2);
    made.setAttribute('aria-selected', String(id === this.chosen));
    made.style.transform = `translateY(${n * ROW}px)`;
    this.columns.forEach((column, i) => {
      const cell = made.children[i], text = column.text(row);
      cell.className = `cell ${column.mark?.(row) || ''}`;
      if (cell.textContent === text) return;
      cell.textContent = text;
      cell.title = text;
    });
  }

  clicked(event) {
    const row = event.target.closest('.row');
    if (!row) return;
    this.active = row.dataset.row;
    this.open(row.dataset.row);
  }

  choose(id) {
    this.chosen = id;
    this.draw();
  }

  key(event) {
    if (event.target.closest('.table-head')) return;
    const now = this.shown.findIndex(row => this.id(row) === this.active);
    const page = Math.floor(this.element.clientHeight / ROW) - 1;
    const to = { ArrowDown: now + 1, ArrowUp: now - 1, Home: 0,
      End: this.shown.length - 1, PageDown: now + page,
      PageUp: now - page }[event.key];
    if (to !== undefined) {
      event.preventDefault();
      this.go(Math.min(this.shown.length - 1, Math.max(0, to)));
    } else if (event.key === 'Enter' && this.active) {
      this.open(this.active);
    } else if (/^[1-9]$/.test(event.key) && this.columns[event.key - 1]) {
      this.sortBy(this.columns[event.key - 1].key);
    }
  }

  go(n) {
    if (!this.shown[n]) return;
    this.active = this.id(this.shown[n]);
    const top = n * ROW, height = this.element.clientHeight - ROW;
    if (top < this.element.scrollTop) this.element.scrollTop = top;
    else if (top + ROW > this.element.scrollTop + height)
      this.element.scrollTop = top + ROW - height;
    this.draw();
  }
}

const compare = (a, b) => typeof a === 'number' && typeof b === 'number'
  ? a - b : byName(a ?? '', b ?? '');

// The views Hosts and Agents: lists over all processes.

const number = n => n === null || n === undefined ? '' : n.toLocaleString('en');

export function agentList(parent, store, app) {
  const more = agent => app.more.get(agent.id) || {};
  const doing = agent => {
    if (agent.status === 'ended') return `ended: ${agent.outcome ?? 'unknown'}`;
    if (agent.status === 'faulty' && agent.fault) return `faulty: ${agent.fault}`;
    // the last snapshot may be from an earlier hop
    if (agent.status === 'in_transit')
      return agent.hop ? `in_transit to ${shortName(agent.hop.to)}` : 'in_transit';
    const row = more(agent);
    return row.status === agent.status && row.doing ? row.doing : agent.status;
  };
  list(parent, store, app, {
    label: 'Agents', what: 'agent', rows: () => store.agents.values(),
    columns: [
      column('name', 'Agent', '3 1 9rem', agent => agent.name),
      column('host', 'Host', '2 1 6rem', agent => agent.host && shortName(agent.host)),
      column('process', 'Process', '2 1 7rem',
        agent => agent.host && processOf(agent.host)),
      column('program', 'Program', '2 1 6rem', agent => agent.program),
      column('state', 'State', '3 1 8rem', doing,
        agent => `state-${agent.status}`),
      count('hops', 'Hops', agent => Math.max(agent.hops, more(agent).hops || 0)),
      count('mail', 'Mail', agent => more(agent).mail),
    ],
    choices: [['program', 'Program', agent => agent.program],
      ['status', 'State', agent => agent.status]],
    rowClass: agent => agent.status === 'ended' ? 'over' : '',
  });
}

export function hostList(parent, store, app) {
  list(parent, store, app, {
    label: 'Hosts', what: 'host', rows: () => store.hosts.values(),
    columns: [
      column('name', 'Host', '2 1 6rem', host => host.name),
      column('process', 'Process', '2 1 8rem', host => host.process),
      column('state', 'State', '1 1 5rem',
        host => [host.state, absence(host)].filter(Boolean).join(' '),
        host => `state-${host.state}`),
      count('agents', 'Agents', host => host.agents.size),
      count('links', 'Links', host => host.links.size),
      column('neighbours', 'Neighbours', '4 1 8rem', host =>
        [...host.links.keys()].map(shortName).sort(byName).join(' ')),
    ],
    choices: [['process', 'Process', host => host.process],
      ['state', 'State', host => host.state]],
    rowClass: host => host.state === 'running' ? '' : 'over',
  });
}

const column = (key, title, width, text, mark) =>
  ({ key, title, width, text: row => String(text(row) ?? ''), value: row =>
    text(row) ?? '', mark });
const count = (key, title, value) =>
  ({ key, title, width: '0 0 4.5rem', value: row => value(row) ?? -1,
     text: row => number(value(row)), mark: () => 'number' });

function list(parent, store, app, { label, what, rows, columns, choices,
                                    rowClass }) {
  const chosenOf = chosen => chosen[what] ?? null;
  const search = element('input', { type: 'search', placeholder: 'Filter',
    'aria-label': `Filter ${what}s`, oninput: () => filter() });
  const wanted = new Map(), selects = new Map();
  for (const [key, title, value] of choices) {
    wanted.set(key, ['', value]);
    selects.set(key, choice(title, [['', `any ${title.toLowerCase()}`]], '',
      chosen => { wanted.set(key, [chosen, value]); filter(); }));
  }
  const counted = element('span', { class: 'muted', role: 'status' });
  parent.append(element('section', { class: 'view list', 'aria-label': label },
    element('div', { class: 'view-bar' }, search, ...selects.values(), counted)));
  const table = new Table(parent.firstChild, { label, columns, rows, rowClass,
    id: row => row.id, sort: columns[0].key,
    open: id => app.select({ [what]: id }) });
  table.element.id = `table-${what}`;
  table.counted = n => { counted.textContent = `${number(n)} ${what}${n === 1 ? '' : 's'}`; };

  function filter() {
    const tests = [...wanted.values()].filter(([value]) => value !== '');
    table.filter(search.value, tests.length === 0 ? null
      : row => tests.every(([value, of]) => String(of(row)) === value));
  }

  function fillChoices() {
    for (const [key, title, value] of choices) {
      const values = new Set([wanted.get(key)[0]]);
      for (const row of rows()) values.add(String(value(row) ?? ''));
      values.delete('');
      const all = [['', `any ${title.toLowerCase()}`], ...[...values].sort()];
      const now = all.join(' ');
      if (selects.get(key).dataset.all === now) continue;
      selects.get(key).dataset.all = now;
      fillChoice(selects.get(key), all, wanted.get(key)[0]);
    }
  }

  const update = () => {
    fillChoices();
    table.update();
  };
  store.on('change', () => table.changed());
  const inSight = () => { if (parent.offsetParent) update(); };
  app.on('snapshot', () => unpressed(inSight));
  app.on('view', inSight);
  app.on('select', chosen => table.choose(chosenOf(chosen)));
  table.choose(chosenOf(app.chosen));
  update();
}
