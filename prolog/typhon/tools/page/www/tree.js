// The view Supervision: a tree of agents, their children and the agents that
// they monitor, and the recent actions of supervisors.

import { chooser, element, renew } from './dom.js';
import { shortName } from './names.js';

const PAUSE = 1500;             // ms between two queries
const SHOWN = 100;              // lines with actions of supervisors
const HAPPENED = /^(restarts|down|takes_over|gives_up|not_started)\(/;

export const mount = (parent, store, app) => new Tree(parent, store, app);

class Tree {
  constructor(parent, store, app) {
    Object.assign(this, { store, app });
    this.list = element('ul', { class: 'tree', 'aria-label': 'Supervision' });
    this.said = element('p', { class: 'empty', role: 'status' });
    this.lines = element('ul', { class: 'plain log', 'aria-label': 'Restarts' });
    parent.append(element('section', { class: 'view view-tree',
      'aria-label': 'Supervision' },
      element('div', { class: 'tree-list', tabindex: 0 }, this.said, this.list),
      element('div', { class: 'tree-events', tabindex: 0 },
        element('h3', {}, 'Restarts'), this.lines)));
    app.on('view', () => this.look());
    this.again();
  }

  async again() {
    await this.look();
    setTimeout(() => this.again(), PAUSE);
  }

  async look() {
    const { app } = this;
    if (document.hidden || app.view !== 'tree' || app.state !== 'open') return;
    try {
      this.show(await app.ask({ ask: 'tree' }));
    } catch (error) {
      this.say(error.message);
    }
    this.showLines();
  }

  show(nodes) {
    this.say(nodes.length ? '' : 'No agent monitors another');
    renew(this.list, nodes.map(node => this.node(node)));
  }

  say(text) {
    this.said.textContent = text;
    this.said.hidden = text === '';
  }

  node({ id, relation, host, program, status, doing, below }) {
    return element('li', {},
      chooser(this.app, { agent: id }),
      status ? element('span', { class: `pill state-${status}`, title: doing },
        status) : null,
      host ? element('span', { class: 'muted' },
        ` ${program} on ${shortName(host)}`) : null,
      relation === 'monitored' ? element('span', { class: 'muted' }, ', monitored')
        : null,
      below.length ? element('ul', { class: 'tree' },
        ...below.map(other => this.node(other))) : null);
  }

  showLines() {
    const lines = [...this.store.hosts.values()].flatMap(host =>
      host.lines.filter(([, agent, text]) => agent && HAPPENED.test(text)));
    lines.sort((a, b) => b[0] - a[0]);
    renew(this.lines, lines.slice(0, SHOWN).map(([time, agent, text]) =>
      element('li', {}, element('span', { class: 'muted' },
        `${time === null ? '' : time.toFixed(2)} `),
        chooser(this.app, { agent }), ` ${text}`)));
  }
}
