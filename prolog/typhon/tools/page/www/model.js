// The view Model: sliders for the parameters of a program, Set up, which starts
// it anew with their values, and plots of what it measures while it runs. What
// the page asks and gets is described in models.pl.

import { Charts, compact } from './charts.js';
import { button, element } from './dom.js';
import { parameter } from './forms.js';

const PAUSE = 1000;             // ms between questions, at least
const MANY = 24;                // plots

export const mount = (parent, store, app) => new Model(parent, store, app);

class Model {
  constructor(parent, store, app) {
    this.app = app;
    this.samples = [];
    this.seen = { run: null, count: 0 };
    this.title = element('h2', {});
    this.fields = element('div', { class: 'model-fields' });
    this.start = button('Set up', () => this.setUp(),
      { class: 'primary', 'data-order': 'set_up' });
    this.said = element('p', { class: 'muted', role: 'status' });
    const form = element('section', { class: 'model-form', 'aria-label': 'Parameters' },
      this.title, this.fields, this.start, this.said);
    const plots = element('div', { class: 'model-plots' });
    parent.append(element('div', { class: 'view-model' }, form, plots));
    this.measures = new Measures(plots, store, app, this);
    this.again();
  }

  async again() {
    clearTimeout(this.timer);
    const { app } = this, start = performance.now();
    if (!document.hidden && app.view === 'model' && app.state === 'open')
      await this.look().catch(error => { this.said.textContent = error.message; });
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.again(),
      Math.max(PAUSE, 5 * (performance.now() - start)));
  }

  async look() {
    const now = await this.app.ask({ ask: 'model', run: this.seen.run,
      since: this.seen.count });
    if (now.run !== this.seen.run) this.samples = [];
    this.seen = now;
    for (const [time, rows] of now.samples)
      this.samples.push({ start: time, values: new Map(rows) });
    this.show(now);
    this.measures.update();
  }

  show({ title, parameters, state, error }) {
    this.title.textContent = title;
    const names = parameters.map(({ name }) => name).join(' ');
    if (names !== this.names) {
      this.names = names;
      this.inputs = parameters.map(parameter);
      this.fields.replaceChildren(...this.inputs.map(({ made }) => made));
    }
    const may = this.app.orders.has('set_up');
    this.start.disabled = !may;
    this.start.title = may ? '' : 'This page allows no changes';
    this.said.textContent = { none: '', running: '', finished: 'The run has ended.',
      failed: `The run has failed: ${error}` }[state];
  }

  async setUp() {
    this.start.disabled = true;
    const values = Object.fromEntries(this.inputs.map(({ name, value }) =>
      [name, value()]));
    await this.app.order({ do: 'set_up', values });
    this.forget(this.app.store);
    await this.app.refresh().catch(() => {});
    await this.app.run.again();
    await this.again();
  }

  // The hosts and events of the run before.
  forget(store) {
    const overlays = [...store.overlays.values()];
    store.reset();
    for (const overlay of overlays) store.overlay(overlay);
  }
}

class Measures extends Charts {
  constructor(parent, store, app, model) {
    super(parent, store, app);
    this.model = model;
    this.update();
  }

  // One plot for each measure that has had a value.
  get kinds() {
    const names = new Set();
    for (const { values } of this.model?.samples ?? [])
      for (const name of values.keys()) names.add(name);
    return [...names].slice(0, MANY).map(name => ({ name, title: name, value: compact,
      series: () => [[name, sample => sample.values.get(name) ?? null, 0]] }));
  }

  context() { return { stretches: this.model?.samples ?? [] }; }

  update() {
    if (!this.plots) return;
    const { kinds } = this;
    const known = this.plots.map(({ plot }) => plot.name).join('\n');
    if (known !== kinds.map(({ name }) => name).join('\n')) {
      for (const { drawn, place } of this.plots) {
        drawn?.destroy();
        place.remove();
      }
      this.plots = kinds.map(kind => this.add(kind));
    }
    this.draw();
  }
}
