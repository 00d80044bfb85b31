// A table of any length: only the rows in sight are in the document.

import { element, inOrder, onSize } from './dom.js';
import { unpressed } from './press.js';

const ROW = 28;                 // pixels, as in style.css
const SPARE = 6;                // rows above and below those in sight
const CALM = 250;               // ms between two looks at what has changed

// columns: [{key, title, width, value: row => sortable, text: row => string,
// mark: row => class}]; rows(): all of them; id(row).
export class Table {
  constructor(parent, { label, columns, rows, id, open, sort, rowClass }) {
    Object.assign(this, { columns, rows, id, open, rowClass });
    this.sorting = { key: sort || columns[0].key, down: false };
    this.shown = [];
    this.made = new Map();      // id: row in the document
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

  // Something has changed.
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

  // A row stays the same element while it is in sight.
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

const collator = new Intl.Collator('en', { numeric: true });
const compare = (a, b) => typeof a === 'number' && typeof b === 'number'
  ? a - b : collator.compare(a ?? '', b ?? '');
