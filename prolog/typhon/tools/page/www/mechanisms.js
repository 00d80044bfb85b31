// Mechanisms of agents/ are started, with what their operators take.

import { element } from './dom.js';
import { dialog, field, quoted, select } from './forms.js';
import { hostField, hostsThere, order } from './work.js';

export async function mechanismDialog(app) {
  const mechanisms = await app.ask({ ask: 'mechanisms' });
  const all = mechanisms.flatMap(({ name, predicates }) =>
    predicates.map(predicate => ({ mechanism: name, ...predicate })));
  const which = select('What', all.map(({ mechanism, name }, n) =>
    [String(n), `${mechanism}: ${name.replaceAll('_', ' ')}`]));
  const fields = element('div', { class: 'stack' });
  const about = element('pre', { class: 'about' });
  let inputs = [];
  const fill = () => {
    const { arguments: takes, about: text } = all[Number(which.input.value)];
    inputs = takes.filter(([sign]) => sign !== '-').map(([, name]) =>
      argument(app, name));
    fields.replaceChildren(...inputs.map(input => input.element));
    about.textContent = text;
  };
  which.input.addEventListener('change', fill);
  fill();
  dialog('Start a mechanism', [which, fields, about], 'Start', async () => {
    const { mechanism, name, arguments: takes } = all[Number(which.input.value)];
    const values = inputs.map(input => input.value());
    await order(app, { do: 'mechanism', mechanism, predicate: name,
      arguments: takes.map(([sign]) => sign === '-' ? '' : values.shift()) },
    results => [`${name} is done`, ...results.map(text => text.length > 90
      ? `${text.slice(0, 90)}…` : text)].join(': '));
  }, true);
}

// Hosts are chosen, all to begin with; other arguments are written.
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
  const made = field(name, { required: true, value: name === 'Options' ? '[]' : '' },
    'a Prolog term');
  return { element: made, value: () => made.input.value };
}
