// Orders for agents, hosts and networks.

import { button, element } from './dom.js';
import {
  dialog, field, parameter, quoted, readFile, select, sure,
} from './forms.js';
import { byName, counted, shortName } from './names.js';
import { download } from './svg.js';

export const hostsThere = app => [...app.store.hosts.values()]
  .filter(host => host.state === 'running').map(host => host.id).sort(byName);

// The proposed host is the selected one, or one with links, as agents cannot
// find neighbours on a host without links.
export function hostField(app, label, value) {
  const hosts = hostsThere(app);
  const linked = hosts.find(id => app.store.hosts.get(id).links.size > 0);
  return field(label, { list: hosts, required: true, value: value
    ?? app.chosen.host ?? linked ?? hosts[0] ?? '' });
}

// Send an order; errors are shown in the form that sent it.
export async function order(app, message, said) {
  const answer = await app.ask(message);
  for (const problem of answer.said) app.note(problem.text, 'warning');
  if (said) app.note(typeof said === 'function' ? said(answer.done) : said);
  return answer.done;
}

// The content of a field as a Prolog list.
function listed({ input }) {
  const text = input.value.trim();
  return text && !text.startsWith('[') ? `[${text}]` : text;
}

// ------------------------------------------------------------------- menu

export function workMenu(app) {
  const items = [
    ['New agent …', () => newAgent(app)],
    ['Load an agent …', () => loadAgent(app)],
    ['Start a mechanism …', () => mechanismDialog(app)],
    ['New host …', () => newHost(app)],
    ['New network …', () => newNetwork(app)],
    ['End a network …', () => endNetwork(app)],
  ];
  const menu = element('div', { role: 'menu', class: 'menu', hidden: true },
    ...items.map(([title, act]) => button(title, () => { close(); act(); },
      { role: 'menuitem' })));
  const opener = button('New', () => toggle(menu.hidden), { class: 'primary',
    'aria-haspopup': 'menu', 'aria-expanded': 'false' });
  const toggle = open => {
    menu.hidden = !open;
    opener.setAttribute('aria-expanded', String(open));
    if (open) menu.firstChild.focus();
  };
  const close = () => { toggle(false); opener.focus(); };
  menu.addEventListener('keydown', event => {
    const all = [...menu.children], now = all.indexOf(document.activeElement);
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step) {
      event.preventDefault();
      all[(now + step + all.length) % all.length].focus();
    } else if (event.key === 'Escape') {
      event.stopPropagation();
      close();
    }
  });
  document.addEventListener('click', event => {
    if (!menu.hidden && !menu.parentElement.contains(event.target)) toggle(false);
  });
  return element('div', { class: 'menu-of' }, opener, menu);
}

// ----------------------------------------------------------------- agents

async function newAgent(app, host) {
  const programs = await app.ask({ ask: 'programs' }).catch(() => []);
  const written = editor(app);
  const source = select('Program', [['text', 'as written below'],
    ...programs.map(name => [name, name])]);
  const at = hostField(app, 'Host', host);
  const name = field('Name', { placeholder: 'as its program' });
  const options = field('Options', { placeholder: 'lifetime(9), facts([a(1)])' },
    'payloads, facts, tokens, lifetime, static: as of agent_create/3');
  source.input.addEventListener('change', () => {
    written.element.hidden = source.input.value !== 'text';
  });
  dialog('New agent', [element('div', { class: 'fields' }, source, at, name,
    options), written.element], 'Create', async () => {
    const program = source.input.value === 'text' ? { text: written.value }
      : { program: source.input.value };
    const agent = await order(app, { do: 'create', ...program,
      host: at.input.value, name: name.input.value, options: listed(options) },
    id => `${shortName(id)} is created`);
    app.select({ agent });
  }, true);
}

function loadAgent(app) {
  const at = hostField(app, 'Host');
  let text = null;
  const file = element('p', { class: 'muted' }, 'no file is chosen');
  dialog('Load an agent', [button('Choose a restore point …', () =>
    readFile('.pl,.pro,.txt,text/plain', (content, name) => {
      text = content;
      file.textContent = name;
    })), file, at], 'Load', async () => {
    if (text === null) throw new Error('No file is chosen');
    app.select({ agent: await order(app, { do: 'load', text,
      host: at.input.value }, id => `${shortName(id)} goes on`) });
  });
}

