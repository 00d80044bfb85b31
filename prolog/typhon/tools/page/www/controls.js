// Virtual time, and its controls: Go, Step, speed. This module knows neither a
// server nor a worker, but a connection,
//
//     {ask(message) -> promise of the answer, may(order) -> whether it is allowed}
//
// It asks {ask: 'run'}, whose answer is described in runs.pl, and gives the
// orders go, pause, step and speed.

import { button, element } from './dom.js';
import { Announcer } from './store.js';

const PAUSES = { going: 250, other: 1000 };     // ms between questions
const FASTEST = 4;              // the end of the slider of speed: no limit

// The state of virtual time. It announces 'state' after each answer, and 'error'
// with a text after an order that failed.
export class Run extends Announcer {
  // shown: () => whether to ask now.
  constructor(connection, shown = () => true) {
    super();
    this.connection = connection;
    this.shown = shown;
    this.now = { virtual: false, time: null, state: 'none', speed: 1 };
    this.again();
  }

  may(order) { return this.connection.may(order); }

  async again() {
    clearTimeout(this.timer);
    if (this.shown()) await this.look().catch(() => {});
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.again(), PAUSES[this.now.state] || PAUSES.other);
  }

  async look() {
    this.now = await this.connection.ask({ ask: 'run' });
    this.tell('state', this.now);
  }

  async order(message) {
    try {
      await this.connection.ask(message);
    } catch (error) {
      this.tell('error', error.message);
    }
    await this.again();
  }

  goOrPause() {
    return this.order({ do: this.now.state === 'going' ? 'pause' : 'go' });
  }

  step() { return this.order({ do: 'step' }); }

  // Virtual seconds per second; null: as fast as possible.
  speed(speed) { return this.order({ do: 'speed', speed }); }
}

const clockText = time => (time === null ? '' : `${time.toLocaleString('en',
  { minimumFractionDigits: 2, maximumFractionDigits: 2 })} s`);

const speedText = speed => (speed === null ? 'as fast as it can'
  : `${Number(speed.toPrecision(2))} s a second`);

const toSlider = speed => (speed === null ? FASTEST : Math.log10(speed));
const fromSlider = at => (at >= FASTEST ? null : Number((10 ** at).toPrecision(2)));

// The bar with the controls, which is hidden without virtual time. A control
// whose order is not allowed is disabled.
export function controlBar(run) {
  const go = button('Go', () => run.goOrPause(), { class: 'primary', 'data-order': 'go' });
  const step = button('Step', () => run.step(), { 'data-order': 'step' });
  const speed = element('input', { type: 'range', min: -1, max: FASTEST,
    step: 0.1, 'aria-label': 'Speed', 'data-order': 'speed',
    oninput: () => say(fromSlider(Number(speed.value))),
    onchange: () => run.speed(fromSlider(Number(speed.value))) });
  const said = element('output', { class: 'run-speed' });
  const time = element('output', { class: 'run-time', 'aria-label': 'Virtual time' });
  const bar = element('div', { class: 'run-bar', role: 'group',
    'aria-label': 'Virtual time' }, go, step, time,
  element('label', {}, 'Speed', speed, said));

  const say = value => {
    said.textContent = speedText(value);
    speed.setAttribute('aria-valuetext', speedText(value));
  };
  const update = () => {
    const { virtual, time: seconds, state, speed: now } = run.now;
    const going = state === 'going';
    bar.hidden = !virtual;
    for (const control of [go, step, speed]) {
      const may = run.may(control.dataset.order);
      control.disabled = !may || (control === step && going);
      control.title = may ? '' : 'This page allows no changes';
    }
    go.textContent = going ? 'Pause' : 'Go';
    time.textContent = clockText(seconds);
    if (document.activeElement !== speed) {
      speed.value = toSlider(now);
      say(now);
    }
  };
  run.on('state', update);
  update();
  return bar;
}
