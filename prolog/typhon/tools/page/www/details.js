// The details of the selected agent, with its program, or host; updated live.

import { button, chooser, element, renew, unpressed } from './dom.js';
import { absence, shortName } from './names.js';
import { agentActions, hostActions } from './work.js';

const CALM = 1000;              // ms between two queries while events arrive
const PAUSE = 3000;             // ... while none arrive

export function details(parent, store, app) {
  const panel = new Details(parent, store, app);
  app.on('select', chosen => panel.choose(chosen));
  app.on('rights', () => panel.choose(app.chosen));
  app.on('state', () => panel.look());
  store.on('events', events => panel.onEvents(events));
}

class Details {
  constructor(parent, store, app) {
    Object.assign(this, { parent, store, app, sections: new Map(), round: 0 });
    this.opened = new Set(['Program', 'Facts', 'Mailbox', 'Fault', 'Neighbours',
      'Tuple space', 'Agents here']);
    addEventListener('keydown', event => {
      if (event.key === 'Escape' && !document.querySelector('dialog[open]')
          && !parent.hidden) app.select({});
    });
    setInterval(() => this.look(), PAUSE);
  }

  choose({ agent, host }) {
    const what = agent ? 'agent' : host ? 'host' : null;
    this.what = what;
    this.id = agent || host;
    this.sections.clear();
    this.parent.hidden = !what;
    document.body.classList.toggle('chosen', Boolean(what));
    if (!what) return;
    this.title = element('h2', { tabindex: -1 }, shortName(this.id));
    this.state = element('span', { class: 'pill' });
    this.facts = element('dl', { class: 'facts' });
    this.buttons = element('div', { class: 'buttons' });
    this.list = element('div', { class: 'sections' });
    this.problem = element('p', { class: 'problem', role: 'status', hidden: true });
    this.parent.replaceChildren(
      element('div', { class: 'details-head' }, this.title, this.state,
        button('×', () => this.app.select({}), { 'aria-label': 'Close details',
          class: 'close' })),
      element('p', { class: 'id' }, this.id), this.buttons, this.facts,
      this.problem, this.list);
    const make = what === 'agent' ? agentActions : hostActions;
    if (this.app.act) this.buttons.append(...make(this.app, this.id));
    this.parent.setAttribute('aria-label', `${what} ${shortName(this.id)}`);
    this.look(true);
  }

  onEvents(events) {
    if (!this.what || this.soon) return;
    const index = this.what === 'agent' ? 2 : 1;
    if (!events.some(event => event[index] === this.id)) return;
    this.soon = setTimeout(() => { this.soon = null; this.look(true); }, CALM);
  }

  async look(always = false) {
    if (!this.what || document.hidden || (this.looking && !always)) return;
    const round = ++this.round, { what, id } = this;
    this.looking = true;
    const host = what === 'host' && this.store.hosts.get(id);
    try {
      if (host?.state === 'away') throw new Error(`Away ${absence(host)}`);
      const data = await this.app.ask({ ask: what, [what]: id });
      await new Promise(unpressed);
      if (round !== this.round || id !== this.id) return;
      this.problem.hidden = true;
      if (what === 'agent') this.showAgent(data);
      else this.showHost(data);
    } catch (error) {
      if (round !== this.round || id !== this.id) return;
      this.problem.hidden = false;
      this.problem.textContent = error.message;
      const known = what === 'agent' ? this.store.agents.get(id)?.status
        : this.store.hosts.get(id)?.state;
      this.pill(known || 'unknown');
    } finally {
      this.looking = false;
    }
  }

