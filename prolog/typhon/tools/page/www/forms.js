// Dialogs for the arguments of orders.

import { button, element } from './dom.js';

// Show a dialog and call `send` when the user confirms it. The dialog closes
// when this succeeds, and otherwise shows the error.
export function dialog(title, content, confirm, send, wide = false) {
  const problem = element('p', { class: 'problem', role: 'alert', hidden: true });
  const go = element('button', { type: 'submit', class: 'primary' }, confirm);
  const form = element('form', { onsubmit: async event => {
    event.preventDefault();
    go.disabled = true;
    problem.hidden = true;
    try {
      await send();
      made.close();
    } catch (error) {
      if (!made.open) throw error;      // a closed form shows nothing
      problem.textContent = error.message;
      problem.hidden = false;
    } finally {
      go.disabled = false;
    }
  } }, element('h2', {}, title), ...content, problem,
  element('div', { class: 'buttons end' },
    button('Cancel', () => made.close()), go));
  const made = element('dialog', { 'aria-label': title,
    class: wide ? 'wide' : '', onclose: () => made.remove() }, form);
  document.body.append(made);
  made.showModal();
  return made;
}

// A labelled field; the field itself is its `input`.
export function field(label, attributes = {}, hint = null) {
  const { value, list, ...rest } = attributes;
  const input = element('input',
    { autocomplete: 'off', spellcheck: 'false', ...rest });
  if (value !== undefined) input.value = value;
  const made = element('label', { class: 'field' },
    element('span', {}, label), input,
    hint ? element('small', { class: 'muted' }, hint) : null);
  if (list) {
    const id = `list-${++lists}`;
    input.setAttribute('list', id);
    made.append(element('datalist', { id }, ...list.map(value =>
      element('option', { value }))));
  }
  made.input = input;
  return made;
}

let lists = 0;

// A field with a list of choices; options are [value, text].
export function select(label, options, value = options[0]?.[0]) {
  const input = element('select', {}, ...options.map(([known, text]) =>
    element('option', { value: known }, text)));
  input.value = value;
  const made = element('label', { class: 'field' },
    element('span', {}, label), input);
  made.input = input;
  return made;
}

// Ask for confirmation of an order that cannot be undone.
export function sure(question, confirm, send) {
  return dialog(question, [], confirm, send);
}

// Let the user choose a file of the browser's machine, and read its text.
export function readFile(accept, onRead) {
  const input = element('input', { type: 'file', accept, onchange: async () => {
    const [file] = input.files;
    if (file) onRead(await file.text(), file.name);
  } });
  input.click();
}

// The text quoted as an atom of Prolog.
export const quoted = text =>
  `'${text.replace(/\\/g, '\\\\').replace(/'/g, "\\'")}'`;