export function agentActions(app, agent) {
  const does = (message, said) => app.order({ agent, ...message }, said);
  return [
    button('Send a message …', () => sendMessage(app, agent)),
    button('Move …', () => {
      const to = hostField(app, 'Host');
      dialog(`Move ${shortName(agent)}`, [to], 'Move', () => order(app,
        { do: 'move', agent, host: to.input.value },
        `${shortName(agent)} is to move`));
    }),
    button('Clone', async () => {
      const clone = await does({ do: 'clone' });
      if (clone) app.note(`Its clone is ${shortName(clone.done)}`);
    }),
    button('Resume', () => does({ do: 'resume' }, 'It tries again'),
      { class: 'for-faulty', hidden: true }),
    button('Save', async () => {
      const saved = await does({ do: 'save' });
      if (saved) download(`${shortName(agent)}.pl`,
        new Blob([saved.done], { type: 'text/plain' }));
    }),
    button('Dispose', () => does({ do: 'dispose' },
      `${shortName(agent)} is disposed of`), { class: 'danger' }),
    button('Force …', () => {
      const seconds = field('Seconds that it has', { type: 'number', min: 0,
        step: 'any', value: 1 });
      dialog(`Dispose of ${shortName(agent)} by force`, [seconds], 'Dispose',
        () => order(app, { do: 'dispose', agent,
          force: Number(seconds.input.value) }, 'It has ended'));
    }, { class: 'danger' }),
  ];
}

function sendMessage(app, agent) {
  const message = field('Message', { required: true,
    placeholder: 'go(\'n2@127.0.0.1:7000\')' }, 'a Prolog term');
  dialog(`Message to ${shortName(agent)}`, [message], 'Send', () => order(app,
    { do: 'send', agent, message: message.input.value }, 'It is sent'));
}

// ------------------------------------------------------------------ hosts

export function hostActions(app, host) {
  return [
    button('New agent here …', () => newAgent(app, host)),
    button('Link …', () => {
      const other = field('With', { list: hostsThere(app).filter(id => id !== host),
        required: true });
      const cost = field('Cost', { placeholder: '1' });
      dialog(`Link ${shortName(host)}`, [other, cost], 'Link', () => order(app,
        { do: 'link', a: host, b: other.input.value, cost: cost.input.value }));
    }),
    button('New host beside it …', () => newHost(app, host)),
    button('Stop', () => sure(`Stop ${shortName(host)}, and end all agents there?`,
      'Stop', () => order(app, { do: 'host_stop', host },
        `${shortName(host)} is to stop`)), { class: 'danger' }),
  ];
}

function newHost(app, beside = '') {
  const name = field('Name', { required: true });
  const at = field('In the process of', { list: hostsThere(app), value: beside,
    placeholder: 'this page' });
  const options = field('Options', { placeholder: 'capacity(10), tokens([a])' },
    'as of host_start/2');
  dialog('New host', [name, at, options], 'Start', async () => {
    const host = await order(app, { do: 'host_start', name: name.input.value,
      at: at.input.value, options: listed(options) }, id => `${shortName(id)} is started`);
    await app.refresh();
    app.select({ host });
  });
}

// --------------------------------------------------------------- networks

// Topologies, and their arguments with default values.
const SHAPES = [['grid', ['Rows', 3], ['Columns', 4]], ['ring', ['Hosts', 8]],
  ['line', ['Hosts', 8]], ['star', ['Hosts', 8]], ['tree', ['Hosts', 15]],
  ['mesh', ['Hosts', 6]], ['star_bus', ['Arms', 4], ['Length', 4]],
  ['random', ['Hosts', 20], ['Probability', 0.15]], ['edges', ['Links', '[1-2,2-3]']]];