  pill(text) {
    const word = text.split(/[\s(]/)[0];
    this.state.textContent = word;
    this.state.className = `pill state-${word}`;
  }

  // [[term, text or element]]
  define(rows) {
    renew(this.facts, rows.filter(([, value]) => value !== undefined && value !== '')
      .map(([name, value]) => element('div', {}, element('dt', {}, name),
        element('dd', {}, value))));
  }

  hostLink(host) { return chooser(this.app, { host }); }

  agentLink(agent) { return chooser(this.app, { agent }); }

  // A section that can be collapsed. Only changed parts of it are replaced.
  // `around` is the element that contains the parts; it is created once.
  section(title, content, around, parts, note = '') {
    const key = JSON.stringify(content);
    let section = this.sections.get(title);
    if (!section) {
      const summary = element('summary', {}, title,
        element('span', { class: 'muted' }));
      const body = element('div', { class: 'body', tabindex: -1 }, around);
      const made = element('details', { open: this.opened.has(title),
        ontoggle: () => this.opened[made.open ? 'add' : 'delete'](title) },
        summary, body);
      section = { made, around, note: summary.lastChild, key: null };
      this.sections.set(title, section);
      this.list.append(made);
    }
    section.note.textContent = note === '' ? '' : ` ${note}`;
    section.made.hidden = Array.isArray(content) && content.length === 0;
    if (section.key === key) return;
    section.key = key;
    renew(section.around, parts(content));
  }

  texts(title, list, count = list.length) {
    this.section(title, list, element('pre', { class: 'terms' }),
      terms => terms.map(term => element('span', {}, `${term}\n`)),
      count > list.length ? `${list.length} of ${count}` : count);
  }

  items(title, rows, entry, note = rows.length,
        around = element('ul', { class: 'plain' })) {
    this.section(title, rows, around,
      () => rows.map(row => element('li', {}, ...entry(row))), note);
  }

  // ------------------------------------------------------------- an agent

  showAgent(data) {
    const known = this.store.agents.get(this.id);
    if (data.outcome !== undefined) {
      this.pill('ended');
      this.define([['Outcome', data.outcome], ['Program', known?.program ?? '']]);
      for (const action of this.buttons.querySelectorAll('button'))
        action.disabled = true;
    } else {
      this.pill(data.state);
      for (const action of this.buttons.querySelectorAll('.for-faulty'))
        action.hidden = !data.fault;
      this.define([['Host', this.hostLink(data.host)], ['Program', data.name],
        ['Home', data.home === data.host ? 'here' : this.hostLink(data.home)],
        ['Hops', data.hops.toLocaleString('en')],
        ['Busy', data.busy && `${data.busy.toFixed(1)} s`]]);
      this.section('Fault', data.fault ? [data.fault] : [], element('div'),
        faults => faults.flatMap(fault => [
          element('pre', { class: 'problem' }, fault.error),
          element('p', {}, `in ${fault.goal}, ${fault.place}`)]));
      this.section('Program', data.program, element('pre', { class: 'program' }),
        programLines);
      this.texts('Goals left', data.goals);
      this.texts('Facts', data.facts, data.fact_count);
      this.items('Mailbox', data.mailbox || [], ([from, text]) =>
        [element('code', {}, text),
         element('span', { class: 'muted' }, ` from ${shortName(from)}`)]);
      this.texts('Payloads', data.payloads);
    }
    if (known) this.items('Trail', known.trail.slice(-64),
      host => [this.hostLink(host)], known.trail.length,
      element('ol', { class: 'trail' }));
  }

  // --------------------------------------------------------------- a host

  showHost(data) {
    const known = this.store.hosts.get(this.id);
    this.pill(known?.state || 'running');
    this.define([['Process', data.process], ['Agents', data.capacity === 'inf'
      ? data.load : `${data.load} of ${data.capacity}`],
      ...data.hop_times.map(([way, n, min, mean, max]) => [`Hops ${way}`,
        `${n.toLocaleString('en')}, in ${ms(mean)} ms (${ms(min)} to ${ms(max)})`])]);
    const links = data.links.map(id => [id, known?.links.get(id) ?? 1]);
    this.items('Neighbours', links, ([id, cost]) => [this.hostLink(id),
      cost === 1 ? null : element('span', { class: 'muted' }, ` cost ${cost}`),
      this.app.act ? button('unlink', () => this.unlink(id),
        { class: 'small', 'aria-label': `Unlink ${shortName(id)}` }) : null]);
    const agents = known ? [...known.agents].map(agent =>
      [agent.id, agent.program]).slice(0, 300) : [];
    this.items('Agents here', agents, ([id, program]) => [this.agentLink(id),
      element('span', { class: 'muted' }, ` ${program}`)], known?.agents.size);
    this.texts('Tuple space', data.tuples);
    this.texts('Pheromones', data.pheromones);
    this.texts('Place', data.place);
    this.texts('Services', data.services);
    this.texts('Options', data.options);
    const lines = (known?.lines || []).slice(-100).reverse();
    this.items('Log', lines, ([time, agent, text]) =>
      [element('span', { class: 'muted' }, `${time === null ? '' : time.toFixed(2)} `),
       agent ? this.agentLink(agent) : null, ` ${text}`], lines.length,
      element('ul', { class: 'plain log' }));
  }

  async unlink(other) {
    await this.app.order({ do: 'unlink', a: this.id, b: other });
    this.look(true);
  }
}

const ms = seconds =>
  seconds < 0.9995 ? (seconds * 1000).toPrecision(3) : (seconds * 1000).toFixed(0);

function programLines({ lines, here }) {
  const marked = new Set(here);
  return lines.map((line, n) => element('span', marked.has(n + 1)
    ? { class: 'here', title: 'Here it stands' } : {}, `${line}\n`));
}
