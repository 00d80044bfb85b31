// The page for people: the questions of one person, each with a form. All texts
// come from agents, and are set as text.

const pause = 1500;             // milliseconds between two looks
const patience = 20000;         // for an answer of the server
const at = id => document.getElementById(id);
const forms = new Map();        // number of a question -> its form
let timer, refused = false;

function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

async function ask(message) {
  const answer = await fetch('ask', {
    method: 'POST', headers: {'Content-Type': 'application/json'},
    body: JSON.stringify(message), signal: AbortSignal.timeout?.(patience)});
  if (answer.status === 403) { refused = true; throw new Error(await answer.text()); }
  if (!answer.ok) throw new Error(await answer.text());
  return answer.json();
}

// An answer that the server did not confirm can be sent again: it counts once.
async function answer(number, value, fields, error) {
  fields.disabled = true;
  error.textContent = '';
  try {
    const got = await ask({do: 'answer', number, answer: value});
    if (got.error) error.textContent = got.error; else show(got.answer);
    if (got.error) await look();
  } catch (problem) {
    error.textContent = refused ? problem.message : 'Not sent: try again';
  }
  fields.disabled = false;
}

function input(question) {
  return question.kind === 'number'
    ? element('input', {type: 'text', inputMode: 'decimal', required: true, maxLength: 40,
        title: 'A number, such as 12 or 2.5', pattern: '\\s*[+\\-]?[0-9]+([.][0-9]+)?\\s*'})
    : element('textarea', {rows: 2, required: true, maxLength: 2000});
}

function form(question) {
  const label = element('legend', {className: 'text', textContent: question.text});
  const error = element('p', {className: 'error', role: 'alert'});
  const fields = element('fieldset', {}, label);
  const made = element('form', {}, fields, error);
  if (question.agent)
    made.append(element('p', {className: 'by', textContent: question.agent}));
  if (question.kind === 'choice') {
    question.choices.forEach((text, place) => fields.append(element('button', {
      type: 'button', textContent: text,
      onclick: () => answer(question.number, place + 1, fields, error)})));
  } else {
    const field = input(question);
    field.ariaLabel = question.text;
    fields.append(field, element('button', {className: 'primary', textContent: 'Send'}));
    made.onsubmit = event => {
      event.preventDefault();
      answer(question.number, field.value, fields, error);
    };
  }
  return made;
}

// A form stays as it is while its question waits, with what was typed.
function show(page) {
  at('name').textContent = page.name;
  document.title = page.questions.length ? `(${page.questions.length}) ${page.name}` : page.name;
  const numbers = new Set(page.questions.map(question => question.number));
  for (const [number, made] of forms)
    if (!numbers.has(number)) { made.remove(); forms.delete(number); }
  for (const question of page.questions)
    if (!forms.has(question.number)) {
      forms.set(question.number, form(question));
      at('questions').append(forms.get(question.number));
    }
  at('empty').hidden = page.questions.length > 0;
  at('shown').replaceChildren(...[...page.shown].reverse().map(note =>
    element('div', {className: 'note'},
      element('p', {className: 'text', textContent: note.text}),
      element('p', {className: 'by', textContent: note.agent}))));
  at('state').textContent = 'connected';
}

async function look() {
  clearTimeout(timer);
  try {
    const got = await ask({ask: 'page'});
    if (got.answer) show(got.answer); else at('state').textContent = got.error;
  } catch (problem) {
    at('state').textContent = refused ? problem.message : 'no connection';
  }
  if (!refused && !document.hidden) timer = setTimeout(look, pause);
}

document.addEventListener('visibilitychange', () => { if (!document.hidden && !refused) look(); });
look();