function newNetwork(app) {
  const shape = select('Shape', SHAPES.map(([name]) => [name, name]));
  const sizes = element('div', { class: 'fields' });
  const fill = () => sizes.replaceChildren(...SHAPES.find(([name]) =>
    name === shape.input.value).slice(1).map(([label, value]) =>
    field(label, { required: true, value })));
  shape.input.addEventListener('change', fill);
  fill();
  const processes = field('Processes', { type: 'number', min: 1, value: 1 });
  const dynamic = field('Links come and go', { list: ['random_links', 'dynamic_1',
    'dynamic_2', 'toggle(uniform(2,5),0.3,0.6)'], placeholder: 'no' });
  const delay = field('Delay of a hop', { list: ['uniform(0.5,1.5)'],
    placeholder: 'none' });
  const machines = field('Machines', { placeholder: 'this one' },
    'targets of ssh, with commas');
  const options = field('More options', { placeholder: 'seed(1), log(\'run.pl\', [hops])' },
    'as of network_start/3');
  dialog('New network', [element('div', { class: 'fields' }, shape), sizes,
    element('div', { class: 'fields' }, processes, dynamic, delay, machines),
    options], 'Build', async () => {
    const value = made => made.input.value.trim();
    const list = [`processes(${value(processes) || 1})`];
    if (value(dynamic)) list.push(`dynamic(${value(dynamic)})`);
    if (value(delay)) list.push(`hop_time(${value(delay)})`);
    if (value(machines)) list.push(`machines([${value(machines).split(/\s*,\s*/)
      .map(quoted).join(',')}])`);
    if (value(options)) list.push(value(options).replace(/^\[|\]$/g, ''));
    const sized = [...sizes.children].map(made => value(made)).join(',');
    await order(app, { do: 'network_start',
      topology: `${shape.input.value}(${sized})`, options: `[${list.join(',')}]` },
    name => `${name} is built`);
    await app.refresh();
  });
}

async function endNetwork(app) {
  const networks = await app.ask({ ask: 'networks' });
  if (networks.length === 0) {
    app.note('No network has been started by the process of this page');
    return;
  }
  const which = select('Network', networks.map(({ name, hosts, processes }) =>
    [name, `${name}: ${counted(hosts.length, 'host')}, `
      + counted(processes.length || 1, 'process')]));
  dialog('End a network', [which], 'End it', async () => {
    await order(app, { do: 'network_stop', network: which.input.value },
      `${which.input.value} has ended`);
    await app.refresh();
  });
}

// Dialogs that call operators of the mechanisms in agents/ with their
// arguments.

export async function mechanismDialog(app) {
  const mechanisms = await app.ask({ ask: 'mechanisms' });
  const all = mechanisms.flatMap(({ name, predicates }) =>
    predicates.map(predicate => ({ mechanism: name, ...predicate })));
  const which = select('What', all.map(({ mechanism, name }, n) =>
    [String(n), `${mechanism}: ${name.replaceAll('_', ' ')}`]));
  const fields = element('div', { class: 'stack' });
  const about = element('pre', { class: 'about' });
  let inputs = [];
  const fill = async () => {
    const at = which.input.value;
    const { mechanism, name: predicate, arguments: takes, about: text } = all[Number(at)];
    const parameters = takes.some(([, name]) => name === 'Options')
      ? await app.ask({ ask: 'parameters', mechanism, predicate }) : [];
    if (which.input.value !== at) return;       // another one was selected meanwhile
    inputs = takes.filter(([sign]) => sign !== '-').map(([, name]) =>
      name === 'Options' ? options(parameters) : argument(app, name));
    fields.replaceChildren(...inputs.map(input => input.element));
    about.textContent = text;
  };
  which.input.addEventListener('change', fill);
  await fill();
  dialog('Start a mechanism', [which, fields, about], 'Start', async () => {
    const { mechanism, name, arguments: takes } = all[Number(which.input.value)];
    const values = inputs.map(input => input.value());
    await order(app, { do: 'mechanism', mechanism, predicate: name,
      arguments: takes.map(([sign]) => sign === '-' ? '' : values.shift()) },
    results => [`${name} is done`, ...results.map(text => text.length > 90
      ? `${text.slice(0, 90)}…` : text)].join(': '));
  }, true);
}

