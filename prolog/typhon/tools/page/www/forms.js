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

// A parameter: a slider with a field, in which other values fit, too; a list of
// values; or a field.
export function parameter({ name, value, values, from, to, step, about = '' }) {
  const ranged = from !== undefined;
  const field = values && !ranged
    ? element('select', { 'aria-label': name }, ...values.map(text =>
      element('option', { value: text }, text)))
    : element('input', { 'aria-label': name,
      ...(ranged && !values ? { type: 'number', step: 'any' } : {}) });
  field.value = value;
  const slider = ranged ? sliderOf({ name, from, to, step }, field) : null;
  return { name, value: () => field.value, changed: () => field.value !== value,
    made: element('div', { class: 'model-field' }, element('span', {}, name), slider,
      field, about ? element('small', { class: 'muted' }, about) : null) };
}

const WIDE = 1000;              // steps

// That of a wide range is slow at first, so that it reaches small values as well.
function sliderOf({ name, from, to, step }, field) {
  const wide = (to - from) / step > WIDE;
  const slider = element('input', { type: 'range', 'aria-label': `${name}, slider`,
    ...(wide ? { min: 0, max: 1, step: 1 / WIDE } : { min: from, max: to, step }),
    oninput: () => {
      field.value = wide ? bent(Number(slider.value)) : slider.value;
      slider.setAttribute('aria-valuetext', field.value);
    } });
  const bent = part => Number(Math.min(to,
    from + Math.round(part ** 3 * (to - from) / step) * step).toPrecision(9));
  field.oninput = () => {
    slider.value = wide ? Math.cbrt((field.value - from) / (to - from)) : field.value;
    slider.setAttribute('aria-valuetext', field.value);
  };
  field.oninput();
  return slider;
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
