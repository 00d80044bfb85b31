// Hosts and agents of all processes, as lists.

import { choice, element, fillChoice } from './dom.js';
import { unpressed } from './press.js';
import { byName, shortName } from './names.js';
import { Table } from './table.js';

const number = n => n === null || n === undefined ? '' : n.toLocaleString('en');

export function agentList(parent, store, app) {
  const more = agent => app.more.get(agent.id) || {};
  const doing = agent => {
    if (agent.status === 'ended') return `ended: ${agent.outcome ?? 'unknown'}`;
    if (agent.status === 'faulty' && agent.fault) return `faulty: ${agent.fault}`;
    const told = more(agent);
    return told.status === agent.status && told.doing ? told.doing : agent.status;
  };
  list(parent, store, app, {
    label: 'Agents', what: 'agent', rows: () => store.agents.values(),
    columns: [
      column('name', 'Agent', '3 1 9rem', agent => agent.name),
      column('host', 'Host', '2 1 6rem', agent => agent.host && shortName(agent.host)),
      column('process', 'Process', '2 1 7rem', agent => agent.host
        && agent.host.slice(agent.host.indexOf('@') + 1)),
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
      column('state', 'State', '1 1 5rem', host => host.state,
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
