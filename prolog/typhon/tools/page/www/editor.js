// A program of an agent is written here, or read from a file; what the
// platform says of it stands at its lines.

import { button, element } from './dom.js';
import { readFile } from './forms.js';

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
const CALM = 400;               // ms after the last key

export function editor(app) {
  const numbers = element('pre', { class: 'numbers', 'aria-hidden': 'true' });
  const text = element('textarea', { 'aria-label': 'Program', spellcheck: 'false',
    autocomplete: 'off', wrap: 'off', 'aria-describedby': 'advice' });
  const advice = element('ul', { class: 'advice', id: 'advice',
    'aria-live': 'polite', 'aria-label': 'What is said of it' });
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
        readFile('.pl,.pro,.prolog,text/plain', content => {
          text.value = app.draft = content;
          draw();
          check();
        }))),
      element('div', { class: 'code' }, numbers, text), advice),
    get value() { return text.value; },
    check,
  };
}