// The option `settings` has a slider or a list for each parameter; those that the
// user has not changed keep their defaults.
function options(parameters) {
  const made = field('Options', { required: true, value: '[]' }, 'a Prolog term');
  const inputs = parameters.map(parameter);
  return { element: element('div', { class: 'stack' }, made, inputs.length === 0 ? null
    : element('fieldset', { class: 'parameters' }, element('legend', {}, 'Settings'),
      ...inputs.map(input => input.made))),
  value: () => ({ options: made.input.value, settings: Object.fromEntries(
    inputs.filter(input => input.changed()).map(input => [input.name, input.value()])) }) };
}

// Hosts are selected from a list, by default all; other arguments are text.
function argument(app, name) {
  if (name === 'Hosts') {
    const hosts = hostsThere(app);
    const list = element('select', { multiple: true, size: Math.min(6,
      Math.max(2, hosts.length)), required: true }, ...hosts.map(id =>
      element('option', { value: id, selected: true }, id)));
    return { element: element('label', { class: 'field' },
      element('span', {}, 'Hosts'), list),
      value: () => [...list.selectedOptions].map(option => option.value) };
  }
  if (name === 'Host') {
    const made = hostField(app, 'Host');
    return { element: made, value: () => quoted(made.input.value) };
  }
  const made = field(name, { required: true }, 'a Prolog term');
  return { element: made, value: () => made.input.value };
}

// The editor of agent programs, which can also be read from a file. It shows
// the problems that the platform finds at their lines.

const START = `:- agent(visitor, [state([seen/1])]).

main :-
    neighbours([Host|_]),
    move(Host),
    here(Here),
    assertz(seen(Here)),
    log(seen(Here)).

on_message(_, go(Host)) :-
    move(Host).
`;
const CALM = 400;               // ms from the last key to the check

export function editor(app) {
  const numbers = element('pre', { class: 'numbers', 'aria-hidden': 'true' });
  const text = element('textarea', { 'aria-label': 'Program', spellcheck: 'false',
    autocomplete: 'off', wrap: 'off', 'aria-describedby': 'advice' });
  const advice = element('ul', { class: 'advice', id: 'advice',
    'aria-live': 'polite', 'aria-label': 'Problems' });
  let problems = [], round = 0, timer = null;
  text.value = app.draft ?? START;

  const worst = line => {
    const kinds = problems.filter(problem => problem.line === line)
      .map(problem => problem.kind);
    return kinds.includes('error') ? 'error' : kinds.length ? 'warning' : '';
  };

  function draw() {
    const count = text.value.split('\n').length;
    numbers.replaceChildren(...Array.from({ length: count }, (_, n) =>
      element('span', { class: worst(n + 1) }, `${n + 1}\n`)));
    numbers.scrollTop = text.scrollTop;
  }

  function goTo(line) {
    const lines = text.value.split('\n');
    const start = lines.slice(0, line - 1).join('\n').length + (line > 1 ? 1 : 0);
    text.focus();
    text.setSelectionRange(start, start + (lines[line - 1] || '').length);
    text.scrollTop = Math.max(0, (line - 4) * 20);
  }

  function write(content) {
    text.value = app.draft = content;
    draw();
    check();
  }

  async function check() {
    const now = ++round;
    try {
      const { said } = await app.ask({ do: 'check', text: text.value });
      if (now !== round) return;
      problems = said;
    } catch (error) {
      if (now !== round) return;
      problems = [{ kind: 'error', line: 0, text: error.message }];
    }
    draw();
    advice.replaceChildren(...(problems.length === 0
      ? [element('li', { class: 'fine' }, 'Nothing is wrong with it.')]
      : problems.map(({ kind, line, text: said }) => element('li', { class: kind },
        line ? button(`line ${line}`, () => goTo(line), { class: 'link' })
          : null, ` ${said}`))));
  }

  text.addEventListener('input', () => {
    app.draft = text.value;
    draw();
    clearTimeout(timer);
    timer = setTimeout(check, CALM);
  });
  text.addEventListener('scroll', () => { numbers.scrollTop = text.scrollTop; });
  draw();
  check();
  return {
    element: element('div', { class: 'editor' },
      element('div', { class: 'buttons' }, button('Open a file …', () =>
        readFile('.pl,.pro,.prolog,text/plain', write))),
      element('div', { class: 'code' }, numbers, text), advice),
    get value() { return text.value; },
    set value(content) { write(content); },
    check,
  };
}
